#include "posewright/model/placed_frames.hpp"

#include <algorithm>
#include <string_view>

#include "posewright/model/forked_chain.hpp"
#include "posewright/model/instrument_view.hpp"
#include "posewright/model/nominal_placement.hpp"
#include "posewright/model/placement.hpp"
#include "posewright/model/urdf_reader.hpp"

namespace posewright {
namespace {

constexpr const char* placement_key = "robot: placement";

bool has_frame(const std::vector<Parameter>& parameters, const std::string& name) {
  return std::ranges::any_of(parameters, [&](const Parameter& p) { return p.name.starts_with(name + "."); });
}

/// Of an arm with several tips: the base of each measurement frame, and each tip whose pose is read.
std::vector<PlacedFrame> frames_of_ways(const SerialArmSpec& arm, const std::vector<Parameter>& at) {
  std::vector<PlacedFrame> frames;
  const auto add = [&](const std::string& name, const std::string& key, const std::string& in,
                       const Eigen::Isometry3d& nominal) {
    if (has_frame(at, name) && std::ranges::find(frames, name, &PlacedFrame::name) == frames.end())
      frames.push_back({name, key, in, nominal_placement(at, name, nominal)});
  };
  for (const WaySpec& way : arm.ways)
    add(base_name(way), way.in ? "" : placement_key, "measurement",
        way.in ? Eigen::Isometry3d::Identity() : isometry(arm.placement));
  for (const WaySpec& way : arm.ways) add(tool_name(way), "", "tip", Eigen::Isometry3d::Identity());
  return frames;
}

/// Base and tool of a serial arm. Denavit–Hartenberg parameters displace them about frames of their own.
std::vector<PlacedFrame> frames_of(const SerialArmSpec& arm, const ProblemVariant& variant,
                                   const std::vector<CalibratedValue>& values, const std::vector<Parameter>& at) {
  if (!arm.ways.empty()) return frames_of_ways(arm, at);
  const ChainDescription chain = read_urdf_chain(arm, variant.problem.at(arm.line));
  const ChainCorrection correction = chain_correction(chain, variant.spec.convention, values);
  return {{"base", placement_key, "measurement", chain.X_MeasureBase * correction.base.X},
          {"tool", "", "tip", correction.tip.X}};
}
/// Nothing of a robot without a placement is stated in a measurement frame.
template <class Robot>
std::vector<PlacedFrame> frames_of(const Robot& robot, const ProblemVariant&, const std::vector<CalibratedValue>&,
                                   const std::vector<Parameter>& at) {
  std::vector<PlacedFrame> frames;
  if constexpr (requires { robot.placement; })
    frames.push_back({"base", placement_key, "measurement", nominal_placement(at, "base", isometry(robot.placement))});
  frames.push_back({"tool", "", "tip", nominal_placement(at, "tool", Eigen::Isometry3d::Identity())});
  return frames;
}
/// Of a robot that is known by its poses, what is in its base besides: the camera that looks, or its target.
std::vector<PlacedFrame> frames_of(const GivenPosesSpec& robot, const ProblemVariant& variant,
                                   const std::vector<CalibratedValue>&, const std::vector<Parameter>& at) {
  const Eigen::Isometry3d X_MeasureBase = nominal_placement(at, "base", isometry(robot.placement));
  std::vector<PlacedFrame> frames = {
      {"base", placement_key, "measurement", X_MeasureBase},
      {"tool", "robot: tool", "tip", nominal_placement(at, "tool", isometry(robot.tool))}};
  if (const auto* pose = std::get_if<PoseMeasurement>(&variant.problem.measurement.instrument))
    frames.push_back({pose->on_hand ? "target" : "instrument", "", "base", X_MeasureBase.inverse(), "base"});
  return frames;
}

std::string key_of(const std::string& prefix) {
  constexpr std::string_view station = "station.";
  if (prefix.starts_with(station)) return "measurement: device: stations: " + prefix.substr(station.size());
  return "measurement: " + prefix;
}

}  // namespace

std::vector<PlacedFrame> placed_frames(const ProblemVariant& variant, const std::vector<CalibratedValue>& values) {
  std::vector<Parameter> at;
  at.reserve(values.size());
  for (const CalibratedValue& v : values) at.push_back({v.name, v.unit, v.value, 0.0, Role::interest});
  std::vector<PlacedFrame> frames =
      std::visit([&](const auto& robot) { return frames_of(robot, variant, values, at); }, variant.problem.robot);
  if (!has_frame(at, "tool")) std::erase_if(frames, [](const PlacedFrame& frame) { return frame.name == "tool"; });
  const InstrumentView view = view_of(variant.problem.measurement);
  if (view.has_places)
    for (const InstrumentView::Place& place : view.places)
      frames.push_back({place.parameters, key_of(place.parameters), view.places_on_tip ? "tip" : "measurement",
                        nominal_placement(at, place.parameters, isometry(place.station.placement))});
  if (!view.points_parameters.empty())
    frames.push_back({view.points_parameters, key_of(view.points_parameters),
                      view.points_on_tip ? "tip" : "measurement",
                      nominal_placement(at, view.points_parameters, isometry(view.points_at))});
  return frames;
}

}  // namespace posewright
