#include <algorithm>

#include "sections.hpp"

namespace posewright {
namespace {

using yaml::Section;
using yaml::Sign;
using yaml::Value;

Eigen::Vector3d optional_vector(const Section& section, const char* key, Quantity quantity) {
  const Value* value = section.find(key);
  return value == nullptr ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : value->vector(quantity);
}

LoadCaseSpec read_load(const std::string& name, const Value& value) {
  LoadCaseSpec load;
  load.name = name;
  const Section section(value);
  section.allow({"force", "moment", "point", "mass", "centre_of_mass"});
  load.force = optional_vector(section, "force", Quantity::force);
  load.moment = optional_vector(section, "moment", Quantity::number);
  load.point = optional_vector(section, "point", Quantity::length);
  load.centre_of_mass = optional_vector(section, "centre_of_mass", Quantity::length);
  if (const Value* mass = section.find("mass")) load.mass = mass->number(Quantity::number, Sign::not_negative);
  return load;
}

/// @param geometry_alone  the constants follow from listed compliances
CompensatorSpec read_compensator(const Value& value, bool geometry_alone) {
  const Section section(value);
  if (geometry_alone) section.allow({"joint", "L", "ax", "ay"});
  else section.allow({"joint", "L", "ax", "ay", "stiffness", "free_length", "joint_stiffness", "effect"});
  CompensatorSpec spec;
  spec.joint = section.at("joint").exact_name();
  spec.L = section.at("L").number(Quantity::length, Sign::positive);
  spec.ax = section.at("ax").number(Quantity::length);
  spec.ay = section.at("ay").number(Quantity::length);
  // With a = L the spring's length is zero somewhere.
  if (!(std::abs(std::hypot(spec.ax, spec.ay) - spec.L) > 1e-6))
    value.fail("has its fixed pin on the circle of the other", "ax² + ay² must differ from L²");
  if (geometry_alone) return spec;
  spec.stiffness = section.at("stiffness").number(Quantity::stiffness, Sign::positive);
  spec.free_length = section.at("free_length").number(Quantity::length, Sign::not_negative);
  spec.joint_stiffness = section.at("joint_stiffness").number(Quantity::number, Sign::positive);
  if (const Value* effect = section.find("effect")) spec.torque = effect->choice({"stiffness", "torque"}) == "torque";
  return spec;
}

ElastostaticSpec::Listed read_listed(const Value& value) {
  const Section section(value);
  section.allow({"joint", "at"});
  ElastostaticSpec::Listed listed;
  listed.joint = section.at("joint").exact_name();
  for (const Value& item : section.at("at").items("a list of positions is expected")) {
    const Measured position = item.measured({Quantity::angle, Quantity::length});
    if (position.quantity != Quantity::number && listed.quantity != Quantity::number &&
        position.quantity != listed.quantity)
      item.fail("has another unit than the positions before", "all lengths or all angles");
    if (position.quantity != Quantity::number) listed.quantity = position.quantity;
    listed.at.push_back(position.value);
  }
  if (listed.at.empty()) section.at("at").fail("is empty", "at least one position is needed");
  // Parameters follow the file's order; only to find what stands there twice it is sorted.
  std::vector<double> sorted = listed.at;
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
    section.at("at").fail("has a position twice", "each one once");
  return listed;
}

}  // namespace

ElastostaticSpec read_elastostatic(const Value& value) {
  const Section section(value);
  section.allow({"compliance", "loads", "gravity", "link_weights", "compensator", "compensator_from", "listed"});
  ElastostaticSpec spec;
  spec.line = value.line();
  if (const Value* compliance = section.find("compliance"))
    for (const yaml::Entry& entry : Section(*compliance).entries())
      spec.compliance.emplace_back(entry.key, entry.value.measured({Quantity::compliance}, Sign::not_negative));
  for (const yaml::Entry& entry : Section(section.at("loads")).entries())
    spec.loads.push_back(read_load(entry.key.value, entry.value));
  if (spec.loads.empty()) section.at("loads").fail("is empty", "at least one load case is needed");
  if (const Value* gravity = section.find("gravity")) spec.gravity = gravity->vector(Quantity::number);
  if (const Value* weights = section.find("link_weights")) spec.link_gravity = weights->flag();
  if (const Value* listed = section.find("listed")) spec.listed = read_listed(*listed);
  if (const Value* from = section.find("compensator_from")) {
    from->choice({"compliances"});
    spec.derived_compensator = read_compensator(section.at("compensator"), true);
    if (!spec.listed || spec.listed->joint.value != spec.derived_compensator->joint.value)
      from->fail("needs compliances of the compensator's joint", "listed: {joint: …, at: […]} with the same joint");
    if (spec.listed->at.size() < 3)
      section.at("listed").fail("has too few positions", "three at least: a compensator has three constants");
  } else if (const Value* compensator = section.find("compensator")) {
    spec.compensator = read_compensator(*compensator, false);
    if (spec.listed && spec.compensator->joint.value == spec.listed->joint.value)
      section.at("listed").fail("names the compensator's joint",
                                "its compliance is either listed or the spring's (or compensator_from: compliances)");
  }
  return spec;
}

}  // namespace posewright
