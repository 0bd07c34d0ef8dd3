#include "posewright/study/variant.hpp"

#include <algorithm>
#include <stdexcept>

#include "posewright/cell/line_of_sight.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/problem/structure.hpp"
#include "posewright/study/columns.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/file.hpp"
#include "posewright/support/sha256.hpp"

namespace posewright {
namespace {

// A pose's verdict must not change with the seed of a search.
constexpr std::uint64_t readable_seed = 0x2ead;

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

/// As many as the problem asks for, the same at every call.
std::vector<std::vector<double>> robots_to_read(const Variant& variant) {
  std::vector<std::vector<double>> robots;
  const int count = variant.problem->workspace.readable_for;
  if (count == 0 || variant.model->unmeasurable_reason().empty()) return robots;
  const VariantColumns columns = all_columns(variant);
  for (int k = 0; k < count; ++k) {
    Random random(readable_seed, std::uint64_t(k));
    robots.push_back(drawn_correction(columns, variant.model->parameters().size(), random));
  }
  return robots;
}

}  // namespace

Variant place_variant(const ProblemVariant& of, const std::shared_ptr<const Cell>& cell, const Monitor& monitor) {
  const ReadDigest read;
  Variant variant{&of.problem, &of.spec, cell, make_model(of), nullptr};
  // Instruments of a list must see all their targets.
  if (cell != nullptr && cell->sight() != nullptr && cell->sight()->judges()) {
    if (variant.model->rows_per_target() > 0 &&
        variant.model->rows() != cell->sight()->targets() * variant.model->rows_per_target())
      throw std::logic_error("targets of the instrument and of the line of sight differ");
    variant.model->set_visibility({cell, cell->sight()});
  }
  variant.workspace = std::make_unique<Workspace>(*variant.model, of.problem, cell, monitor, robots_to_read(variant));
  // Without bodies and sights a draw takes no longer than a start of the program: none is kept.
  if (const std::string files = read.hex();
      variant.workspace->cut_by_cell() && !files.empty() && !cell->identity.empty())
    variant.workspace->identify(sha256_hex(structure_of(of.problem) + structure_of(of.spec) + files + cell->identity));
  return variant;
}

VariantColumns all_columns(const Variant& variant) {
  return select_columns(*variant.model, {*variant.problem, *variant.spec});
}

std::vector<Coordinate> pose_coordinates(const Problem& problem, const std::string& variant) {
  return place_variant({problem, find_variant(problem, variant)}, nullptr).workspace->coordinates();
}

Variant make_variant(const Problem& problem, const VariantOptions& options, const Monitor& monitor) {
  Variant variant = place_variant({problem, find_variant(problem, options.variant)}, make_cell(problem), monitor);
  variant.columns = all_columns(variant);
  if (!options.parameters.empty()) {
    variant.columns = named_columns(variant.columns, options.parameters);
  } else if (variant.columns.automatic) {
    SamplingOptions sampling;
    sampling.count = std::size_t(options.candidates);
    sampling.seed = options.seed;
    sampling.threads = options.threads;
    const Configurations sample = sample_configurations(*variant.workspace, sampling, monitor);
    variant.columns =
        resolve_columns(*variant.model, sample, std::move(variant.columns), false, options.threads).columns;
  }
  return variant;
}

}  // namespace posewright
