#include <fmt/format.h>

#include <sstream>

#include "formats.hpp"
#include "posewright/formats/format_text.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/trimmed.hpp"
#include "program.hpp"

// poses.csv of a plan, without actuators.

namespace posewright {
namespace {

/// "joint_1 [deg]": name and unit.
std::pair<std::string, std::string> name_and_unit(const std::string& header) {
  const auto open = header.rfind('[');
  if (open == std::string::npos || header.back() != ']') return {header, ""};
  return {std::string(trimmed(std::string_view(header).substr(0, open))),
          header.substr(open + 1, header.size() - open - 2)};
}

/// Tables of other countries have ';' between cells, and a comma in numbers.
void require_commas(const std::vector<std::string>& header, const SourcePlace& place) {
  if (header.size() != 1) return;
  for (const auto& [mark, name] : {std::pair(';', "semicolons"), std::pair('\t', "tabs")})
    if (header.front().find(mark) != std::string::npos)
      throw InputError(place, fmt::format("has {} between its cells", name),
                       "commas between cells, and a point in numbers, as in 1,12.5: save the table that way");
}

Exported write_plain_csv(const PoseSequence& all, const ExportOptions&) {
  const PoseSequence sequence = formats::to_measure(all);
  std::string text = "pose";
  for (std::size_t i = 0; i < sequence.names.size(); ++i)
    text += "," + formats::csv_cell(fmt::format("{} [{}]", sequence.names[i], sequence.units[i]));
  for (const auto& [name, label] : sequence.poses.front().choices) text += "," + formats::csv_cell(name);
  text += "\n";
  for (const SequencePose& pose : sequence.poses) {
    text += std::to_string(pose.id);
    for (const double value : pose.values) text += "," + formats::shortest(value);
    for (const auto& [name, label] : pose.choices) text += "," + formats::csv_cell(label);
    text += "\n";
  }
  return formats::one_file("poses.csv", text);
}

}  // namespace

std::vector<std::string> csv_cells(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quoted && c == '"' && i + 1 < line.size() && line[i + 1] == '"') cells.back() += line[++i];
    else if (c == '"') quoted = !quoted;
    else if (c == ',' && !quoted) cells.emplace_back();
    else cells.back() += c;
  }
  for (std::string& cell : cells) cell = std::string(trimmed(cell));
  return cells;
}

PoseTable read_csv_table(const std::string& bytes, const std::string& file) {
  PoseTable table;
  std::istringstream lines(bytes);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    line = std::string(trimmed(line));
    if (line.empty() || line.front() == '#') continue;
    const std::vector<std::string> cells = csv_cells(line);
    if (table.names.empty()) {
      require_commas(cells, {file, number});
      for (const std::string& cell : cells) {
        const auto [name, unit] = name_and_unit(cell);
        table.names.push_back(name);
        table.units.push_back(unit);
      }
      table.header = number;
      continue;
    }
    if (cells.size() != table.names.size())
      throw InputError({file, number}, fmt::format("has {} cells", cells.size()),
                       fmt::format("the header has {}", table.names.size()));
    table.rows.push_back({number, {cells.begin(), cells.end()}});
  }
  if (table.rows.empty()) throw InputError({file, 0}, "has no poses", "a header and one line a pose");
  return table;
}

namespace formats {

PoseFormat plain_csv() {
  return {.name = "csv",
          .description = "names and units in a header, SI",
          .used_by = "anything; poses.csv of a plan",
          .extension = ".csv",
          .write = write_plain_csv,
          .read = read_csv_table,
          .any_coordinates = true};
}

}  // namespace formats
}  // namespace posewright
