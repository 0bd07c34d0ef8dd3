#include <fmt/format.h>

#include "formats.hpp"
#include "posewright/formats/format_text.hpp"
#include "program.hpp"
#include "yaml_list.hpp"

// Reader: FIGAROH, optimal_config.py (load_data_set): a mapping of exactly two keys.

namespace posewright::formats {
namespace {

Exported write_figaroh(const PoseSequence& all, const ExportOptions&) {
  const PoseSequence sequence = to_measure(all);
  std::string text = yaml_head("configurations for FIGAROH");
  text += fmt::format("calibration_joint_names: {}\ncalibration_joint_configurations:\n", yaml_texts(sequence.names));
  for (const SequencePose& pose : sequence.poses) text += fmt::format("- {}\n", yaml_numbers(pose.values));
  return one_file("calposes.yaml", text, list_notes(sequence));
}

PoseTable read_figaroh(const std::string& bytes, const std::string& file) {
  return YamlList::read(bytes, file, [](const YamlList& yaml, const YAML::Node& root) {
    PoseTable table;
    table.names = yaml.texts(yaml.at(root, "calibration_joint_names"), "calibration_joint_names");
    table.units.resize(table.names.size());
    const std::string key = "calibration_joint_configurations";
    for (const YAML::Node& row : yaml.items(yaml.at(root, key), key))
      table.rows.push_back(yaml.row(row, key, table.names.size()));
    return table;
  });
}

}  // namespace

PoseFormat figaroh() {
  return {"figaroh",   "joint names and configurations", "FIGAROH", ".yaml", "", {}, false, false, write_figaroh,
          read_figaroh};
}

}  // namespace posewright::formats
