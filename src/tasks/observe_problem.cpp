#include "posewright/tasks/observe_problem.hpp"

#include <algorithm>

#include "posewright/planning/evaluate.hpp"
#include "posewright/study/columns.hpp"
#include "posewright/study/variant.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

// Nine tenths of an effect look like other parameters': worth a line.
constexpr double near_share = 0.1;

/// Poses that σ is predicted for: what is asked for, what the design says, but enough to determine everything.
int judged_poses(const Problem& problem, const ObserveOptions& options, int smallest) {
  const int wanted = options.poses ? *options.poses : problem.design.poses ? problem.design.poses->value : 2 * smallest;
  return std::max(wanted, smallest);
}

void add_practical(Observation& o, const BlockArray& pool, const Problem& problem, const ObserveOptions& options,
                   const Monitor& monitor) {
  if (!o.smallest_poses) return;
  try {
    o.practical =
        practical_identifiability(pool, o.kept, judged_poses(problem, options, *o.smallest_poses), near_share, monitor);
  } catch (const CannotDo&) {
    // Told apart by less than double precision can use: the dependencies above say so.
  }
}

Observation observe(const Variant& variant, const Configurations& configurations, const Problem& problem,
                    const ObserveOptions& options, const Monitor& monitor) {
  const VariantColumns columns = select_columns(*variant.model, problem, *variant.spec);
  const BlockArray pool = build_blocks(*variant.model, columns.selected, configurations, options.threads);
  Observation result;
  result.variant = variant.spec->name;
  result.configurations = configurations.count();
  result.rows = variant.model->rows();
  result.parameters = columns.parameters;
  IdentifiabilityOptions structural;
  structural.tiers = columns.tiers;
  result.identifiability = identifiability(pool, columns.parameters, structural);
  structural.threshold = 1e-9;
  result.exact_rank = identifiability(pool, columns.parameters, structural).rank;
  const VariantColumns kept = subset(columns, result.identifiability.kept);
  result.kept = kept.parameters;
  if (int(kept.selected.size()) == kept.nuisance) return result;
  const BlockArray kept_pool = build_blocks(*variant.model, kept.selected, configurations, options.threads);
  result.indices = evaluate(kept_pool, kept.parameters).indices;
  result.smallest_poses = smallest_number_of_poses(*variant.model, configurations, kept, options.threads);
  add_practical(result, kept_pool, problem, options, monitor);
  return result;
}

}  // namespace

std::vector<Observation> observe_problem(const Problem& problem, const ObserveOptions& options,
                                         const Monitor& monitor) {
  SamplingOptions sampling;
  sampling.count = std::size_t(options.candidates);
  sampling.seed = options.seed;
  sampling.threads = options.threads;
  if (!options.variant.empty()) find_variant(problem, options.variant);
  const std::shared_ptr<const Cell> cell = make_cell(problem);
  std::vector<Observation> observations;
  for (const VariantSpec& spec : problem.variants) {
    if (!options.variant.empty() && spec.name != options.variant) continue;
    const Variant variant = place_variant(problem, spec, cell, monitor);
    observations.push_back(
        observe(variant, sample_configurations(*variant.workspace, sampling, monitor), problem, options, monitor));
  }
  return observations;
}

}  // namespace posewright
