#include "sections.hpp"

namespace posewright {
namespace {

using yaml::Section;
using yaml::Sign;
using yaml::Value;

WorkspaceSpec read_joints(const Section& joints) {
  joints.allow({"margin", "margin_length", "limits"});
  WorkspaceSpec workspace;
  if (const Value* margin = joints.find("margin"))
    workspace.joint_margin = margin->number(Quantity::angle, Sign::not_negative);
  if (const Value* margin = joints.find("margin_length"))
    workspace.joint_margin_length = margin->number(Quantity::length, Sign::not_negative);
  if (const Value* limits = joints.find("limits"))
    for (const yaml::Entry& entry : Section(*limits).entries()) {
      const yaml::Range range = read_range(entry.value, {Quantity::angle, Quantity::length});
      workspace.limits.push_back({entry.key, range.lower, range.upper, range.quantity});
    }
  return workspace;
}

WorkspaceSpec read_pose(const Section& pose) {
  pose.allow({"x", "y", "z", "rx", "ry", "rz"});
  WorkspaceSpec workspace;
  for (std::size_t i = 0; i < pose_components.size(); ++i) {
    const Quantity quantity = i < 3 ? Quantity::length : Quantity::angle;
    const Value& limits = pose.at(pose_components[i]);
    const yaml::Range range = read_range(limits, {quantity});
    workspace.limits.push_back({{std::string(pose_components[i]), limits.line()}, range.lower, range.upper, quantity});
  }
  return workspace;
}

}  // namespace

WorkspaceSpec read_workspace(const Value& value, const RobotSpec& robot) {
  const Section section(value);
  if (std::holds_alternative<SixLegsSpec>(robot)) {
    section.allow({"pose"});
    const Value* pose = section.find("pose");
    return pose == nullptr ? WorkspaceSpec{} : read_pose(Section(*pose));
  }
  section.allow({"joints"});
  const Value* joints = section.find("joints");
  return joints == nullptr ? WorkspaceSpec{} : read_joints(Section(*joints));
}

}  // namespace posewright
