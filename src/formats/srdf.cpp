#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>

#include "formats.hpp"
#include "number_rows.hpp"
#include "posewright/formats/format_text.hpp"
#include "posewright/support/error.hpp"
#include "program.hpp"

// Form: SRDF group_state, as MoveIt reads it.

namespace posewright::formats {
namespace {

Exported write_srdf(const PoseSequence& all, const ExportOptions& options) {
  const PoseSequence sequence = to_measure(all);
  const std::string group = xml_escaped(options.group.empty() ? "manipulator" : options.group);
  std::string text = fmt::format("<?xml version=\"1.0\"?>\n<!-- {} -->\n<robot name=\"{}\">\n", export_mark,
                                 xml_escaped(options.name.empty() ? "robot" : options.name));
  for (const SequencePose& pose : sequence.poses) {
    text += fmt::format("  <group_state name=\"cal_{:03}\" group=\"{}\">\n", pose.id, group);
    for (std::size_t i = 0; i < sequence.names.size(); ++i)
      text += fmt::format("    <joint name=\"{}\" value=\"{}\"/>\n", xml_escaped(sequence.names[i]),
                          shortest(pose.values[i]));
    text += "  </group_state>\n";
  }
  return one_file("calposes.srdf", text + "</robot>\n", list_notes(sequence));
}

PoseRow read_state(const tinyxml2::XMLElement& state, const std::string& file, PoseTable& table) {
  std::vector<std::string> names;
  std::vector<PoseCell> cells;
  for (const auto* joint = state.FirstChildElement("joint"); joint != nullptr;
       joint = joint->NextSiblingElement("joint")) {
    const char *name = joint->Attribute("name"), *value = joint->Attribute("value");
    double number = 0;
    if (name == nullptr || value == nullptr || !parse_number(value, number))
      throw InputError({file, joint->GetLineNum()}, "joint without name and value",
                       "<joint name=\"...\" value=\"number\"/>");
    names.emplace_back(name);
    cells.emplace_back(number);
  }
  if (names.empty()) throw InputError({file, state.GetLineNum()}, "group_state without joints", "one joint at least");
  if (table.names.empty()) {
    table.names = names;
    table.units.resize(names.size());
  }
  PoseRow row;
  row.line = state.GetLineNum();
  for (const std::string& name : table.names) {
    const auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end() || names.size() != table.names.size())
      throw InputError({file, row.line}, "group_state has other joints than the first of its group",
                       "the same joints in each");
    row.cells.push_back(cells[std::size_t(at - names.begin())]);
  }
  return row;
}

/// The states of the first group that has one.
PoseTable read_srdf(const std::string& bytes, const std::string& file) {
  tinyxml2::XMLDocument document;
  if (document.Parse(bytes.c_str(), bytes.size()) != tinyxml2::XML_SUCCESS)
    throw InputError({file, document.ErrorLineNum()}, "is not valid XML", "an SRDF is expected");
  const auto* robot = document.FirstChildElement("robot");
  if (robot == nullptr) throw InputError({file, 0}, "has no <robot>", "an SRDF is expected");
  PoseTable table;
  std::string group;
  for (const auto* state = robot->FirstChildElement("group_state"); state != nullptr;
       state = state->NextSiblingElement("group_state")) {
    const char* name = state->Attribute("group");
    if (name == nullptr) throw InputError({file, state->GetLineNum()}, "group_state without a group", "group=\"...\"");
    if (table.rows.empty()) group = name;
    if (group == name) table.rows.push_back(read_state(*state, file, table));
  }
  if (table.rows.empty()) throw InputError({file, 0}, "has no <group_state>", "one a pose");
  return table;
}

}  // namespace

PoseFormat srdf() {
  return {.name = "srdf",
          .description = "group states",
          .used_by = "MoveIt",
          .extension = ".srdf",
          .write = write_srdf,
          .read = read_srdf,
          .options = {"name", "group"}};
}

}  // namespace posewright::formats
