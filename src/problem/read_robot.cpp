#include <cmath>
#include <map>

#include "sections.hpp"
#include "text.hpp"

namespace posewright {
namespace {

using yaml::Section;
using yaml::Sign;
using yaml::Value;

std::vector<std::pair<std::string, Located<std::string>>> read_parameter_names(const Value& value) {
  std::vector<std::pair<std::string, Located<std::string>>> names;
  std::map<std::string, std::string> taken;
  for (const yaml::Entry& entry : Section(value).entries()) {
    if (entry.key.value.find_first_of("*?") != std::string::npos)
      entry.value.fail("is a name with * or ?", "a plain name is expected");
    const Located<std::string> model_name = entry.value.exact_name();
    const auto [first, added] = taken.emplace(model_name.value, entry.key.value);
    if (!added)
      entry.value.fail("is " + in_quotes(model_name.value),
                       "that parameter already has the name " + in_quotes(first->second) + ", one name is allowed");
    names.emplace_back(entry.key.value, model_name);
  }
  return names;
}

SerialArmSpec read_serial_arm(const Section& robot, const std::filesystem::path& folder) {
  robot.allow({"urdf", "base", "tip", "placement", "encoder_noise", "parameter_names"});
  SerialArmSpec arm;
  const Value& urdf = robot.at("urdf");
  arm.urdf = folder / urdf.text("a file name is expected");
  arm.line = urdf.line();
  if (const Value* base = robot.find("base")) arm.base = base->exact_name();
  if (const Value* tip = robot.find("tip")) arm.tip = tip->exact_name();
  if (const Value* placement = robot.find("placement")) arm.placement = read_placement(Section(*placement));
  if (const Value* noise = robot.find("encoder_noise"))
    arm.encoder_noise = noise->measured({Quantity::angle, Quantity::length}, Sign::not_negative).value;
  if (const Value* names = robot.find("parameter_names")) arm.parameter_names = read_parameter_names(*names);
  return arm;
}

/// [x, y, z] or {radius, angle, z} about the frame's z axis.
Eigen::Vector3d read_joint_centre(const Value& value) {
  if (!value.is_mapping()) return value.vector(Quantity::length);
  const Section polar(value);
  polar.allow({"radius", "angle", "z"});
  const double radius = polar.at("radius").number(Quantity::length, Sign::positive);
  const double angle = polar.at("angle").number(Quantity::angle);
  const Value* z = polar.find("z");
  return {radius * std::cos(angle), radius * std::sin(angle), z == nullptr ? 0.0 : z->number(Quantity::length)};
}

LegSpec read_leg(const Value& value) {
  const Section section(value);
  section.allow({"a", "b", "u", "l"});
  LegSpec leg;
  leg.line = value.line();
  leg.a = read_joint_centre(section.at("a"));
  leg.b = read_joint_centre(section.at("b"));
  if (const Value* u = section.find("u")) {
    // stableNormalized: the length of a direction written with huge or tiny numbers neither overflows nor vanishes.
    leg.u = u->vector(Quantity::number).stableNormalized();
    if (!(leg.u.norm() > 0.5)) u->fail("has length zero", "a direction is needed");
  }
  leg.l = section.at("l").number(Quantity::length, Sign::positive);
  return leg;
}

SixPusSpec read_six_pus(const Section& robot) {
  robot.allow({"model", "reference", "actuators", "legs"});
  SixPusSpec spec;
  spec.line = robot.value().line();
  const Section reference(robot.at("reference"));
  reference.at("position");
  spec.reference = read_placement(reference);

  const Section actuators(robot.at("actuators"));
  actuators.allow({"travel", "noise"});
  const yaml::Range travel = read_range(actuators.at("travel"), {Quantity::length});
  spec.travel_lower = travel.lower;
  spec.travel_upper = travel.upper;
  if (const Value* noise = actuators.find("noise"))
    spec.actuator_noise = noise->number(Quantity::length, Sign::not_negative);

  for (const Value& leg : robot.at("legs").items(6, "exactly 6 legs are expected")) spec.legs.push_back(read_leg(leg));
  return spec;
}

}  // namespace

Placement read_placement(const Section& section) {
  section.allow({"position", "rpy"});
  Placement placement;
  if (const Value* position = section.find("position")) placement.position = position->vector(Quantity::length);
  if (const Value* rpy = section.find("rpy")) placement.rpy = rpy->vector(Quantity::angle);
  return placement;
}

RobotSpec read_robot(const Value& value, const std::filesystem::path& folder) {
  const Section robot(value);
  const Value* model = robot.find("model");
  if (model != nullptr && robot.has("urdf")) model->fail("stands beside robot.urdf", "one of urdf, model is allowed");
  if (model != nullptr) {
    model->choice({"six_pus"});
    return read_six_pus(robot);
  }
  if (!robot.has("urdf")) {
    robot.allow({"urdf", "base", "tip", "placement", "encoder_noise", "parameter_names", "model", "reference",
                 "actuators", "legs"});
    value.fail("has neither urdf nor model", "one of both is required");
  }
  return read_serial_arm(robot, folder);
}

}  // namespace posewright
