#include "sections.hpp"

namespace posewright {
namespace {

using yaml::Section;
using yaml::Sign;
using yaml::Value;

std::pair<double, double> ends(const Value& value, Quantity quantity) {
  const yaml::Range range = read_range(value, {quantity});
  return {range.lower, range.upper};
}

void read_cone(const Value& value, LineOfSightSpec& sight) {
  const auto half_angle = [](const Value& angle) {
    const double half = angle.number(Quantity::angle, Sign::positive);
    if (half > 3.1416) angle.fail("is more than a half turn", "the angle from the axis to the edge is expected");
    return half;
  };
  if (!value.is_mapping()) {
    sight.field_of_view = half_angle(value);
    return;
  }
  const Section section(value);
  section.allow({"axis", "half_angle"});
  sight.field_of_view = half_angle(section.at("half_angle"));
  if (const Value* axis = section.find("axis")) sight.axis = read_direction(*axis);
}

/// Positions of a box at equal steps.
std::vector<StationSpec> read_grid(const Section& box) {
  box.allow({"x", "y", "z", "points", "rpy"});
  Eigen::Vector3d lower, upper;
  const std::vector<Value> numbers = box.at("points").items(3, "expected 3 numbers of points along x, y, z");
  int count[3];
  for (std::size_t k = 0; k < 3; ++k) {
    count[k] = numbers[k].integer(1, 100);
    const Value& value = box.at(pose_components[k]);
    if (value.is_list()) std::tie(lower[Eigen::Index(k)], upper[Eigen::Index(k)]) = ends(value, Quantity::length);
    else lower[Eigen::Index(k)] = upper[Eigen::Index(k)] = value.number(Quantity::length);
    if (count[k] > 1 && !value.is_list()) value.fail("is one place", "a range is needed for several points");
  }
  if (long(count[0]) * count[1] * count[2] > 2000) box.at("points").fail("are more than 2000", "use fewer");
  Placement placement;
  if (const Value* rpy = box.find("rpy")) placement.rpy = rpy->vector(Quantity::angle);
  std::vector<StationSpec> stations;
  for (int i = 0; i < count[0]; ++i)
    for (int j = 0; j < count[1]; ++j)
      for (int k = 0; k < count[2]; ++k) {
        const Eigen::Array3d at(i, j, k), most(count[0], count[1], count[2]);
        const Eigen::Array3d share = (most > 1).select(at / (most - 1).max(1), 0.5);
        placement.position = lower.array() + share * (upper - lower).array();
        stations.push_back({"S" + std::to_string(stations.size() + 1), placement});
      }
  return stations;
}

}  // namespace

LineOfSightSpec read_line_of_sight(const Value& value) {
  const Section section(value);
  section.allow({"visible", "range", "elevation", "azimuth", "field_of_view", "acceptance", "normals", "beam",
                 "target_radius", "stations", "references", "every"});
  LineOfSightSpec sight;
  sight.line = value.line();
  if (const Value* visible = section.find("visible"))
    if (visible->text() != "all") sight.visible = visible->integer(1, 10000);
  if (const Value* range = section.find("range")) {
    sight.range = ends(*range, Quantity::length);
    if (sight.range->first < 0) range->fail("begins below zero", "distances are positive");
  }
  if (const Value* elevation = section.find("elevation")) sight.elevation = ends(*elevation, Quantity::angle);
  if (const Value* azimuth = section.find("azimuth")) sight.azimuth = ends(*azimuth, Quantity::angle);
  if (const Value* cone = section.find("field_of_view")) read_cone(*cone, sight);
  if (const Value* acceptance = section.find("acceptance"))
    sight.acceptance = acceptance->number(Quantity::angle, Sign::positive);
  if (const Value* normals = section.find("normals"))
    for (const yaml::Entry& entry : Section(*normals).entries())
      sight.normals.emplace_back(entry.key, read_direction(entry.value));
  if (sight.acceptance && sight.normals.empty())
    section.at("acceptance").fail("needs normals", "the directions in which the targets face are needed");
  if (!sight.acceptance && !sight.normals.empty())
    section.at("normals").fail("need acceptance", "the largest angle of incidence is needed");
  if (const Value* beam = section.find("beam")) sight.beam = beam->number(Quantity::length, Sign::positive);
  if (const Value* radius = section.find("target_radius"))
    sight.target_radius = radius->number(Quantity::length, Sign::not_negative);
  if (const Value* stations = section.find("stations")) sight.stations = read_stations(*stations);
  if (const Value* references = section.find("references")) sight.references = read_targets(*references);
  if (const Value* every = section.find("every")) sight.every = every->integer(1, 10000);
  if (sight.references.empty() != (sight.every == 0))
    value.fail("has one of references, every", "both are needed: which targets, and after how many poses");
  return sight;
}

StationChoiceSpec read_station_choice(const Value& value) {
  const Section section(value);
  section.allow({"among", "box", "choose"});
  StationChoiceSpec choice;
  choice.line = value.line();
  if (const Value* among = section.find("among")) choice.list = read_stations(*among);
  if (const Value* box = section.find("box")) {
    if (!choice.list.empty()) box->fail("cannot be combined with among", "one of among, box is allowed");
    choice.list = read_grid(Section(*box));
  }
  if (choice.list.empty()) value.fail("names no place", "one of among, box is needed");
  if (const Value* choose = section.find("choose")) choice.choose = choose->integer(1, int(choice.list.size()));
  return choice;
}

MotionSpec read_motion(const Value& value) {
  const Section section(value);
  section.allow({"velocity", "acceleration", "home", "speed", "settle", "reading", "station_change", "load_change",
                 "temperature_change", "reachable"});
  MotionSpec motion;
  motion.line = value.line();
  const auto read = [&](const char* key, std::initializer_list<Quantity> quantities, Sign sign, auto& into) {
    if (const Value* found = section.find(key))
      for (const yaml::Entry& entry : Section(*found).entries())
        into.emplace_back(entry.key, entry.value.measured(quantities, sign));
  };
  read("velocity", {Quantity::turn_rate, Quantity::speed}, Sign::positive, motion.velocity);
  read("acceleration", {Quantity::turn_acceleration, Quantity::acceleration}, Sign::positive, motion.acceleration);
  read("home", {Quantity::angle, Quantity::length}, Sign::any, motion.home);
  if (const Value* speed = section.find("speed")) {
    motion.speed = speed->number(Quantity::number, Sign::positive);
    if (motion.speed > 1) speed->fail("is more than 1", "a share of the velocities is expected");
  }
  const auto seconds = [&](const char* key, double& into) {
    if (const Value* found = section.find(key)) into = found->number(Quantity::time, Sign::not_negative);
  };
  seconds("settle", motion.settle);
  seconds("reading", motion.reading);
  seconds("station_change", motion.station_change);
  seconds("load_change", motion.load_change);
  seconds("temperature_change", motion.temperature_change);
  if (const Value* reachable = section.find("reachable")) motion.reachable = reachable->flag();
  return motion;
}

}  // namespace posewright
