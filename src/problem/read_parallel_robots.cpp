#include <cmath>

#include "sections.hpp"

namespace posewright {
namespace {

using yaml::Section;
using yaml::Sign;
using yaml::Value;

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

LegSpec read_leg(const Value& value, LegActuation actuation) {
  const Section section(value);
  LegSpec leg;
  leg.line = value.line();
  if (actuation == LegActuation::extend) {
    section.allow({"a", "b", "l"});
    if (const Value* l = section.find("l")) leg.l = l->number(Quantity::length, Sign::not_negative);
  } else {
    section.allow({"a", "b", "u", "l"});
    leg.l = section.at("l").number(Quantity::length, Sign::positive);
  }
  leg.a = read_joint_centre(section.at("a"));
  leg.b = read_joint_centre(section.at("b"));
  if (const Value* u = section.find("u")) {
    // stableNormalized: the length of a direction written with huge or tiny numbers neither overflows nor vanishes.
    leg.u = u->vector(Quantity::number).stableNormalized();
    if (!(leg.u.norm() > 0.5)) u->fail("has length zero", "a direction is needed");
    // ux and uy are the parameters of the direction; a horizontal one cannot be told by them.
    if (!(std::abs(leg.u.z()) > 0.05))
      u->fail("is (nearly) horizontal",
              "turn the base frame (placement) so that every u has a share of 0.05 or more in z");
  }
  return leg;
}

void read_own_placement(const Section& robot, Placement& placement) {
  if (const Value* value = robot.find("placement")) placement = read_placement(Section(*value));
}

double read_encoder_noise(const Section& robot) {
  const Value* noise = robot.find("encoder_noise");
  return noise == nullptr ? 0.0 : noise->number(Quantity::angle, Sign::not_negative);
}

}  // namespace

SixLegsSpec read_six_legs(const Section& robot, LegActuation actuation) {
  robot.allow({"model", "placement", "reference", "actuators", "legs"});
  SixLegsSpec spec;
  spec.actuation = actuation;
  spec.line = robot.value().line();
  read_own_placement(robot, spec.placement);
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

  for (const Value& leg : robot.at("legs").items(6, "exactly 6 legs are expected"))
    spec.legs.push_back(read_leg(leg, actuation));
  return spec;
}

FiveBarSpec read_five_bar(const Section& robot) {
  robot.allow({"model", "placement", "encoder_noise", "legs", "range"});
  FiveBarSpec spec;
  read_own_placement(robot, spec.placement);
  spec.encoder_noise = read_encoder_noise(robot);
  const std::vector<Value> legs = robot.at("legs").items(2, "exactly 2 legs are expected");
  for (std::size_t i = 0; i < 2; ++i) {
    const Section leg(legs[i]);
    leg.allow({"base", "proximal", "distal", "elbow"});
    const std::vector<Value> base = leg.at("base").items(2, "expected 2 numbers [x, y]");
    spec.legs[i].base = {base[0].number(Quantity::length), base[1].number(Quantity::length)};
    spec.legs[i].proximal = leg.at("proximal").number(Quantity::length, Sign::positive);
    spec.legs[i].distal = leg.at("distal").number(Quantity::length, Sign::positive);
    spec.legs[i].elbow = leg.at("elbow").choice({"left", "right"}) == "left" ? 1.0 : -1.0;
  }
  const Section range(robot.at("range"));
  range.allow({"x", "y"});
  const yaml::Range x = read_range(range.at("x"), {Quantity::length}),
                    y = read_range(range.at("y"), {Quantity::length});
  spec.x_lower = x.lower, spec.x_upper = x.upper, spec.y_lower = y.lower, spec.y_upper = y.upper;
  return spec;
}

DeltaSpec read_delta(const Section& robot) {
  robot.allow(
      {"model", "placement", "encoder_noise", "base_radius", "platform_radius", "arm", "forearm", "travel", "range"});
  DeltaSpec spec;
  read_own_placement(robot, spec.placement);
  spec.encoder_noise = read_encoder_noise(robot);
  spec.base_radius = robot.at("base_radius").number(Quantity::length, Sign::positive);
  spec.platform_radius = robot.at("platform_radius").number(Quantity::length, Sign::not_negative);
  spec.arm = robot.at("arm").number(Quantity::length, Sign::positive);
  spec.forearm = robot.at("forearm").number(Quantity::length, Sign::positive);
  const yaml::Range travel = read_range(robot.at("travel"), {Quantity::angle});
  spec.travel_lower = travel.lower;
  spec.travel_upper = travel.upper;
  const Section range(robot.at("range"));
  range.allow({"x", "y", "z"});
  for (int k = 0; k < 3; ++k) {
    const yaml::Range r = read_range(range.at(std::string_view("xyz").substr(std::size_t(k), 1)), {Quantity::length});
    spec.lower[k] = r.lower;
    spec.upper[k] = r.upper;
  }
  return spec;
}

CompensatorGeometrySpec read_compensator_geometry(const Section& robot) {
  robot.allow({"model", "L", "ax", "ay", "range", "encoder_noise"});
  CompensatorGeometrySpec spec;
  spec.L = robot.at("L").number(Quantity::length, Sign::positive);
  spec.ax = robot.at("ax").number(Quantity::length);
  spec.ay = robot.at("ay").number(Quantity::length);
  const yaml::Range range = read_range(robot.at("range"), {Quantity::angle});
  spec.lower = range.lower;
  spec.upper = range.upper;
  spec.encoder_noise = read_encoder_noise(robot);
  return spec;
}

}  // namespace posewright
