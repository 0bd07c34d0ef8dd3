#include <fmt/format.h>

#include "posewright/formats/format_text.hpp"
#include "posewright/results/plan.hpp"

namespace posewright {
std::string poses_csv(const Plan& plan) {
  if (plan.poses.empty() || plan.poses.front().configuration.empty()) return {};
  std::string text = "pose";
  const PlannedPose& first = plan.poses.front();
  for (const NamedValue& v : first.configuration) text += fmt::format(",{} [{}]", v.name, v.unit);
  for (const NamedValue& v : first.actuators) text += fmt::format(",{} [{}]", v.name, v.unit);
  for (const auto& [name, label] : first.choices) text += "," + formats::csv_cell(name);
  text += "\n";
  for (const PlannedPose& pose : plan.poses) {
    if (pose.measured) continue;
    text += std::to_string(pose.id);
    for (const NamedValue& v : pose.configuration) text += fmt::format(",{}", v.value);
    for (const NamedValue& v : pose.actuators) text += fmt::format(",{}", v.value);
    for (const auto& [name, label] : pose.choices) text += "," + formats::csv_cell(label);
    text += "\n";
  }
  return text;
}

}  // namespace posewright
