#include "posewright/model/variant_columns.hpp"

#include <algorithm>
#include <array>
#include <map>

#include "parameter_names.hpp"
#include "posewright/model/apply_parameters.hpp"
#include "posewright/support/near_words.hpp"
namespace posewright {
namespace {

bool fits(Quantity quantity, const std::string& unit) {
  switch (quantity) {
    case Quantity::length:
      return unit == "m";
    case Quantity::angle:
      return unit == "rad";
    case Quantity::force:
      return unit == "N";
    case Quantity::compliance:
      return unit == "rad/(N·m)";
    case Quantity::stiffness:
      return unit == "N/m";
    default:
      return true;  // a plain number is SI
  }
}

/// Calls use(index, value) for every parameter that a written value is meant for; later entries come later.
template <class Use>
void for_each_value(const ParameterNames& names, const ProblemFile& file, const std::vector<PatternValue>& values,
                    const std::vector<Parameter>& parameters, const char* what, const Use& use) {
  for (const PatternValue& value : values) {
    bool used = false;
    for (const int i : names.find(value.pattern)) {
      if (!fits(value.quantity, parameters[std::size_t(i)].unit)) continue;
      use(i, value.value);
      used = true;
    }
    if (!used)
      throw InputError(
          file.at(value.pattern.line),
          std::string(what) + " of '" + value.pattern.value + "' is in a unit that none of these parameters has",
          "allowed: " +
              allowed_units(
                  {Quantity::length, Quantity::angle, Quantity::force, Quantity::compliance, Quantity::stiffness}) +
              " as the parameter's own unit says");
  }
}

/// Base, tool, targets, stations, anchors; a camera and its board but not the lens. Those of an instrument of a list or
/// of a further campaign are "target@NAME.P1.x".
bool places(const Parameter& p) {
  constexpr std::array<std::string_view, 7> frames = {"base", "tool", "target", "station", "anchor", "camera", "board"};
  return (p.unit == "m" || p.unit == "rad") &&
         std::ranges::count(frames, std::string_view(p.name).substr(0, p.name.find_first_of(".@"))) > 0;
}

/// Free parameters of interest in the order written, or all geometric ones for `auto`.
std::vector<int> interest_candidates(const IdentificationModel& model, const ParameterNames& names,
                                     const VariantSpec& variant) {
  std::vector<int> order;
  const auto add = [&](int i) {
    if (std::find(order.begin(), order.end(), i) == order.end()) order.push_back(i);
  };
  if (variant.automatic)
    for (const auto& preference : model.geometric_parameters()) add(preference.parameter);
  for (const auto& pattern : variant.parameters)
    for (const int i : names.find(pattern)) add(i);
  return order;
}

}  // namespace

void apply_nominal(IdentificationModel& model, const ProblemVariant& variant) {
  const std::vector<ParameterEntry> calibrated = calibrated_entries(variant);
  if (variant.spec.nominal.empty() && calibrated.empty()) return;
  const ParameterNames names(model, variant);
  // The instrument of a part of the problem may have fewer parameters; apply_parameters has judged the names.
  const auto take_calibrated = [&] {
    for (const ParameterEntry& entry : calibrated)
      if (const int i = names.index_of(entry.name.value); i >= 0) model.set_nominal(i, entry.value);
  };
  // What a variant says of itself stands, unless it is the one that was calibrated.
  const auto& parameters = variant.problem.parameters;
  const bool own = parameters && parameters->variant.value == variant.spec.name;
  if (!own) take_calibrated();
  for_each_value(names, variant.problem, variant.spec.nominal, model.parameters(), "the nominal value",
                 [&](int i, double value) { model.set_nominal(i, value); });
  if (own) take_calibrated();
}

VariantColumns select_columns(const IdentificationModel& model, const ProblemVariant& of) {
  const VariantSpec& variant = of.spec;
  const ParameterNames names(model, of);
  std::vector<Parameter> all = model.parameters();
  for_each_value(names, of.problem, variant.tolerance, all, "the tolerance", [&](int i, double value) {
    all[std::size_t(i)].tolerance = value;
    all[std::size_t(i)].tolerance_stated = true;
  });
  std::vector<bool> is_nuisance(all.size(), false), is_fixed(all.size(), false);
  for (const auto& pattern : variant.nuisance)
    for (const int i : names.find(pattern)) is_nuisance[std::size_t(i)] = true;
  for (const auto& pattern : variant.fixed)
    for (const int i : names.find(pattern)) is_fixed[std::size_t(i)] = true;
  const std::vector<int> interest = interest_candidates(model, names, variant);

  VariantColumns columns;
  columns.name = variant.name;
  columns.automatic = variant.automatic;
  std::map<int, int> tier;
  for (const auto& preference : model.geometric_parameters()) tier[preference.parameter] = preference.tier;
  const auto add = [&](int i, Role role) {
    Parameter label = all[std::size_t(i)];
    label.name = names.shown(i);
    label.role = role;
    label.places = places(all[std::size_t(i)]);
    columns.selected.push_back(i);
    columns.parameters.push_back(std::move(label));
    // Of parameters that depend on each other, those that nobody asked for are left out.
    const int of_role = role == Role::nuisance ? 1 : 0;
    columns.tiers.push_back(!variant.automatic ? of_role : tier.count(i) != 0 ? tier[i] : 0);
  };
  for (int i = 0; i < int(all.size()); ++i)
    if (is_nuisance[std::size_t(i)] && !is_fixed[std::size_t(i)]) add(i, Role::nuisance);
  columns.nuisance = int(columns.selected.size());
  for (const int i : interest)
    if (!is_nuisance[std::size_t(i)] && !is_fixed[std::size_t(i)]) add(i, Role::interest);
  if (int(columns.selected.size()) == columns.nuisance)
    throw InputError(of.problem.at(variant.line), "variant '" + variant.name + "' leaves no parameter of interest free",
                     "name some under parameters that are neither nuisance nor fixed");
  return columns;
}

std::vector<int> fixed_parameters(const IdentificationModel& model, const ProblemVariant& variant) {
  const ParameterNames names(model, variant);
  std::vector<int> fixed;
  for (const auto& pattern : variant.spec.fixed)
    for (const int i : names.find(pattern)) fixed.push_back(i);
  return fixed;
}

std::vector<std::optional<double>> values_by_pattern(const VariantColumns& columns,
                                                     const std::vector<PatternValue>& values, const ProblemFile& file,
                                                     const char* what) {
  std::vector<std::optional<double>> result(columns.parameters.size());
  for (const PatternValue& value : values) {
    bool used = false;
    for (std::size_t j = 0; j < result.size(); ++j) {
      const Parameter& p = columns.parameters[j];
      if (!matches(value.pattern.value, p.name) || !fits(value.quantity, p.unit)) continue;
      if (value.quantity == Quantity::number && (p.unit == "m" || p.unit == "rad"))
        throw InputError(file.at(value.pattern.line),
                         std::string(what) + " of '" + value.pattern.value + "' has no unit",
                         p.unit == "m" ? "m, mm, um, nm" : "rad, mrad, urad, deg");
      result[j] = value.value;
      used = true;
    }
    if (used) continue;
    std::string names;
    for (const Parameter& p : columns.parameters) names += (names.empty() ? "parameters: " : ", ") + p.name;
    throw InputError(
        file.at(value.pattern.line),
        std::string(what) + " of '" + value.pattern.value + "' fits no identified parameter, or not its unit", names);
  }
  return result;
}

VariantColumns subset(const VariantColumns& columns, const std::vector<int>& kept) {
  VariantColumns result;
  result.name = columns.name;
  for (const int i : kept) {
    const auto k = std::size_t(i);
    result.selected.push_back(columns.selected[k]);
    result.parameters.push_back(columns.parameters[k]);
    result.tiers.push_back(columns.tiers[k]);
    if (i < columns.nuisance) ++result.nuisance;
  }
  return result;
}

std::vector<int> columns_named(const VariantColumns& columns, const std::string& pattern) {
  std::vector<int> found;
  for (std::size_t j = 0; j < columns.parameters.size(); ++j)
    if (matches(pattern, columns.parameters[j].name)) found.push_back(int(j));
  return found;
}

const VariantSpec& find_variant(const Problem& problem, const std::string& name) {
  const std::string wanted = !name.empty() ? name : problem.design.variant ? problem.design.variant->value : "";
  if (wanted.empty()) return problem.variants.front();
  std::string allowed;
  std::vector<std::string> words;
  for (const VariantSpec& variant : problem.variants) {
    if (variant.name == wanted) return variant;
    words.push_back(variant.name);
    allowed += (allowed.empty() ? "variants: " : ", ") + variant.name;
  }
  const int line = name.empty() && problem.design.variant ? problem.design.variant->line : 0;
  throw InputError(problem.at(line), "has no variant '" + wanted + "'" + meant_instead(wanted, words), allowed);
}

std::vector<double> drawn_correction(const VariantColumns& columns, std::size_t parameters, Random& random) {
  std::vector<double> correction(parameters, 0.0);
  for (std::size_t j = 0; j < columns.selected.size(); ++j)
    correction[std::size_t(columns.selected[j])] = columns.parameters[j].tolerance * random.normal();
  return correction;
}

Eigen::VectorXd tolerances_of(const VariantColumns& columns) {
  Eigen::VectorXd tolerances(Eigen::Index(columns.parameters.size()));
  for (std::size_t j = 0; j < columns.parameters.size(); ++j)
    tolerances[Eigen::Index(j)] = columns.parameters[j].tolerance;
  return tolerances;
}

}  // namespace posewright
