#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <span>

#include "sections.hpp"
#include "text.hpp"

namespace posewright {
namespace {

using yaml::Section;
using yaml::Sign;
using yaml::Value;

/// Chosen components as ascending indices into `names`.
Components read_components(const Value& value, std::span<const std::string_view> names) {
  const std::string expected = fmt::format("allowed: {}", fmt::join(names, ", "));
  Components components;
  for (const Value& item : value.items("a list is expected, " + expected)) {
    const std::string name = item.text(expected);
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) item.fail("is " + in_quotes(name), expected);
    const int index = static_cast<int>(found - names.begin());
    if (std::find(components.begin(), components.end(), index) != components.end())
      item.fail("is " + in_quotes(name), "it is already in the list");
    components.push_back(index);
  }
  if (components.empty()) value.fail("is empty", expected);
  std::sort(components.begin(), components.end());
  return components;
}

/// The device's key `noise`, after its type has been judged.
Value read_device(const Value& value) {
  const Section device(value);
  // Other devices have other keys, so the type is judged before the keys.
  device.at("type").choice({"isotropic"});
  device.allow({"type", "noise"});
  return device.at("noise");
}

TargetSpec read_target(std::string name, const Value& value) {
  return {std::move(name), value.vector(Quantity::length), value.line()};
}

std::vector<TargetSpec> read_targets(const Value& value) {
  std::vector<TargetSpec> targets;
  for (const yaml::Entry& entry : Section(value).entries()) {
    if (entry.key.value.find_first_of("*?") != std::string::npos)
      entry.value.fail("is a name with * or ?", "a plain name is expected");
    targets.push_back(read_target(entry.key.value, entry.value));
  }
  if (targets.empty()) value.fail("is empty", "at least one target is needed");
  return targets;
}

PoseMeasurement read_pose(const Section& section) {
  section.allow({"type", "components", "device", "repeats", "repeatability"});
  PoseMeasurement pose;
  const Section noise(read_device(section.at("device")));
  noise.allow({"position", "rotation"});
  pose.position_sigma = noise.at("position").number(Quantity::length, Sign::positive);
  pose.rotation_sigma = noise.at("rotation").number(Quantity::angle, Sign::positive);
  if (const Value* components = section.find("components"))
    pose.components = read_components(*components, pose_components);
  return pose;
}

PointsMeasurement read_points(const Section& section, bool single) {
  const std::string_view key = single ? "target" : "targets";
  section.allow({"type", key, "components", "device", "repeats", "repeatability"});
  PointsMeasurement points;
  if (single) points.targets.push_back(read_target("target", section.at(key)));
  else points.targets = read_targets(section.at(key));
  const Value noise = read_device(section.at("device"));
  if (noise.is_list()) points.sigma = noise.vector(Quantity::length, Sign::positive);
  else points.sigma.setConstant(noise.number(Quantity::length, Sign::positive));
  if (const Value* components = section.find("components"))
    points.components = read_components(*components, std::span(pose_components).first(3));
  return points;
}

}  // namespace

MeasurementSpec read_measurement(const Value& value) {
  const Section section(value);
  MeasurementSpec measurement;
  measurement.line = value.line();
  const std::string type = section.at("type").choice({"pose", "points", "position"});
  if (type == "pose") measurement.instrument = read_pose(section);
  else measurement.instrument = read_points(section, type == "position");
  if (const Value* repeats = section.find("repeats"))
    measurement.repeats = repeats->integer(1, std::numeric_limits<int>::max());
  if (const Value* repeatability = section.find("repeatability"))
    measurement.repeatability = repeatability->number(Quantity::length, Sign::not_negative);
  return measurement;
}

}  // namespace posewright
