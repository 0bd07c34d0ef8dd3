#include <fmt/format.h>

#include "posewright/outputs/format_text.hpp"
#include "posewright/outputs/write_plan.hpp"

namespace posewright {
std::string poses_csv(const Plan& plan) {
  if (plan.poses.empty() || plan.poses.front().configuration.empty()) return {};
  std::string text = "pose";
  const PlannedPose& first = plan.poses.front();
  for (const NamedValue& v : first.configuration) text += fmt::format(",{} [{}]", v.name, v.unit);
  for (const NamedValue& v : first.actuators) text += fmt::format(",{} [{}]", v.name, v.unit);
  if (!first.load_case.empty()) text += ",load_case";
  if (!first.station.empty()) text += ",station";
  for (const auto& [name, choice] : first.conditions) text += "," + formats::csv_cell(name);
  text += "\n";
  for (const PlannedPose& pose : plan.poses) {
    if (pose.measured) continue;
    text += std::to_string(pose.id);
    for (const NamedValue& v : pose.configuration) text += fmt::format(",{}", v.value);
    for (const NamedValue& v : pose.actuators) text += fmt::format(",{}", v.value);
    for (const std::string& choice : {pose.load_case, pose.station})
      if (!choice.empty()) text += "," + formats::csv_cell(choice);
    for (const auto& [name, choice] : pose.conditions) text += "," + formats::csv_cell(choice);
    text += "\n";
  }
  return text;
}

}  // namespace posewright
