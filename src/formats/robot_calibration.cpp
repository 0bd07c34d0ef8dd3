#include <fmt/format.h>

#include <algorithm>

#include "formats.hpp"
#include "posewright/formats/format_text.hpp"
#include "program.hpp"
#include "yaml_list.hpp"

// Reader: robot_calibration (ROS 2), src/util/poses_from_yaml.cpp.

namespace posewright::formats {
namespace {

Exported write_robot_calibration(const PoseSequence& all, const ExportOptions&) {
  const PoseSequence sequence = to_measure(all);
  std::string text = yaml_head("poses for robot_calibration");
  for (const SequencePose& pose : sequence.poses)
    text += fmt::format("- joints: {}\n  positions: {}\n  features: []\n", yaml_texts(sequence.names),
                        yaml_numbers(pose.values));
  return one_file("calposes.yaml", text, list_notes(sequence));
}

PoseTable read_robot_calibration(const std::string& bytes, const std::string& file) {
  return YamlList::read(bytes, file, [](const YamlList& yaml, const YAML::Node& root) {
    PoseTable table;
    for (const YAML::Node& item : yaml.items(root, "the file")) {
      const auto joints = yaml.texts(yaml.at(item, "joints"), "joints");
      PoseRow row = yaml.row(yaml.at(item, "positions"), "positions", joints.size());
      row.line = yaml.line(item);
      if (table.names.empty()) {
        table.names = joints;
        table.units.resize(joints.size());
      }
      // Another order of the same joints is the same pose.
      std::vector<PoseCell> cells;
      for (const std::string& name : table.names) {
        const auto at = std::find(joints.begin(), joints.end(), name);
        if (at == joints.end() || joints.size() != table.names.size())
          yaml.fail(item, "has other joints than the first pose", "the same joints in each");
        cells.push_back(row.cells[std::size_t(at - joints.begin())]);
      }
      row.cells = std::move(cells);
      table.rows.push_back(std::move(row));
    }
    return table;
  });
}

}  // namespace

PoseFormat robot_calibration() {
  return {.name = "robot-calibration",
          .description = "list of joints and positions",
          .used_by = "robot_calibration (ROS 2)",
          .extension = ".yaml",
          .write = write_robot_calibration,
          .read = read_robot_calibration,
          .ending_matters = true};
}

}  // namespace posewright::formats
