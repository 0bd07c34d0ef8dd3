#include "posewright/proof/workspace_proof.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "part_squares.hpp"
#include "posewright/proof/bounded_space.hpp"
#include "posewright/proof/enclosed_proof.hpp"
#include "posewright/proof/harmonic_bound.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/tasks.hpp"

namespace posewright {
namespace {

// Tensors of so many axes are sampled in a second.
constexpr std::size_t axes_for_nothing = 3, axes_at_once = 4;
// Coefficients of all tensors that a proof may hold: half a gigabyte.
constexpr double most_coefficients = 64e6;
// Coefficients of all boxes: some seconds of one core, whatever the number of joints. Counted and not timed, so that a
// plan is the same on every machine.
constexpr double proof_work = 3e8;
// A box of more coefficients than this takes some milliseconds: worth sharing.
constexpr double shared_box = 1e5;
// A bound that is loose by more is not worth its time.
constexpr double most_loose = 0.05;

WeightedConfigurations support_of(const WorkspaceBound& found, const ConfigurationSpace& space) {
  WeightedConfigurations result{found.support, found.weights};
  for (std::size_t i = 0; i < found.candidates.size(); ++i) {
    const auto q = space.candidate(found.candidates[i]);
    result.configurations.emplace_back(q.begin(), q.end());
    result.weights.push_back(found.candidate_weights[i]);
  }
  return result;
}

/// True if factors depend on distances, of an arm with more than a few joints.
bool grows_with_distance(const HarmonicForms& forms) {
  return !forms.forms.front()->distance_degrees().empty() && forms.forms.front()->axes().size() > axes_at_once;
}

/// Mean excess of the forms' bound over d at the weights: a limit of the proof.
double looseness(const HarmonicForms& forms, const WeightedConfigurations& where, const ConfigurationSpace& space,
                 const Eigen::MatrixXd& T, int rows) {
  const auto probe = space.probe();
  BlockArray block(1, rows, int(T.rows()));
  double bound = 0, direct = 0;
  for (std::size_t i = 0; i < where.configurations.size(); ++i) {
    const std::vector<double>& q = where.configurations[i];
    if (!probe->block(q, block.row(0, 0), block.stride())) continue;
    const auto form = std::find_if(forms.forms.begin(), forms.forms.end(),
                                   [&](const auto& f) { return f->configuration(f->values(q)) == q; });
    if (form == forms.forms.end()) continue;
    std::vector<double> values = (*form)->values(q);
    PartSquares parts(**form, T);
    parts.evaluator().complete(values);
    bound += where.weights[i] * parts.sensitivity(values);
    direct += where.weights[i] * (std::as_const(block).block(0) * T).squaredNorm();
  }
  return direct > 0 ? bound / direct - 1 : 0.0;
}

/// Method for bounding the largest d of a space.
struct Approach {
  HarmonicForms forms;
  std::vector<HarmonicDegrees> degrees{};  ///< of the forms' squares
  double work = 0.0;                       ///< of the largest box
};

/// @return why there is no proof by it; empty: there is one
std::string choose(Approach& approach, const WorkspaceBound& found, const WeightedConfigurations& support,
                   const ConfigurationSpace& space, std::size_t candidates, int rows,
                   const WorkspaceBoundOptions& options) {
  const HarmonicForms& forms = approach.forms;
  if (!forms.why_not.empty()) return forms.why_not;
  double coefficients = 0, first_work = 0;
  for (const auto& form : forms.forms) {
    approach.degrees.push_back(degrees_of_squares(*form, found.factor, options.seed));
    const HarmonicSensitivity::Cost cost = HarmonicSensitivity::cost(*form, approach.degrees.back());
    coefficients += cost.coefficients;
    first_work += cost.boxes * cost.work;
    approach.work = std::max(approach.work, cost.work);
  }
  if (forms.forms.empty() || coefficients > most_coefficients) return "more joints and effects than memory holds";
  if (candidates < few_candidates && forms.forms.front()->axes().size() > axes_for_nothing)
    return "a quick look at fewer than 1,000 candidates";
  if (!options.proof.seconds && first_work > proof_work)
    return fmt::format("{} axes take minutes to bound: --proof-time 300", forms.forms.front()->axes().size());
  const double loose = looseness(forms, support, space, found.factor, rows);
  if (loose > most_loose)
    return fmt::format("the bound of joint noise, visit noise or deflections is {:.0f} % too high", 100 * loose);
  if (!options.proof.seconds && grows_with_distance(forms))
    return "noise that grows with the distance takes minutes to bound: --proof-time 300";
  return {};
}

using Functions = std::vector<std::unique_ptr<HarmonicSensitivity>>;

/// One a form; the last is not defined where something is not as its form says, or time is over.
Functions functions_of(const Approach& approach, const Eigen::MatrixXd& T, const WorkspaceBoundOptions& options,
                       const Monitor& monitor) {
  Functions functions;
  for (std::size_t f = 0; f < approach.forms.forms.size(); ++f) {
    functions.push_back(std::make_unique<HarmonicSensitivity>(*approach.forms.forms[f], T, approach.degrees[f],
                                                              options.seed, options.threads, monitor));
    if (!functions.back()->defined()) break;
  }
  return functions;
}

/// @param work      of the largest box
/// @param extra     what the prior adds to every d
/// @param searched  no search found a d above this
BoxSearchOptions limits_of(const Functions& functions, double work, const WorkspaceBound& found,
                           const WorkspaceBoundOptions& options, double extra, double searched) {
  BoxSearchOptions limits;
  limits.shared = std::any_of(functions.begin(), functions.end(), [](const auto& f) { return f->size() > shared_box; });
  limits.tolerance = options.tolerance;
  limits.most_boxes = options.proof.seconds ? std::numeric_limits<long>::max() : long(proof_work / work);
  limits.threads = options.threads;
  if (options.proof.gap) {
    limits.enough = found.degree * (1 + *options.proof.gap) - extra;
    limits.tolerance = std::min(limits.tolerance, *options.proof.gap / 4);
  }
  // What is largest within limits has no box of its own: a bound that is hardly larger than what searches found is as
  // good as any.
  if (!found.proof.limits.empty()) limits.enough = std::max(limits.enough, searched);
  return limits;
}

/// Result of the boxes.
void take(const BoxSearchResult& most, const HarmonicForms& forms, const ConfigurationSpace& space, double extra,
          WorkspaceBound& found) {
  WorkspaceProof& proof = found.proof;
  proof.boxes = most.boxes;
  if (!most.complete) proof.ended = most.stopped ? "stopped by time" : "stopped there";
  if (!std::isfinite(most.bound)) {
    proof.why_not = most.stopped     ? WorkspaceProof::cut_short
                    : most.bound > 0 ? "an instrument that may stand within the arm's reach"
                                     : "limits that forbid every configuration";
    return;
  }
  proof.max_ratio = std::max(1.0, (most.bound + extra) / found.degree);
  proof.bound = found.value + found.degree * std::log(proof.max_ratio);
  const auto configuration = [&](const FoundPlace& place) {
    return forms.forms[std::size_t(place.function)]->configuration(place.where);
  };
  if (!most.found.refuting.where.empty()) proof.refuted_by = configuration(most.found.refuting);
  if (most.found.where.empty()) return;
  proof.largest_at = configuration(most.found);
  proof.largest_forbidden_by = space.probe()->forbidden_by(proof.largest_at);
}

}  // namespace

void prove_workspace(WorkspaceBound& result, const ConfigurationSpace& space, std::size_t candidates, int rows,
                     const WorkspaceBoundOptions& options, const Monitor& monitor) {
  WorkspaceProof& proof = result.proof;
  proof = {};
  if (result.stopped || monitor.should_stop()) proof.why_not = WorkspaceProof::cut_short;
  else if (options.proof.seconds == 0.0) proof.why_not = "not asked for";
  if (!proof.why_not.empty()) return;
  const auto* bounded = dynamic_cast<const BoundedSpace*>(&space);
  if (bounded == nullptr) proof.why_not = "this space does not say how blocks depend on its axes";
  if (bounded == nullptr || prove_by_enclosure(result, *bounded, candidates, rows, options, monitor)) return;
  const WeightedConfigurations support = support_of(result, space);
  Approach approach{bounded->harmonic_forms(support)};
  proof.why_not = choose(approach, result, support, space, candidates, rows, options);
  if (!proof.why_not.empty()) return;

  Monitor own;
  own.follow(monitor);
  // Several processes would not come to the same end of what they all compute: their time ends the boxes.
  const bool boxes_alone = several_processes(monitor);
  if (options.proof.seconds && !boxes_alone) own.end_within(*options.proof.seconds);
  const Functions functions = functions_of(approach, result.factor, options, own);
  if (!functions.back()->defined()) {
    proof.why_not = own.should_stop() ? WorkspaceProof::cut_short
                                      : "the sensitivity is no polynomial of the joints' cosines and sines";
    return;
  }
  if (options.proof.seconds && boxes_alone) own.end_within(*options.proof.seconds);
  proof.limits = approach.forms.forms.front()->limits().names;
  const double extra =
      options.prior.size() > 0 ? (result.factor.transpose() * options.prior * result.factor).trace() : 0.0;
  const double searched = (result.max_ratio * result.degree - extra) * (1 + options.tolerance);
  const BoxSearchOptions limits = limits_of(functions, approach.work, result, options, extra, searched);
  const Refutation refutation{space, rows, searched};
  take(largest_value(functions, limits, own, &refutation), approach.forms, space, extra, result);
}

}  // namespace posewright
