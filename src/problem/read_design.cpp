#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "sections.hpp"
#include "text.hpp"

namespace posewright {
namespace {

using yaml::Section;
using yaml::Value;

Located<std::string> read_variant_name(const Value& value, const std::vector<VariantSpec>& variants) {
  Located<std::string> name = value.located_text();
  std::string names;
  for (const VariantSpec& variant : variants) {
    if (variant.name == name.value) return name;
    names += (names.empty() ? "" : ", ") + variant.name;
  }
  value.fail("is " + in_quotes(name.value), "allowed: " + names);
}

TestPosesSpec read_test_poses(const Value& value) {
  const Section section(value);
  section.allow({"at", "random", "weights", "point"});
  TestPosesSpec spec;
  spec.line = value.line();
  if (section.has("at") == section.has("random"))
    value.fail("needs one of at, random", "a list of configurations or a number");
  if (const Value* random = section.find("random")) spec.random = random->integer(1, 100000);
  if (const Value* at = section.find("at"))
    for (const Value& pose : at->items("a list of configurations is expected")) {
      spec.at.emplace_back();
      for (const Value& number : pose.items("a list of numbers is expected"))
        spec.at.back().push_back(number.measured({Quantity::angle, Quantity::length}));
    }
  if (section.has("at") && spec.at.empty()) value.fail("is empty", "at least one configuration is needed");
  if (const Value* weights = section.find("weights"))
    for (const Value& weight : weights->items(spec.at.size(), "one weight for each configuration is expected"))
      spec.weights.push_back(weight.number(Quantity::number, yaml::Sign::positive));
  if (const Value* point = section.find("point")) spec.point = point->vector(Quantity::length);
  return spec;
}

Located<int> read_count(const Value& value, int upper) { return {value.integer(1, upper), value.line()}; }

}  // namespace

DesignSpec read_design(const Value& value, const std::vector<VariantSpec>& variants) {
  const Section section(value);
  section.allow(
      {"variant", "criterion", "method", "poses", "candidates", "restarts", "repeats", "prior", "test_poses"});
  DesignSpec design;
  design.line = value.line();
  if (const Value* variant = section.find("variant")) design.variant = read_variant_name(*variant, variants);
  if (const Value* criterion = section.find("criterion")) design.criterion = criterion->located_text();
  if (const Value* method = section.find("method")) design.method = method->located_text();
  if (const Value* poses = section.find("poses")) design.poses = read_count(*poses, std::numeric_limits<int>::max());
  if (const Value* candidates = section.find("candidates")) design.candidates = read_count(*candidates, 10'000'000);
  if (const Value* restarts = section.find("restarts")) design.restarts = read_count(*restarts, 1'000'000);
  if (const Value* repeats = section.find("repeats"))
    design.repeats = repeats->choice({"forbid", "allow"}) == "allow" ? Repeats::allow : Repeats::forbid;
  if (const Value* test_poses = section.find("test_poses")) design.test_poses = read_test_poses(*test_poses);
  if (const Value* prior = section.find("prior")) design.prior = prior->choice({"none", "tolerance"}) == "tolerance";
  return design;
}

}  // namespace posewright
