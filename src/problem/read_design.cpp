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

Located<int> read_count(const Value& value, int upper) { return {value.integer(1, upper), value.line()}; }

}  // namespace

DesignSpec read_design(const Value& value, const std::vector<VariantSpec>& variants) {
  const Section section(value);
  section.allow({"variant", "criterion", "method", "poses", "candidates", "restarts", "repeats", "prior"});
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
  if (const Value* prior = section.find("prior")) design.prior = prior->choice({"none", "tolerance"}) == "tolerance";
  return design;
}

}  // namespace posewright
