#include <numbers>

#include "sections.hpp"

namespace posewright {
namespace {

using yaml::Section;
using yaml::Sign;
using yaml::Value;

// Beyond this a block's covariance alone takes megabytes and tells nothing new.
constexpr int most_anchors = 500;

// Nearer to the vertical an inclination has hardly a direction.
constexpr double steepest = 89 * std::numbers::pi / 180;

/// {type: isotropic, noise}: one sigma.
Measured read_isotropic(const Value& value, std::initializer_list<Quantity> quantities) {
  const Section device(value);
  device.at("type").choice({"isotropic"});
  device.allow({"type", "noise"});
  return device.at("noise").measured(quantities, Sign::positive);
}

}  // namespace

DistanceMeasurement read_distance(const Section& section) {
  allow_instrument(section, {"targets", "anchors", "between", "range"});
  DistanceMeasurement distance;
  distance.targets = read_targets(section.at("targets"));
  if (const Value* between = section.find("between")) {
    between->choice({"configurations"});
    if (section.has("anchors")) between->fail("cannot be combined with anchors", "one of anchors, between is allowed");
  } else {
    distance.anchors = read_targets(section.at("anchors"));
  }
  if (const Value* range = section.find("range")) {
    const yaml::Range r = read_range(*range, {Quantity::length});
    if (!(r.lower >= 0)) range->fail("begins below zero", "distances are positive");
    distance.range_lower = r.lower;
    distance.range_upper = r.upper;
  }
  const Section device(section.at("device"));
  device.at("type").choice({"isotropic"});
  device.allow({"type", "noise", "noise_per_m"});
  distance.sigma = device.at("noise").number(Quantity::length, Sign::positive);
  if (const Value* per_m = device.find("noise_per_m"))
    distance.sigma_per_m = per_m->number(Quantity::length, Sign::not_negative);
  return distance;
}

PlaneMeasurement read_plane_distance(const Section& section) {
  allow_instrument(section, {"probe", "plane", "range"});
  PlaneMeasurement touched;
  touched.probe = {"probe", section.at("probe").vector(Quantity::length), section.at("probe").line()};
  const Section plane(section.at("plane"));
  plane.allow({"point", "normal", "radius"});
  touched.point = plane.at("point").vector(Quantity::length);
  touched.normal = read_direction(plane.at("normal"));
  touched.radius = plane.at("radius").number(Quantity::length, Sign::positive);
  const yaml::Range range = read_range(section.at("range"), {Quantity::length});
  touched.range_lower = range.lower;
  touched.range_upper = range.upper;
  touched.sigma = read_isotropic(section.at("device"), {Quantity::length}).value;
  return touched;
}

LineMeasurement read_line(const Section& section) {
  allow_instrument(section, {"sensor", "line", "range", "width"});
  LineMeasurement seen;
  if (const Value* sensor = section.find("sensor")) seen.sensor = read_placement(Section(*sensor));
  const Section line(section.at("line"));
  line.allow({"point", "direction", "length"});
  seen.point = line.at("point").vector(Quantity::length);
  seen.direction = read_direction(line.at("direction"));
  seen.length = line.at("length").number(Quantity::length, Sign::positive);
  const yaml::Range range = read_range(section.at("range"), {Quantity::length});
  seen.range_lower = range.lower;
  seen.range_upper = range.upper;
  seen.width = section.at("width").number(Quantity::length, Sign::positive);
  seen.sigma = read_isotropic(section.at("device"), {Quantity::length}).value;
  return seen;
}

InclinationMeasurement read_inclination(const Section& section) {
  allow_instrument(section, {"axes", "rpy", "up", "range"});
  InclinationMeasurement inclination;
  if (const Value* axes = section.find("axes"))
    inclination.axes = read_components(*axes, std::span(pose_components).first(3));
  if (const Value* rpy = section.find("rpy")) inclination.rpy = rpy->vector(Quantity::angle);
  if (const Value* up = section.find("up")) inclination.up = read_direction(*up);
  const Value& range = section.at("range");
  inclination.range = range.number(Quantity::angle, Sign::positive);
  if (!(inclination.range < steepest)) range.fail("reaches the vertical", "less than 89 deg is needed");
  inclination.sigma = read_isotropic(section.at("device"), {Quantity::angle}).value;
  return inclination;
}

CameraMeasurement read_camera(const Section& section) {
  allow_instrument(section, {"mount", "camera", "board"});
  CameraMeasurement camera;
  camera.on_hand = section.at("mount").choice({"hand", "fixed"}) == "hand";
  const Section lens(section.at("camera"));
  lens.allow({"focal", "centre", "distortion", "size", "position", "rpy"});
  const auto pair = [](const Value& value, double& x, double& y) {
    const std::vector<Value> numbers = value.items(2, "expected 2 numbers, in pixels");
    x = numbers[0].number(Quantity::number, Sign::positive);
    y = numbers[1].number(Quantity::number, Sign::positive);
  };
  pair(lens.at("focal"), camera.fx, camera.fy);
  pair(lens.at("centre"), camera.cx, camera.cy);
  pair(lens.at("size"), camera.width, camera.height);
  if (const Value* distortion = lens.find("distortion")) {
    const std::vector<Value> k = distortion->items(5, "expected 5 numbers k1, k2, p1, p2, k3");
    for (std::size_t i = 0; i < 5; ++i) camera.distortion[i] = k[i].number(Quantity::number);
  }
  const auto placement = [](const Section& of) {
    Placement p;
    if (const Value* position = of.find("position")) p.position = position->vector(Quantity::length);
    if (const Value* rpy = of.find("rpy")) p.rpy = rpy->vector(Quantity::angle);
    return p;
  };
  camera.camera = placement(lens);
  const Section board(section.at("board"));
  board.allow({"rows", "columns", "spacing", "position", "rpy"});
  camera.rows = board.at("rows").integer(1, 100);
  camera.columns = board.at("columns").integer(1, 100);
  if (camera.rows * camera.columns < 3 || camera.rows < 2 || camera.columns < 2)
    board.value().fail("has too few points", "at least 2 rows and 2 columns are needed");
  if (camera.rows * camera.columns > most_anchors)
    board.value().fail("has too many points", "at most " + std::to_string(most_anchors) + " are allowed");
  camera.spacing = board.at("spacing").number(Quantity::length, Sign::positive);
  camera.board = placement(board);
  camera.sigma = read_isotropic(section.at("device"), {Quantity::number}).value;
  return camera;
}

JointsMeasurement read_joint_sensors(const Section& section) {
  section.allow({"type", "name", "sensors", "device", "repeats"});
  JointsMeasurement joints;
  if (const Value* sensors = section.find("sensors")) {
    joints.sensors = sensors->texts();
    if (joints.sensors.empty()) sensors->fail("is empty", "at least one sensor is needed; leave it out for all");
  }
  const Measured noise = read_isotropic(section.at("device"), {Quantity::angle, Quantity::length});
  joints.sigma = noise.value;
  joints.quantity = noise.quantity;
  return joints;
}

}  // namespace posewright
