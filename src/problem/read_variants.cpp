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

VariantSpec read_variant(const Located<std::string>& name, const Value& value) {
  const Section section(value);
  section.allow({"parameters", "nuisance", "fixed", "tolerance", "nominal"});
  VariantSpec variant;
  variant.name = name.value;
  variant.line = name.line;
  read_parameters(section.at("parameters"), variant);
  if (const Value* nuisance = section.find("nuisance")) variant.nuisance = nuisance->texts();
  if (const Value* fixed = section.find("fixed")) variant.fixed = fixed->texts();
  if (const Value* tolerance = section.find("tolerance"))
    variant.tolerance = read_pattern_values(*tolerance, Sign::positive);
  if (const Value* nominal = section.find("nominal")) variant.nominal = read_pattern_values(*nominal, Sign::any);
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
