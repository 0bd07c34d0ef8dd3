#include "posewright/planning/workspace_proof.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "part_squares.hpp"
#include "posewright/planning/enclosed_proof.hpp"
#include "posewright/planning/harmonic_bound.hpp"
#include "posewright/planning/reading_noise_bound.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/tasks.hpp"

namespace posewright {
namespace {

// Tensors of so many axes are sampled in a second.
constexpr std::size_t axes_for_nothing = 3, axes_at_once = 4;
// Coefficients of all tensors that a proof may hold: half a gigabyte.
constexpr double most_coefficients = 64e6;
// Coefficients of all boxes: some ten seconds of one core, whatever the number of joints. Counted and not timed, so
// that a plan is the same on every machine.
constexpr double proof_work = 3e8;
constexpr long fewest_boxes = 3000, fewest_large_boxes = 300;
// A box of more coefficients than this takes some ten milliseconds.
constexpr double large_box = 1e6;
// And of more than this some milliseconds: worth sharing.
constexpr double shared_box = 1e5;
// A bound that is loose by more is not worth its time.
constexpr double most_loose = 0.05;
// One that is loose by less has no need of a matrix of its own for each box.
constexpr double hardly_loose = 0.002;

WeightedConfigurations support_of(const WorkspaceBound& found, const ConfigurationSpace& space) {
  WeightedConfigurations result{found.support, found.weights};
  for (std::size_t i = 0; i < found.candidates.size(); ++i) {
    const auto q = space.candidate(found.candidates[i]);
    result.configurations.emplace_back(q.begin(), q.end());
    result.weights.push_back(found.candidate_weights[i]);
  }
  return result;
}

/// Whether factors depend on distances, of an arm with more than a few joints.
bool grows_with_distance(const HarmonicForms& forms) {
  return !forms.forms.front()->distance_degrees().empty() && forms.forms.front()->axes().size() > axes_at_once;
}

/// How far the forms' bound is above d where the weights are, on average: a proof by it is no better.
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

/// What else may be said of joints' noise than one matrix for the whole workspace (theory.md eq. (61)).
bool bounds_noise_by_boxes(const HarmonicForms& forms, double loose) {
  return loose > hardly_loose && forms.forms.front()->random_columns() > 0;
}

/// As many boxes as the work allows.
long most_boxes(const std::vector<std::unique_ptr<BoundedSensitivity>>& functions) {
  double largest = 0;
  for (const auto& f : functions) largest = std::max(largest, f->work());
  return std::max(largest > large_box ? fewest_large_boxes : fewest_boxes, long(proof_work / largest));
}

}  // namespace

void prove_workspace(WorkspaceBound& result, const ConfigurationSpace& space, std::size_t candidates, int rows,
                     const WorkspaceBoundOptions& options, const Monitor& monitor) {
  WorkspaceProof& proof = result.proof;
  if (result.stopped || monitor.should_stop()) proof.why_not = "stopped";
  else if (options.proof.seconds == 0.0) proof.why_not = "not asked for";
  else proof.why_not.clear();
  if (!proof.why_not.empty()) return;
  const WeightedConfigurations support = support_of(result, space);
  if (prove_by_enclosure(result, space, candidates, rows, options, monitor)) return;
  const HarmonicForms forms = space.harmonic_forms(support);
  proof.why_not = forms.why_not;
  if (!proof.why_not.empty()) return;
  double cost = 0;
  std::vector<HarmonicDegrees> degrees;
  for (const auto& form : forms.forms) {
    degrees.push_back(degrees_of_squares(*form, result.factor, options.seed));
    cost += HarmonicSensitivity::cost(*form, degrees.back());
  }
  if (forms.forms.empty() || cost > most_coefficients) proof.why_not = "more joints and effects than memory holds";
  else if (candidates < few_candidates && forms.forms.front()->axes().size() > axes_for_nothing)
    proof.why_not = "a quick look at fewer than 1,000 candidates";
  const double loose = proof.why_not.empty() ? looseness(forms, support, space, result.factor, rows) : 0.0;
  const bool by_boxes = proof.why_not.empty() && bounds_noise_by_boxes(forms, loose);
  if (by_boxes) {
    cost = 0;
    for (const auto& form : forms.forms) cost += ReadingNoiseSensitivity::cost(*form);
    if (cost > most_coefficients) proof.why_not = "noise of more joints than memory holds";
    else if (!options.proof.seconds && forms.forms.front()->axes().size() > axes_at_once)
      proof.why_not = "large noise of the joints takes a minute to bound: --proof-time 60";
  } else if (loose > most_loose) {
    proof.why_not = fmt::format(
        "noise of the joints or of the visit, beside the instrument's, or deflections are bounded {:.0f} % too high",
        100 * loose);
  }
  if (proof.why_not.empty() && !options.proof.seconds && grows_with_distance(forms))
    proof.why_not = "noise that grows with the distance takes minutes to bound: --proof-time 300";
  if (!proof.why_not.empty()) return;

  Monitor own;
  own.interrupted = monitor.interrupted;
  own.deadline = monitor.deadline;
  own.engine = monitor.engine;
  // Several processes would not come to the same end of what they all compute: their time ends the boxes.
  const bool boxes_alone = several_processes(monitor);
  if (options.proof.seconds && !boxes_alone) own.end_within(*options.proof.seconds);
  std::vector<std::unique_ptr<BoundedSensitivity>> functions;
  for (std::size_t f = 0; f < forms.forms.size(); ++f) {
    const HarmonicForm& form = *forms.forms[f];
    if (by_boxes)
      functions.push_back(
          std::make_unique<ReadingNoiseSensitivity>(form, result.factor, options.seed, options.threads, own));
    else
      functions.push_back(
          std::make_unique<HarmonicSensitivity>(form, result.factor, degrees[f], options.seed, options.threads, own));
    if (functions.back()->defined()) continue;
    proof.why_not = own.should_stop() ? "stopped" : "the sensitivity is no polynomial of the joints' cosines and sines";
    return;
  }
  if (options.proof.seconds && boxes_alone) own.end_within(*options.proof.seconds);
  proof.limits = forms.forms.front()->limits().names;
  BoxSearchOptions limits;
  limits.shared = std::any_of(functions.begin(), functions.end(), [](const auto& f) { return f->size() > shared_box; });
  limits.tolerance = options.tolerance;
  limits.most_boxes = options.proof.seconds ? std::numeric_limits<long>::max() : most_boxes(functions);
  limits.threads = options.threads;
  const double extra =
      options.prior.size() > 0 ? (result.factor.transpose() * options.prior * result.factor).trace() : 0.0;
  if (options.proof.gap) {
    limits.enough = result.degree * (1 + *options.proof.gap) - extra;
    limits.tolerance = std::min(limits.tolerance, *options.proof.gap / 4);
  }
  const double searched = (result.max_ratio * result.degree - extra) * (1 + options.tolerance);
  // What is largest within limits has no box of its own: a bound that is hardly larger than what searches found is as
  // good as any.
  if (!proof.limits.empty()) limits.enough = std::max(limits.enough, searched);
  const Refutation refutation{space, rows, searched};
  const BoxSearchResult most = largest_value(functions, limits, own, &refutation);
  proof.boxes = most.boxes;
  if (!most.complete) proof.ended = most.stopped ? "stopped by time" : "stopped there";
  if (!std::isfinite(most.bound)) {
    proof.why_not = most.stopped     ? "stopped"
                    : most.bound > 0 ? "an instrument that may stand within the arm's reach"
                                     : "limits that forbid every configuration";
    return;
  }
  proof.max_ratio = std::max(1.0, (most.bound + extra) / result.degree);
  proof.bound = result.value + result.degree * std::log(proof.max_ratio);
  if (const FoundPlace& refuting = most.found.refuting; !refuting.where.empty())
    proof.refuted_by = forms.forms[std::size_t(refuting.function)]->configuration(refuting.where);
  if (most.found.where.empty()) return;
  proof.largest_at = forms.forms[std::size_t(most.found.function)]->configuration(most.found.where);
  proof.largest_forbidden_by = space.probe()->forbidden_by(proof.largest_at);
}

}  // namespace posewright
