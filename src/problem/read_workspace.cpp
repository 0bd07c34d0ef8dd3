#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "posewright/controller/known_controllers.hpp"
#include "posewright/support/near_words.hpp"
#include "posewright/support/text.hpp"
#include "sections.hpp"

namespace posewright {
namespace {

// Each is looked at for every pose that is drawn.
constexpr int most_readable_for = 1000;

using yaml::Section;
using yaml::Sign;
using yaml::Value;

CoupledLimits read_coupled(const Value& value) {
  const Section section(value);
  section.allow({"sum", "range"});
  CoupledLimits coupled;
  coupled.line = value.line();
  for (const yaml::Entry& entry : Section(section.at("sum")).entries())
    coupled.factors.emplace_back(entry.key, entry.value.number(Quantity::number));
  if (coupled.factors.empty()) section.at("sum").fail("is empty", "names of joints with a factor each");
  const yaml::Range range = read_range(section.at("range"), {Quantity::angle, Quantity::length});
  coupled.lower = range.lower;
  coupled.upper = range.upper;
  coupled.quantity = range.quantity;
  return coupled;
}

/// Known ones without ranges would not help.
[[noreturn]] void refuse_controller(const Value& controller, const std::string& name, std::vector<std::string> known) {
  std::erase_if(known, [](const std::string& each) { return controller_settings(each).range_deg.empty(); });
  controller.fail("is " + in_quotes(name) + meant_instead(name, known) + ", neither a file nor a known controller",
                  fmt::format("known: {}", fmt::join(known, ", ")));
}

void read_joints(const Section& joints, WorkspaceSpec& workspace, const std::filesystem::path& folder) {
  joints.allow({"margin", "margin_length", "limits", "coupled", "controller"});
  if (const Value* controller = joints.find("controller")) {
    const std::string name = controller->text("a file name or a known controller is expected");
    const std::vector<std::string> known = known_controllers();
    const std::filesystem::path base = controller->base(folder);
    if (!is_controller_file(name, base) && std::find(known.begin(), known.end(), name) == known.end())
      refuse_controller(*controller, name, known);
    workspace.controller = controller_settings(name, base);
    if (workspace.controller->range_deg.empty())
      throw InputError({workspace.controller->file, 0}, "has no range_deg", "the ranges that poses are to keep");
  }
  if (const Value* margin = joints.find("margin"))
    workspace.joint_margin = margin->number(Quantity::angle, Sign::not_negative);
  // "margin: 0" has no unit: none at all.
  if (workspace.joint_margin == 0.0) workspace.joint_margin_length = 0.0;
  if (const Value* margin = joints.find("margin_length"))
    workspace.joint_margin_length = margin->number(Quantity::length, Sign::not_negative);
  if (const Value* limits = joints.find("limits"))
    for (const yaml::Entry& entry : Section(*limits).entries()) {
      const yaml::Range range = read_range(entry.value, {Quantity::angle, Quantity::length});
      workspace.limits.push_back({entry.key, range.lower, range.upper, range.quantity});
    }
  if (const Value* coupled = joints.find("coupled"))
    for (const Value& item : coupled->items("a list of {sum, range} is expected"))
      workspace.coupled.push_back(read_coupled(item));
}

/// @param prefix  of the coordinates' names
void read_pose(const Section& pose, const std::string& prefix, const std::array<std::string_view, 6>& names,
               WorkspaceSpec& workspace) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    const Quantity quantity = i < 3 ? Quantity::length : Quantity::angle;
    const Value& limits = pose.at(names[i]);
    const yaml::Range range = read_range(limits, {quantity});
    workspace.limits.push_back({{prefix + std::string(names[i]), limits.line()}, range.lower, range.upper, quantity});
  }
}

ToolBoxSpec read_tool_box(const Section& tool) {
  tool.allow({"point", "x", "y", "z"});
  ToolBoxSpec box;
  if (const Value* point = tool.find("point")) box.point = point->vector(Quantity::length);
  bool any = false;
  for (int k = 0; k < 3; ++k)
    if (const Value* limits = tool.find(pose_components[std::size_t(k)])) {
      const yaml::Range range = read_range(*limits, {Quantity::length});
      box.lower[k] = range.lower;
      box.upper[k] = range.upper;
      any = true;
    }
  if (!any) tool.value().fail("has no limits", "at least one of x, y, z is needed");
  return box;
}

