#include <fmt/format.h>

#include <algorithm>

#include "formats.hpp"
#include "posewright/formats/format_text.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/near_words.hpp"

namespace posewright {

const std::vector<PoseFormat>& pose_formats() {
  using namespace formats;
  static const std::vector<PoseFormat> table = {kuka_krl(),
                                                abb_rapid(),
                                                fanuc_tp(),
                                                urscript(),
                                                yaskawa_inform(),
                                                staubli_val3(),
                                                hexapod_gcs(),
                                                joint_trajectory(),
                                                srdf(),
                                                moveit(),
                                                robot_calibration(),
                                                figaroh(),
                                                figaroh_csv(),
                                                industrial_calibration(),
                                                industrial_hand_eye(),
                                                easy_handeye2(),
                                                easy_handeye2_on_base(),
                                                pybotics_npy(),
                                                pybotics_csv(),
                                                delmia(),
                                                robodk_csv(),
                                                plain_csv(),
                                                plain_json(),
                                                targets_csv(),
                                                spatial_analyzer(),
                                                powerinspect()};
  return table;
}

namespace {

const PoseFormat& find(const std::string& name, bool readable, const std::string& others = "") {
  std::string names;
  std::vector<std::string> words;
  for (const PoseFormat& format : pose_formats()) {
    if (readable && format.read == nullptr) continue;
    if (format.name == name) return format;
    words.push_back(format.name);
    names += (names.empty() ? "" : ", ") + format.name;
  }
  throw InputError({},
                   fmt::format("{} is not a format that is {}{}", formats::in_quotes(name),
                               readable ? "read" : "written", meant_instead(name, words)),
                   "allowed: " + names + (others.empty() ? "" : ", " + others));
}

}  // namespace

const PoseFormat& find_pose_format(const std::string& name) { return find(name, false); }
const PoseFormat& find_readable_format(const std::string& name, const std::string& others) {
  return find(name, true, others);
}

std::string readable_format_names() {
  std::string names;
  for (const PoseFormat& format : pose_formats())
    if (format.read != nullptr) names += (names.empty() ? "" : ", ") + format.name;
  return names;
}

Exported export_poses(const PoseFormat& format, const PoseSequence& sequence, const ExportOptions& options) {
  const bool poses_alone = std::ranges::find(sequence.names, "robot.roll") != sequence.names.end();
  if (poses_alone && format.name != "csv" && format.name != "json")
    throw CannotDo(format.name +
                   " is for robots with joints, the plan has poses of the tip (robot: poses); csv and json " +
                   "have a place for them");
  if (!format.any_coordinates) {
    const char* others = "; csv and json have a place for them";
    if (sequence.is_platform)
      throw CannotDo(format.name + " is a list of joint values, the plan's coordinates are those of a platform" +
                     others);
    if (std::any_of(sequence.names.begin(), sequence.names.end(),
                    [](const std::string& name) { return name.ends_with(".second"); }))
      throw CannotDo(format.name + " has one robot pose in a row, the plan pairs of them" + others);
  }
  return format.write(sequence, options);
}

PoseTable table_of(const PoseSequence& sequence) {
  PoseTable table;
  table.names = sequence.names;
  table.problem_sha256 = sequence.problem_sha256;
  table.parameters_file = sequence.parameters_file;
  table.units.resize(table.names.size());
  for (const auto& [name, label] : sequence.poses.empty() ? PoseChoices{} : sequence.poses.front().choices)
    table.names.push_back(name);
  table.units.resize(table.names.size());
  for (const SequencePose& pose : sequence.poses) {
    PoseRow row;
    row.cells.assign(pose.values.begin(), pose.values.end());
    for (const auto& [name, label] : pose.choices) row.cells.emplace_back(label);
    row.id = pose.id;
    row.measured = pose.measured;
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace posewright
