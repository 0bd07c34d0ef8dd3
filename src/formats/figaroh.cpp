#include <fmt/format.h>

#include <algorithm>

#include "formats.hpp"
#include "posewright/formats/format_text.hpp"
#include "program.hpp"
#include "yaml_list.hpp"

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

/// The targets' names where every pose has the same ones, seen from one station; empty otherwise.
std::vector<std::string> markers(const PoseSequence& sequence) {
  const auto names_of = [](const SequencePose& pose) {
    std::vector<std::string> names;
    for (const SequenceTarget& target : pose.targets) names.push_back(target.name);
    return names;
  };
  const std::vector<std::string> names = names_of(sequence.poses.front());
  for (const SequencePose& pose : sequence.poses) {
    if (names_of(pose) != names) return {};
    for (const SequenceTarget& target : pose.targets)
      if (target.station != sequence.poses.front().targets.front().station) return {};
  }
  return names;
}

Exported write_figaroh_csv(const PoseSequence& all, const ExportOptions&) {
  const PoseSequence sequence = to_measure(all);
  const std::vector<std::string> names = markers(sequence);
  const std::size_t count = std::max<std::size_t>(names.size(), 1);
  std::string text = "posewright";
  for (std::size_t k = 1; k <= count; ++k) text += fmt::format(",x{0},y{0},z{0}", k);
  for (const std::string& name : sequence.names) text += "," + csv_cell(name);
  text += "\n";
  for (const SequencePose& pose : sequence.poses) {
    text += names.empty() ? "to be measured" : "predicted";
    for (std::size_t k = 0; k < count; ++k)
      for (int i = 0; i < 3; ++i)
        text += "," + (names.empty() || pose.targets[k].hidden ? "nan" : shortest(pose.targets[k].position[i]));
    for (const double value : pose.values) text += "," + shortest(value);
    text += "\n";
  }
  std::vector<std::string> notes = list_notes(sequence);
  if (names.empty())
    notes.push_back("marker positions are nan: the plan has no targets seen from one station; fill in measured values");
  else
    notes.push_back(fmt::format("marker positions ({}; station frame) are predictions; replace them by measured values",
                                ascii(fmt::format("{}", fmt::join(names, ", ")))));
  return one_file("calibration.csv", text, notes);
}

}  // namespace

PoseFormat figaroh() {
  return {.name = "figaroh",
          .description = "joint names and configurations",
          .used_by = "FIGAROH",
          .extension = ".yaml",
          .write = write_figaroh,
          .read = read_figaroh};
}

PoseFormat figaroh_csv() {
  return {.name = "figaroh-csv",
          .description = "measurements: joints and marker columns",
          .used_by = "FIGAROH",
          .extension = ".csv",
          .needs = "targets for predicted positions",
          .write = write_figaroh_csv,
          .read = read_csv_table,
          .to_be_filled = true};
}

}  // namespace posewright::formats