SingularitySpec read_singularity(const Value& value) {
  SingularitySpec singularity;
  singularity.line = value.line();
  if (!value.is_mapping()) {
    singularity.smallest = value.number(Quantity::number, Sign::positive);
    return singularity;
  }
  const Section section(value);
  section.allow({"smallest", "length"});
  singularity.smallest = section.at("smallest").number(Quantity::number, Sign::positive);
  if (const Value* length = section.find("length"))
    singularity.length = length->number(Quantity::length, Sign::positive);
  return singularity;
}

std::vector<std::pair<SamplerKind, double>> read_samplers(const Section& section) {
  using Kind = SamplerKind;
  section.allow({"even", "boundary", "look_at", "obstacle_based", "gaussian", "clearance"});
  const std::array<std::pair<const char*, Kind>, 6> kinds = {{{"even", Kind::even},
                                                              {"look_at", Kind::look_at},
                                                              {"boundary", Kind::boundary},
                                                              {"obstacle_based", Kind::obstacle_based},
                                                              {"gaussian", Kind::gaussian},
                                                              {"clearance", Kind::clearance}}};
  std::vector<std::pair<Kind, double>> samplers;
  for (const auto& [name, kind] : kinds)
    if (const Value* share = section.find(name)) {
      const double number = share->number(Quantity::number, Sign::not_negative);
      if (number > 1e6) share->fail("is too large", "shares up to 1000000 are allowed");
      if (number > 0) samplers.emplace_back(kind, number);
    }
  if (samplers.empty()) section.value().fail("has no sampler with a share above 0", "a share > 0 is needed");
  return samplers;
}

}  // namespace

WorkspaceSpec read_workspace(const Value& value, const RobotSpec& robot, const std::filesystem::path& folder) {
  const Section section(value);
  WorkspaceSpec workspace;
  if (moves_by_pose(robot)) {
    section.allow({"pose", "tool", "singularity", "collision", "line_of_sight", "stations", "motion", "samplers",
                   "readable_for", "uncalibrated"});
    if (const Value* pose = section.find("pose"); pose != nullptr && std::holds_alternative<SixLegsSpec>(robot)) {
      const Section box(*pose);
      box.allow({"x", "y", "z", "rx", "ry", "rz"});
      read_pose(box, "", pose_components, workspace);
    } else if (pose != nullptr) {
      const Section box(*pose);
      box.allow({"x", "y", "z", "roll", "pitch", "yaw"});
      read_pose(box, "robot.", {"x", "y", "z", "roll", "pitch", "yaw"}, workspace);
    }
  } else {
    section.allow({"joints", "tool", "singularity", "collision", "line_of_sight", "stations", "motion", "samplers",
                   "readable_for", "uncalibrated"});
    if (const Value* joints = section.find("joints")) read_joints(Section(*joints), workspace, folder);
  }
  if (const Value* tool = section.find("tool")) workspace.tool = read_tool_box(Section(*tool));
  if (const Value* singularity = section.find("singularity")) workspace.singularity = read_singularity(*singularity);
  if (const Value* collision = section.find("collision")) workspace.collision = read_collision(*collision, folder);
  if (const Value* sight = section.find("line_of_sight")) workspace.line_of_sight = read_line_of_sight(*sight);
  if (const Value* stations = section.find("stations")) workspace.stations = read_station_choice(*stations);
  if (const Value* motion = section.find("motion")) workspace.motion = read_motion(*motion);
  if (const Value* samplers = section.find("samplers")) {
    workspace.samplers = read_samplers(Section(*samplers));
    workspace.samplers_line = samplers->line();
  }
  if (const Value* robots = section.find("readable_for"))
    workspace.readable_for = int(robots->integer(0, most_readable_for));
  if (const Value* sigmas = section.find("uncalibrated"))
    workspace.uncalibrated = sigmas->number(Quantity::number, Sign::not_negative);
  return workspace;
}

}  // namespace posewright
