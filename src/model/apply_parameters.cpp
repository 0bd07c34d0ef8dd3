#include "posewright/model/apply_parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "parameter_names.hpp"
#include "posewright/model/calibrated_values.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/model/variant_columns.hpp"
#include "posewright/support/near_words.hpp"

namespace posewright {
namespace {

const VariantSpec* named(const std::vector<VariantSpec>& variants, const std::string& name) {
  const auto at = std::ranges::find(variants, name, &VariantSpec::name);
  return at == variants.end() ? nullptr : &*at;
}

/// The variant that stands for the calibrated one.
const VariantSpec& target_of(const Problem& problem, const CalibratedParameters& parameters,
                             const std::vector<std::string>& asked) {
  const std::string& calibrated = parameters.variant.value;
  if (!asked.empty() && std::find(asked.begin(), asked.end(), calibrated) == asked.end())
    return find_variant(problem, asked.front());
  if (const VariantSpec* variant = named(problem.variants, calibrated)) return *variant;
  std::string names;
  for (const VariantSpec& variant : problem.variants) names += (names.empty() ? "" : ", ") + variant.name;
  throw InputError(parameters.at(parameters.variant.line),
                   "'" + calibrated + "' is not a variant of " + problem.file.string(),
                   "variants: " + names + "; --variant names one that takes the values");
}

void require_names(const ProblemVariant& variant, const CalibratedParameters& parameters) {
  const auto model = make_model(variant);
  const ParameterNames names(*model, variant);
  const std::vector<CalibratedValue> own =
      calibrated_values(variant, *model, std::vector<double>(model->parameters().size(), 0.0));
  for (const ParameterEntry& entry : parameters.values) {
    const int i = names.index_of(entry.name.value);
    if (i < 0)
      throw InputError(parameters.at(entry.name.line),
                       "'" + entry.name.value + "' is not a parameter of variant '" + variant.spec.name + "'" +
                           meant_instead(entry.name.value, names.all()),
                       names.allowed(entry.name.value));
    const std::string& unit = model->parameters()[std::size_t(i)].unit;
    if (!entry.unit.empty() && entry.unit != unit)
      throw InputError(parameters.at(entry.name.line), "'" + entry.name.value + "' is in '" + entry.unit + "'",
                       "allowed: " + unit + ", values are in SI");
    const double nominal = own[std::size_t(i)].nominal;
    if (entry.nominal && std::abs(*entry.nominal - nominal) > model->parameters()[std::size_t(i)].tolerance)
      throw InputError(parameters.at(entry.name.line),
                       fmt::format("'{}' was {:.6g} before it was calibrated, this robot's is {:.6g}: these are "
                                   "parameters of another robot",
                                   entry.name.value, *entry.nominal, nominal),
                       "nominal values that differ by less than the tolerance");
  }
}

}  // namespace

std::string convention_name(VariantSpec::Convention convention) {
  using Convention = VariantSpec::Convention;
  return convention == Convention::frames ? "frames" : convention == Convention::dh ? "dh" : "mdh";
}

std::vector<std::string> apply_parameters(Problem& problem, CalibratedParameters parameters,
                                          const std::vector<std::string>& asked) {
  problem.parameters.reset();
  const VariantSpec& target = target_of(problem, parameters, asked);
  const VariantSpec* calibrated = named(problem.variants, parameters.variant.value);
  const std::string own = convention_name(target.convention);
  if (parameters.convention.empty()) parameters.convention = calibrated ? convention_name(calibrated->convention) : own;
  if (parameters.convention != own)
    throw InputError(
        parameters.at(parameters.variant.line),
        "has parameters of the kind '" + parameters.convention + "', variant '" + target.name + "' is '" + own + "'",
        "a variant with parameters of the same kind");
  require_names({problem, target}, parameters);
  std::vector<std::string> notes;
  for (const VariantSpec& variant : problem.variants)
    if (convention_name(variant.convention) != own)
      notes.push_back(parameters.file.string() + ": variant '" + variant.name +
                      "' has parameters of another kind and keeps its nominal values");
  parameters.variant.value = target.name;
  problem.parameters = std::move(parameters);
  return notes;
}

std::vector<ParameterEntry> calibrated_entries(const ProblemVariant& variant) {
  const auto& parameters = variant.problem.parameters;
  if (!parameters || parameters->convention != convention_name(variant.spec.convention)) return {};
  return parameters->values;
}

}  // namespace posewright
