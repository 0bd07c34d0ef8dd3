#include "posewright/pipeline/variant_model.hpp"

#include <algorithm>

#include "posewright/support/error.hpp"
#include "study.hpp"

namespace posewright {
namespace {

VariantColumns named_columns(const VariantColumns& all, const std::vector<std::string>& names) {
  std::vector<int> kept;
  for (const std::string& name : names) {
    const auto at =
        std::find_if(all.parameters.begin(), all.parameters.end(), [&](const Parameter& p) { return p.name == name; });
    if (at == all.parameters.end())
      throw InputError({}, "variant '" + all.name + "' has no parameter '" + name + "'", "names of its parameters");
    kept.push_back(int(at - all.parameters.begin()));
  }
  std::sort(kept.begin(), kept.end());
  if (std::adjacent_find(kept.begin(), kept.end()) != kept.end())
    throw InputError({}, "a parameter is named twice", "each name once");
  return subset(all, kept);
}

}  // namespace

VariantModel make_variant_model(const Problem& problem, const VariantModelOptions& options, const Monitor& monitor) {
  const VariantSpec& variant = find_variant(problem, options.variant);
  VariantModel result;
  result.cell = make_cell(problem);
  Site site = make_site(problem, variant, result.cell);
  result.model = std::move(site.model);
  result.workspace = std::move(site.workspace);
  result.columns = select_columns(*result.model, problem, variant);
  if (!options.parameters.empty()) {
    result.columns = named_columns(result.columns, options.parameters);
  } else if (result.columns.automatic) {
    SamplingOptions sampling;
    sampling.count = std::size_t(options.candidates);
    sampling.seed = options.seed;
    sampling.threads = options.threads;
    const Configurations sample = sample_configurations(*result.workspace, sampling, monitor);
    result.columns = resolve_columns({result.model.get(), &sample}, problem, variant, false, options.threads).columns;
  }
  return result;
}

}  // namespace posewright
