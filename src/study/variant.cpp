#include "posewright/study/variant.hpp"

#include <algorithm>
#include <stdexcept>

#include "posewright/cell/line_of_sight.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/study/columns.hpp"
#include "posewright/support/error.hpp"

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

Variant place_variant(const Problem& problem, const VariantSpec& spec, const std::shared_ptr<const Cell>& cell,
                      const Monitor& monitor) {
  Variant variant{&spec, cell, make_model(problem, spec), nullptr};
  if (cell != nullptr && cell->sight_is_asked) {
    if (variant.model->rows_per_target() > 0 &&
        variant.model->rows() != cell->sight->targets() * variant.model->rows_per_target())
      throw std::logic_error("targets of the instrument and of the line of sight differ");
    variant.model->set_visibility({cell, cell->sight.get()});
  }
  variant.repeatability = problem.measurement.repeatability;
  variant.workspace = std::make_unique<Workspace>(*variant.model, problem, cell, monitor);
  return variant;
}

std::vector<Coordinate> pose_coordinates(const Problem& problem, const std::string& variant) {
  return place_variant(problem, find_variant(problem, variant), nullptr).workspace->coordinates();
}

Variant make_variant(const Problem& problem, const VariantOptions& options, const Monitor& monitor) {
  Variant variant = place_variant(problem, find_variant(problem, options.variant), make_cell(problem), monitor);
  variant.columns = select_columns(*variant.model, problem, *variant.spec);
  if (!options.parameters.empty()) {
    variant.columns = named_columns(variant.columns, options.parameters);
  } else if (variant.columns.automatic) {
    SamplingOptions sampling;
    sampling.count = std::size_t(options.candidates);
    sampling.seed = options.seed;
    sampling.threads = options.threads;
    const Configurations sample = sample_configurations(*variant.workspace, sampling, monitor);
    variant.columns = resolve_columns(*variant.model, sample, problem, *variant.spec, false, options.threads).columns;
  }
  return variant;
}

}  // namespace posewright
