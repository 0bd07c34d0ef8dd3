#include "posewright/proof/enclosed_proof.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "posewright/planning/ascent.hpp"
#include "posewright/proof/taylor_bound.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/random.hpp"

namespace posewright {
namespace {

constexpr std::size_t most_enclosed = 6, quick_axes = 3;
// Boxes of a proof that is not timed: of six axes each takes half a millisecond, eight side by side.
constexpr long most_enclosed_boxes = 6500;
// d as blocks give it and its enclosure may differ by this share of h, at so many random places.
constexpr double same_value = 1e-7;
constexpr int poses_compared = 100;
constexpr std::uint64_t enclosed_stream = 0x9f00f;

/// True if d of blocks is within the enclosure at random feasible places, up to rounding.
bool is_the_same(const WorkspaceBound& found, const BoundedSpace& space, int rows, std::uint64_t seed) {
  const auto enclosure = space.enclosure(found.factor);
  const auto probe = space.probe();
  ProbedBlock block(rows, int(found.factor.rows()));
  Random random(seed, enclosed_stream);
  std::vector<double> q(space.axes().size());
  for (int i = 0; i < poses_compared; ++i) {
    std::vector<TaylorModel> place;
    for (std::size_t a = 0; a < q.size(); ++a) {
      const ConfigurationSpace::Axis& axis = space.axes()[a];
      q[a] = axis.upper > axis.lower ? random.uniform(axis.lower, axis.upper) : axis.lower;
      place.emplace_back(q[a]);
    }
    std::vector<TaylorModel> limits;
    TaylorModel d;
    if (!block.at(*probe, q)) continue;
    if (!enclosure->allowed(place, limits)) return false;
    if (std::any_of(limits.begin(), limits.end(), [](const TaylorModel& c) { return !(c.lower() >= 0); })) continue;
    if (!enclosure->sensitivity(place, d)) return false;
    const double value = (block.map() * found.factor).squaredNorm();
    if (!(std::abs(value - d.constant()) <= d.radius() + same_value * found.degree)) return false;
  }
  return true;
}

}  // namespace

bool prove_by_enclosure(WorkspaceBound& result, const BoundedSpace& space, std::size_t candidates, int rows,
                        const WorkspaceBoundOptions& options, const Monitor& monitor) {
  const auto moving = std::count_if(space.axes().begin(), space.axes().end(),
                                    [](const ConfigurationSpace::Axis& a) { return a.upper > a.lower; });
  if (moving == 0 || std::size_t(moving) > most_enclosed || space.enclosure(result.factor) == nullptr) return false;
  WorkspaceProof& proof = result.proof;
  proof.why_not.clear();
  if (candidates < few_candidates && std::size_t(moving) > quick_axes) {
    proof.why_not = "a quick look at fewer than 1,000 candidates";
    return true;
  }
  if (!is_the_same(result, space, rows, options.seed)) {
    proof.why_not = "the sensitivity is not that of its enclosure";
    return true;
  }
  const double extra =
      options.prior.size() > 0 ? (result.factor.transpose() * options.prior * result.factor).trace() : 0.0;
  BoxSearchOptions limits;
  limits.slack = same_value * result.degree;
  limits.tolerance = options.tolerance;
  limits.most_boxes = most_enclosed_boxes;
  limits.threads = options.threads;
  // Searches found as much: a bound that is hardly larger is as good as any.
  limits.enough = (result.max_ratio * result.degree - extra) * (1 + options.tolerance);
  if (options.proof.gap) {
    limits.enough = std::max(limits.enough, result.degree * (1 + *options.proof.gap) - extra);
    limits.tolerance = std::min(limits.tolerance, *options.proof.gap / 4);
  }
  Monitor own;
  own.follow(monitor);
  limits.shared = moving > std::ptrdiff_t(quick_axes);
  if (options.proof.seconds) {
    own.end_within(*options.proof.seconds);
    limits.most_boxes = std::numeric_limits<long>::max();
  }
  const BoxSearchResult most = largest_enclosed(space, result.factor, limits, own);
  proof.boxes = most.boxes;
  if (!most.complete) proof.ended = most.stopped ? "stopped by time" : "stopped there";
  if (!std::isfinite(most.bound)) {
    proof.why_not =
        most.stopped ? WorkspaceProof::cut_short : "parts of the workspace near which the robot cannot be enclosed";
    return true;
  }
  proof.max_ratio = std::max(1.0, (most.bound + extra) / result.degree);
  proof.bound = result.value + result.degree * std::log(proof.max_ratio);
  return true;
}

}  // namespace posewright
