#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "posewright/problem/design_words.hpp"
#include "posewright/support/repeats.hpp"
#include "posewright/support/text.hpp"
#include "sections.hpp"

namespace posewright {
namespace {

using yaml::Section;
using yaml::Sign;
using yaml::Value;

void require_variant(const Value& value, const std::string& name, const std::vector<VariantSpec>& variants) {
  std::string names;
  for (const VariantSpec& variant : variants) {
    if (variant.name == name) return;
    names += (names.empty() ? "" : ", ") + variant.name;
  }
  value.fail("is " + in_quotes(name), "allowed: " + names);
}

/// A list of names, or names with weights.
std::vector<DesignSpec::Weighted> read_several(const Value& value, const std::vector<VariantSpec>& variants) {
  std::vector<DesignSpec::Weighted> result;
  if (value.is_mapping()) {
    for (const yaml::Entry& entry : Section(value).entries()) {
      require_variant(entry.value, entry.key.value, variants);
      result.push_back({entry.key, entry.value.number(Quantity::number, Sign::positive)});
    }
  } else {
    for (const Value& item : value.items("a list of variants, or variants with weights, is expected")) {
      require_variant(item, item.text(), variants);
      const auto same = [&](const DesignSpec::Weighted& other) { return other.name.value == item.text(); };
      if (std::any_of(result.begin(), result.end(), same)) item.fail("is named twice", "each variant once");
      result.push_back({item.located_text(), 1.0});
    }
  }
  if (result.empty()) value.fail("is empty", "at least one variant is needed");
  return result;
}

Repeats read_repeats(const Value& value) {
  const std::string text = value.text("forbid, allow or a number is expected");
  const std::optional<Repeats> repeats = repeats_of(text);
  if (!repeats) value.fail("is " + in_quotes(text), repeats_allowed);
  return *repeats;
}

DesignSpec::MinimumDistance read_minimum_distance(const Value& value) {
  const Section section(value);
  section.allow({"angle", "length"});
  DesignSpec::MinimumDistance distance;
  if (const Value* angle = section.find("angle")) distance.angle = angle->number(Quantity::angle, Sign::positive);
  if (const Value* length = section.find("length")) distance.length = length->number(Quantity::length, Sign::positive);
  if (!section.has("angle") && !section.has("length")) value.fail("is empty", "allowed: angle, length");
  return distance;
}

/// Requirements come from a drawing or contract: 0.1 without a unit would be 0.1 m.
double required_number(const Value& value, Quantity quantity) {
  const Measured number = value.measured({quantity}, Sign::positive);
  if (number.quantity != quantity) value.fail("has no unit", "allowed: " + allowed_units({quantity}));
  return number.value;
}

/// One value for all three axes, or {x: …, z: …}: an axis that is not named may be off.
void read_required_axes(const Section& section, const char* key, Quantity quantity, std::optional<double>* axes) {
  const Value* value = section.find(key);
  if (value == nullptr) return;
  if (!value->is_mapping()) {
    std::fill(axes, axes + 3, required_number(*value, quantity));
    return;
  }
  const Section each(*value);
  each.allow({"x", "y", "z"});
  int axis = 0;
  for (const char* name : {"x", "y", "z"}) {
    if (const Value* one = each.find(name)) axes[axis] = required_number(*one, quantity);
    ++axis;
  }
  if (each.entries().empty()) value->fail("is empty", "allowed: x, y, z");
}

RequirementSpec read_requirement(const Value& value) {
  const Section section(value);
  section.allow({"accuracy", "sigma", "position", "rotation"});
  RequirementSpec require;
  require.line = value.line();
  if (const Value* accuracy = section.find("accuracy")) require.accuracy = required_number(*accuracy, Quantity::length);
  if (const Value* sigma = section.find("sigma")) require.sigma = read_pattern_values(*sigma, Sign::positive);
  read_required_axes(section, "position", Quantity::length, require.axes.data());
  read_required_axes(section, "rotation", Quantity::angle, require.axes.data() + 3);
  if (section.entries().empty()) value.fail("is empty", "allowed: accuracy, sigma, position, rotation");
  return require;
}

RobustSpec read_robust(const Value& value) {
  const Section section(value);
  section.allow({"draws", "measure"});
  RobustSpec robust;
  robust.line = value.line();
  if (const Value* draws = section.find("draws"))
    robust.draws = int(draws->integer(least_robust_draws, most_robust_draws));
  if (const Value* measure = section.find("measure")) {
    const std::optional<RobustAim> aim = robust_aim_of(measure->text("a measure is expected"));
    if (!aim) measure->fail("is no measure", robust_aims_allowed);
    robust.aim = *aim;
  }
  return robust;
}

Located<int> read_count(const Value& value, int upper) { return {value.integer(1, upper), value.line()}; }

void read_poses(const Value& value, DesignSpec& design) {
  design.smallest = value.is_scalar() && value.text("a number or auto is expected") == "auto";
  if (!design.smallest) design.poses = read_count(value, std::numeric_limits<int>::max());
}

/// Criterion to maximise.
void read_aim(const Section& section, const std::vector<VariantSpec>& variants, const std::filesystem::path& folder,
              DesignSpec& design) {
  if (const Value* variant = section.find("variant")) {
    design.variant = variant->located_text();
    require_variant(*variant, design.variant->value, variants);
  }
  if (const Value* truth = section.find("truth")) {
    design.truth = truth->located_text();
    require_variant(*truth, design.truth->value, variants);
  }
  if (const Value* several = section.find("variants")) design.variants = read_several(*several, variants);
  if (const Value* criterion = section.find("criterion")) design.criterion = criterion->located_text();
  if (const Value* test_poses = section.find("test_poses")) design.test_poses = read_test_poses(*test_poses, folder);
  if (const Value* prior = section.find("prior")) design.prior = prior->choice({"none", "tolerance"}) == "tolerance";
  if (const Value* reserve = section.find("reserve")) design.reserve = reserve->flag();
  if (const Value* robust = section.find("robust")) design.robust = read_robust(*robust);
  if (const Value* scaling = section.find("scaling"))
    design.scaling = *scaling_of(scaling->choice({"tolerance", "norm", "none"}));
  if (const Value* require = section.find("require")) design.require = read_requirement(*require);
}

}  // namespace

DesignSpec read_design(const Value& value, const std::vector<VariantSpec>& variants,
                       const std::filesystem::path& folder) {
  const Section section(value);
  section.allow({"variant", "variants", "truth", "criterion", "method", "poses", "require", "candidates",
                 "candidates_from", "restarts", "repeats", "minimum_distance", "scaling", "prior", "reserve", "robust",
                 "measured", "fixed", "test_poses"});
  DesignSpec design;
  design.line = value.line();
  read_aim(section, variants, folder, design);
  if (const Value* method = section.find("method")) design.method = method->located_text();
  if (const Value* poses = section.find("poses")) read_poses(*poses, design);
  if (const Value* candidates = section.find("candidates")) design.candidates = read_count(*candidates, 10'000'000);
  if (const Value* list = section.find("candidates_from")) {
    design.candidates_from = folder / list->text("a file is expected");
    if (section.has("candidates")) list->fail("cannot be combined with candidates", "leave one of them out");
  }
  if (const Value* restarts = section.find("restarts")) design.restarts = read_count(*restarts, 1'000'000);
  if (const Value* repeats = section.find("repeats")) design.repeats = read_repeats(*repeats);
  if (const Value* distance = section.find("minimum_distance"))
    design.minimum_distance = read_minimum_distance(*distance);
  if (const Value* measured = section.find("measured")) design.measured = folder / measured->text("a file is expected");
  if (const Value* fixed = section.find("fixed")) design.fixed = folder / fixed->text("a file is expected");
  return design;
}

}  // namespace posewright
