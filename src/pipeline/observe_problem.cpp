#include "posewright/pipeline/observe_problem.hpp"

#include "posewright/planning/evaluate.hpp"
#include "study.hpp"

namespace posewright {
namespace {

Observation observe(const Study& study, const Problem& problem, const VariantSpec& variant, int threads) {
  const VariantColumns columns = select_columns(*study.model, problem, variant);
  const BlockArray pool = build_blocks(*study.model, columns.selected, study.configurations, threads);
  Observation result;
  result.variant = variant.name;
  result.configurations = study.configurations.count();
  result.rows = study.model->rows();
  result.parameters = columns.parameters;
  IdentifiabilityOptions options;
  options.tiers = columns.tiers;
  result.identifiability = identifiability(pool, columns.parameters, options);
  options.threshold = 1e-9;
  result.exact_rank = identifiability(pool, columns.parameters, options).rank;
  const VariantColumns kept = subset(columns, result.identifiability.kept);
  if (int(kept.selected.size()) > kept.nuisance)
    result.indices =
        evaluate(build_blocks(*study.model, kept.selected, study.configurations, threads), kept.parameters).indices;
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
  std::vector<Observation> observations;
  for (const VariantSpec& variant : problem.variants)
    if (options.variant.empty() || variant.name == options.variant)
      observations.push_back(
          observe(make_study(problem, variant, sampling, monitor), problem, variant, options.threads));
  return observations;
}

}  // namespace posewright
