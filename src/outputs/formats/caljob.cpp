#include <fmt/format.h>

#include "formats.hpp"
#include "posewright/outputs/format_text.hpp"
#include "program.hpp"
#include "yaml_list.hpp"

// Reader: industrial_calibration (ROS 1), caljob_creator; poses or whole scenes.

namespace posewright::formats {
namespace {

Exported write_caljob(const PoseSequence& all, const ExportOptions&) {
  const PoseSequence sequence = to_measure(all);
  std::string text = yaml_head("poses for caljob_creator") + "---\nposes:\n";
  for (const SequencePose& pose : sequence.poses) {
    text += "-\n     joint_values:\n";
    for (const double value : pose.values) text += fmt::format("        - {}\n", yaml_number(value));
  }
  return one_file("caljob_poses.yaml", text, list_notes(sequence));
}

PoseTable read_caljob(const std::string& bytes, const std::string& file) {
  return YamlList::read(bytes, file, [](const YamlList& yaml, const YAML::Node& root) {
    PoseTable table;
    if (!root.IsMap()) yaml.fail(root, "is not a mapping", "poses: or scenes:");
    const std::string key = root["scenes"].IsDefined() ? "scenes" : "poses";
    for (const YAML::Node& item : yaml.items(yaml.at(root, key), key)) {
      table.rows.push_back(yaml.row(yaml.at(item, "joint_values"), "joint_values", 0));
      table.rows.back().line = yaml.line(item);
    }
    return table;
  });
}

}  // namespace

PoseFormat caljob() {
  return {"caljob",
          "poses of a calibration job",
          "industrial_calibration (ROS 1), caljob_creator",
          ".yaml",
          "",
          {},
          false,
          false,
          write_caljob,
          read_caljob};
}

}  // namespace posewright::formats
