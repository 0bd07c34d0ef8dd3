#include "posewright/model/variant.hpp"

#include <algorithm>
#include <map>
#include <string_view>

namespace posewright {
namespace {

/// Shell-style pattern with * and ?.
bool matches(std::string_view pattern, std::string_view name) {
  std::size_t p = 0, n = 0, star = std::string_view::npos, mark = 0;
  while (n < name.size()) {
    if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == name[n])) {
      ++p, ++n;
    } else if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      mark = n;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      n = ++mark;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

/// All parameters of a model under the model's names and the user's.
class Names {
 public:
  Names(const IdentificationModel& model, const Problem& problem) : model_(model), problem_(problem) {
    for (const Parameter& p : model.parameters()) shown_.push_back(p.name);
    const auto* arm = std::get_if<SerialArmSpec>(&problem.robot);
    if (arm == nullptr) return;
    // Names given to joint frames' parameters say nothing where a variant has another convention.
    if (std::none_of(shown_.begin(), shown_.end(), [](const std::string& n) { return n.ends_with(".gear"); })) return;
    for (const auto& [mine, theirs] : arm->parameter_names) {
      const int index = index_of(theirs);
      shown_[std::size_t(index)] = mine;
    }
  }

  const std::string& shown(int index) const { return shown_[std::size_t(index)]; }

  /// Indices matched by a pattern, in the model's order; throws where there are none.
  std::vector<int> find(const Located<std::string>& pattern) const {
    std::vector<int> found;
    for (int i = 0; i < int(shown_.size()); ++i)
      if (matches(pattern.value, shown(i)) || matches(pattern.value, model_.parameters()[std::size_t(i)].name))
        found.push_back(i);
    if (found.empty()) unknown(pattern);
    return found;
  }

 private:
  int index_of(const Located<std::string>& name) const {
    for (int i = 0; i < int(model_.parameters().size()); ++i)
      if (model_.parameters()[std::size_t(i)].name == name.value) return i;
    unknown(name);
  }

  [[noreturn]] void unknown(const Located<std::string>& pattern) const {
    std::string allowed;
    for (const std::string& name : shown_) allowed += (allowed.empty() ? "parameters: " : ", ") + name;
    throw InputError(problem_.at(pattern.line), "'" + pattern.value + "' matches no parameter of this robot", allowed);
  }

  const IdentificationModel& model_;
  const Problem& problem_;
  std::vector<std::string> shown_;
};

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
void for_each_value(const Names& names, const Problem& problem, const std::vector<PatternValue>& values,
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
          problem.at(value.pattern.line),
          std::string(what) + " of '" + value.pattern.value + "' is in a unit that none of these parameters has",
          "allowed: " +
              allowed_units(
                  {Quantity::length, Quantity::angle, Quantity::force, Quantity::compliance, Quantity::stiffness}) +
              " as the parameter's own unit says");
  }
}

/// Free parameters of interest in the order written, or all geometric ones for `auto`.
std::vector<int> interest_candidates(const IdentificationModel& model, const Names& names, const VariantSpec& variant) {
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

void apply_nominal(IdentificationModel& model, const Problem& problem, const VariantSpec& variant) {
  if (variant.nominal.empty()) return;
  const Names names(model, problem);
  for_each_value(names, problem, variant.nominal, model.parameters(), "the nominal value",
                 [&](int i, double value) { model.set_nominal(i, value); });
}

VariantColumns select_columns(const IdentificationModel& model, const Problem& problem, const VariantSpec& variant) {
  const Names names(model, problem);
  std::vector<Parameter> all = model.parameters();
  for_each_value(names, problem, variant.tolerance, all, "the tolerance",
                 [&](int i, double value) { all[std::size_t(i)].tolerance = value; });
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
    columns.selected.push_back(i);
    columns.parameters.push_back(std::move(label));
    columns.tiers.push_back(variant.automatic && tier.count(i) != 0 ? tier[i] : 0);
  };
  for (int i = 0; i < int(all.size()); ++i)
    if (is_nuisance[std::size_t(i)] && !is_fixed[std::size_t(i)]) add(i, Role::nuisance);
  columns.nuisance = int(columns.selected.size());
  for (const int i : interest)
    if (!is_nuisance[std::size_t(i)] && !is_fixed[std::size_t(i)]) add(i, Role::interest);
  if (int(columns.selected.size()) == columns.nuisance)
    throw InputError(problem.at(variant.line), "variant '" + variant.name + "' leaves no parameter of interest free",
                     "name some under parameters that are neither nuisance nor fixed");
  return columns;
}

std::vector<std::optional<double>> values_by_pattern(const VariantColumns& columns,
                                                     const std::vector<PatternValue>& values, const Problem& problem,
                                                     const char* what) {
  std::vector<std::optional<double>> result(columns.parameters.size());
  for (const PatternValue& value : values) {
    bool used = false;
    for (std::size_t j = 0; j < result.size(); ++j) {
      const Parameter& p = columns.parameters[j];
      if (!matches(value.pattern.value, p.name) || !fits(value.quantity, p.unit)) continue;
      result[j] = value.value;
      used = true;
    }
    if (used) continue;
    std::string names;
    for (const Parameter& p : columns.parameters) names += (names.empty() ? "parameters: " : ", ") + p.name;
    throw InputError(
        problem.at(value.pattern.line),
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

const VariantSpec& find_variant(const Problem& problem, const std::string& name) {
  const std::string wanted = !name.empty() ? name : problem.design.variant ? problem.design.variant->value : "";
  if (wanted.empty()) return problem.variants.front();
  std::string allowed;
  for (const VariantSpec& variant : problem.variants) {
    if (variant.name == wanted) return variant;
    allowed += (allowed.empty() ? "variants: " : ", ") + variant.name;
  }
  const int line = name.empty() && problem.design.variant ? problem.design.variant->line : 0;
  throw InputError(problem.at(line), "has no variant '" + wanted + "'", allowed);
}

}  // namespace posewright
