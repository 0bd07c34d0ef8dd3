#include <fmt/format.h>

#include "formats.hpp"
#include "posewright/formats/format_text.hpp"
#include "program.hpp"
#include "yaml_list.hpp"

// Reader: MoveIt Calibration, loadJointStateBtnClicked: names must equal the group's active joints, in order.

namespace posewright::formats {
namespace {

Exported write_moveit(const PoseSequence& all, const ExportOptions&) {
  const PoseSequence sequence = to_measure(all);
  std::string text = yaml_head("joint states for MoveIt Calibration") + "joint_names:\n";
  for (const std::string& name : sequence.names) text += fmt::format("  - {}\n", yaml_text(name));
  text += "joint_values:\n";
  for (const SequencePose& pose : sequence.poses) {
    text += "  -\n";
    for (const double value : pose.values) text += fmt::format("    - {}\n", yaml_number(value));
  }
  return one_file("calposes.yaml", text, list_notes(sequence));
}

PoseTable read_moveit(const std::string& bytes, const std::string& file) {
  return YamlList::read(bytes, file, [](const YamlList& yaml, const YAML::Node& root) {
    PoseTable table;
    table.names = yaml.texts(yaml.at(root, "joint_names"), "joint_names");
    table.units.resize(table.names.size());
    for (const YAML::Node& row : yaml.items(yaml.at(root, "joint_values"), "joint_values"))
      table.rows.push_back(yaml.row(row, "joint_values", table.names.size()));
    return table;
  });
}

}  // namespace

PoseFormat moveit() {
  return {.name = "moveit",
          .description = "joint states",
          .used_by = "MoveIt Calibration",
          .extension = ".yaml",
          .write = write_moveit,
          .read = read_moveit,
          .ending_matters = true};
}

}  // namespace posewright::formats
