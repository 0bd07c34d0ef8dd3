#include <fmt/format.h>

#include "posewright/outputs/write_plan.hpp"

namespace posewright {
namespace {

/// A name as a CSV cell: quoted where it has a comma or a quote (RFC 4180).
std::string quoted(const std::string& name) {
  if (name.find_first_of(",\"") == std::string::npos) return name;
  std::string text = "\"";
  for (const char c : name) text += c == '"' ? "\"\"" : std::string(1, c);
  return text + "\"";
}

}  // namespace

std::string poses_csv(const Plan& plan) {
  if (plan.poses.empty() || plan.poses.front().configuration.empty()) return {};
  std::string text = "pose";
  const PlannedPose& first = plan.poses.front();
  for (const NamedValue& v : first.configuration) text += fmt::format(",{} [{}]", v.name, v.unit);
  for (const NamedValue& v : first.actuators) text += fmt::format(",{} [{}]", v.name, v.unit);
  if (!first.load_case.empty()) text += ",load_case";
  if (!first.station.empty()) text += ",station";
  text += "\n";
  for (const PlannedPose& pose : plan.poses) {
    if (pose.measured) continue;
    text += std::to_string(pose.id);
    for (const NamedValue& v : pose.configuration) text += fmt::format(",{}", v.value);
    for (const NamedValue& v : pose.actuators) text += fmt::format(",{}", v.value);
    for (const std::string& choice : {pose.load_case, pose.station})
      if (!choice.empty()) text += "," + quoted(choice);
    text += "\n";
  }
  return text;
}

}  // namespace posewright
