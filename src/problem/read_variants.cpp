#include "sections.hpp"

namespace posewright {

using yaml::Section;
using yaml::Sign;
using yaml::Value;

std::vector<PatternValue> read_pattern_values(const Value& value, Sign sign) {
  std::vector<PatternValue> values;
  for (const yaml::Entry& entry : Section(value).entries()) {
    const Measured measured = entry.value.measured(
        {Quantity::length, Quantity::angle, Quantity::force, Quantity::compliance, Quantity::stiffness}, sign);
    values.push_back({entry.key, measured.value, measured.quantity});
  }
  return values;
}

namespace {

void read_parameters(const Value& value, VariantSpec& variant) {
  using Convention = VariantSpec::Convention;
  const std::string expected = "a list of names or one of the words auto, dh, mdh is expected";
  const auto is_set = [&](const std::string& word) {
    if (word != "auto" && word != "dh" && word != "mdh") return false;
    variant.automatic = true;
    variant.convention = word == "dh" ? Convention::dh : word == "mdh" ? Convention::mdh : Convention::frames;
    return true;
  };
  if (value.is_scalar()) {
    if (!is_set(value.text(expected))) value.fail("is a single name", expected);
    return;
  }
  if (!value.is_list()) value.fail("is not a list", expected);
  const std::vector<Located<std::string>> names = value.texts();
  for (const Located<std::string>& name : names) {
    if (variant.automatic || !is_set(name.value)) variant.parameters.push_back(name);
  }
  if (names.empty()) value.fail("is empty", expected);
}

/// `auto`, or {size, rotation, length}.
UnmodelledSpec read_unmodelled(const Value& value) {
  UnmodelledSpec unmodelled;
  unmodelled.line = value.line();
  if (value.is_scalar()) {
    if (value.text("auto or {size, rotation, length} is expected") != "auto")
      value.fail("is not a size", "auto, or {size: \"0.3 mm\", length: \"60 deg\"}");
    return unmodelled;
  }
  const Section section(value);
  section.allow({"size", "rotation", "length"});
  if (const Value* size = section.find("size"); size != nullptr && !(size->is_scalar() && size->text() == "auto"))
    unmodelled.size = size->number(Quantity::length, Sign::positive);
  if (const Value* rotation = section.find("rotation"))
    unmodelled.rotation = rotation->number(Quantity::angle, Sign::positive);
  if (const Value* length = section.find("length")) unmodelled.length = length->number(Quantity::angle, Sign::positive);
  return unmodelled;
}

VariantSpec read_variant(const Located<std::string>& name, const Value& value) {
  const Section section(value);
  section.allow({"parameters", "nuisance", "fixed", "tolerance", "nominal", "unmodelled"});
  VariantSpec variant;
  variant.name = name.value;
  variant.line = name.line;
  read_parameters(section.at("parameters"), variant);
  if (const Value* nuisance = section.find("nuisance")) variant.nuisance = nuisance->texts();
  if (const Value* fixed = section.find("fixed")) variant.fixed = fixed->texts();
  if (const Value* tolerance = section.find("tolerance"))
    variant.tolerance = read_pattern_values(*tolerance, Sign::positive);
  if (const Value* nominal = section.find("nominal")) variant.nominal = read_pattern_values(*nominal, Sign::any);
  if (const Value* unmodelled = section.find("unmodelled")) variant.unmodelled = read_unmodelled(*unmodelled);
  return variant;
}

}  // namespace

std::vector<VariantSpec> read_variants(const Value& value) {
  std::vector<VariantSpec> variants;
  for (const yaml::Entry& entry : Section(value).entries()) variants.push_back(read_variant(entry.key, entry.value));
  if (variants.empty()) value.fail("is empty", "at least one variant is needed");
  return variants;
}

}  // namespace posewright
