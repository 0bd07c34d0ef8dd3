#include <fmt/format.h>

#include "formats.hpp"
#include "posewright/formats/format_text.hpp"
#include "posewright/support/error.hpp"
#include "program.hpp"
#include "yaml_list.hpp"

namespace posewright::formats {
namespace {

Exported write_industrial_calibration(const PoseSequence& all, const ExportOptions&) {
  const PoseSequence sequence = to_measure(all);
  std::string text = yaml_head("measurements for industrial_calibration") +
                     "# pose: camera to target, m, as measured; replace every .nan\n";
  for (const SequencePose& pose : sequence.poses) {
    text += fmt::format(
        "'{}':\n  camera_joints: []\n  pose: {{qw: .nan, qx: .nan, qy: .nan, qz: .nan, x: .nan, y: .nan, z: .nan}}\n"
        "  target_joints:\n",
        pose.id);
    for (const double value : pose.values) text += fmt::format("  - {}\n", yaml_number(value));
  }
  std::vector<std::string> notes = list_notes(sequence);
  notes.push_back("the measured poses (camera to target) are .nan: replace them by measured values");
  notes.push_back(
      "the joints are those that carry the target; where they carry the camera, they belong in camera_joints");
  return one_file("measurements.yaml", text, notes);
}

PoseTable read_industrial_calibration(const std::string& bytes, const std::string& file) {
  return YamlList::read(bytes, file, [](const YamlList& yaml, const YAML::Node& root) {
    PoseTable table;
    if (!root.IsMap()) yaml.fail(root, "is not a mapping of measurements", "id: {camera_joints, pose, target_joints}");
    for (const auto& entry : root) {
      const YAML::Node camera = yaml.at(entry.second, "camera_joints"), target = yaml.at(entry.second, "target_joints");
      const bool has_camera = camera.size() > 0, has_target = target.size() > 0;
      if (has_camera == has_target)
        yaml.fail(entry.first, "has joints of both camera and target, or of none", "one robot, the other list empty");
      table.rows.push_back(has_camera ? yaml.row(camera, "camera_joints", 0) : yaml.row(target, "target_joints", 0));
    }
    return table;
  });
}

std::string pose_file(const SequencePose& pose) {
  Eigen::Quaterniond q(pose.tool_pose->linear());
  if (q.w() < 0) q.coeffs() *= -1;
  const Eigen::Vector3d p = pose.tool_pose->translation();
  return yaml_head(fmt::format("pose {}, predicted (nominal model)", pose.id)) +
         fmt::format("x: {}\ny: {}\nz: {}\nqx: {}\nqy: {}\nqz: {}\nqw: {}\n", yaml_number(p.x()), yaml_number(p.y()),
                     yaml_number(p.z()), yaml_number(q.x()), yaml_number(q.y()), yaml_number(q.z()),
                     yaml_number(q.w()));
}

Exported write_industrial_hand_eye(const PoseSequence& all, const ExportOptions&) {
  const PoseSequence sequence = to_measure(all);
  Exported exported;
  std::string list = yaml_head("hand-eye data of industrial_calibration") +
                     "# Take the images yourself: images/N.png with the robot at pose N.\ndata:\n";
  exported.files.push_back({"cal_data.yaml", ""});
  for (const SequencePose& pose : sequence.poses) {
    if (!pose.tool_pose)
      throw CannotDo(sequence.file + ": industrial-calibration-hand-eye needs tool poses; export the plan.json itself");
    list += fmt::format("- {{pose: poses/{0}.yaml, image: images/{0}.png}}\n", pose.id);
    exported.files.push_back({fmt::format("poses/{}.yaml", pose.id), pose_file(pose)});
  }
  exported.files.front().bytes = list;
  exported.notes = list_notes(sequence);
  exported.notes.push_back("the poses are those of the nominal model: replace them by the controller's values");
  return exported;
}

}  // namespace

PoseFormat industrial_calibration() {
  return {.name = "industrial-calibration",
          .description = "measurements, poses to be filled in",
          .used_by = "industrial_calibration",
          .extension = ".yaml",
          .write = write_industrial_calibration,
          .read = read_industrial_calibration,
          .to_be_filled = true};
}

PoseFormat industrial_hand_eye() {
  return {.name = "industrial-calibration-hand-eye",
          .description = "cal_data.yaml and a file a pose",
          .used_by = "industrial_calibration, hand-eye",
          .needs = "tool poses",
          .write = write_industrial_hand_eye,
          .several_files = true};
}

}  // namespace posewright::formats
