#include <fmt/format.h>

#include "formats.hpp"
#include "posewright/formats/format_text.hpp"
#include "program.hpp"
#include "yaml_list.hpp"

// Reader: industrial_calibration, examples/data/kinematic_calibration/measurements.yaml. `pose` is what a camera
// measures (camera to target), so the skeleton holds .nan there: a calibration that finds it left fails.

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

}  // namespace

PoseFormat industrial_calibration() {
  PoseFormat format = {"industrial-calibration",
                       "measurements, poses to be filled in",
                       "industrial_calibration",
                       ".yaml",
                       "",
                       {},
                       false,
                       false,
                       write_industrial_calibration,
                       read_industrial_calibration};
  format.to_be_filled = true;
  return format;
}

}  // namespace posewright::formats
