#include "sections.hpp"

namespace posewright {
namespace {

using yaml::Section;
using yaml::Sign;
using yaml::Value;

VariantSpec::Tolerance::Quantity tolerance_quantity(Quantity quantity) {
  using Kind = VariantSpec::Tolerance::Quantity;
  if (quantity == Quantity::length) return Kind::length;
  return quantity == Quantity::angle ? Kind::angle : Kind::number;
}

void read_parameters(const Value& value, VariantSpec& variant) {
  const std::string expected = "a list of names or the word auto is expected";
  if (value.is_scalar()) {
    if (value.text(expected) != "auto") value.fail("is a single name", expected);
    variant.automatic = true;
    return;
  }
  if (!value.is_list()) value.fail("is no list", expected);
  variant.parameters = value.texts();
  if (variant.parameters.empty()) value.fail("is empty", expected);
}

VariantSpec read_variant(const Located<std::string>& name, const Value& value) {
  const Section section(value);
  section.allow({"parameters", "nuisance", "fixed", "tolerance"});
  VariantSpec variant;
  variant.name = name.value;
  variant.line = name.line;
  read_parameters(section.at("parameters"), variant);
  if (const Value* nuisance = section.find("nuisance")) variant.nuisance = nuisance->texts();
  if (const Value* fixed = section.find("fixed")) variant.fixed = fixed->texts();
  if (const Value* tolerance = section.find("tolerance"))
    for (const yaml::Entry& entry : Section(*tolerance).entries()) {
      const Measured measured = entry.value.measured({Quantity::length, Quantity::angle}, Sign::positive);
      variant.tolerance.push_back({entry.key, measured.value, tolerance_quantity(measured.quantity)});
    }
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
