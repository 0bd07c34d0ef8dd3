#include "number_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "posewright/formats/format_text.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/read_number.hpp"
#include "posewright/support/trimmed.hpp"

namespace posewright::formats {
namespace {

/// Cells of a line; a blank as the separator stands for any number of them.
std::vector<std::string_view> cells_of(std::string_view line, char separator) {
  std::vector<std::string_view> cells;
  while (true) {
    const auto end = line.find(separator);
    const std::string_view cell = trimmed(line.substr(0, end));
    if (separator != ' ' || !cell.empty()) cells.push_back(cell);
    if (end == std::string_view::npos) return cells;
    line.remove_prefix(end + 1);
  }
}

}  // namespace

bool parse_number(std::string_view text, double& value) {
  if (text.starts_with('+')) text.remove_prefix(1);
  const std::optional<double> number = read_double(text);
  if (number) value = *number == 0 ? 0.0 : *number;
  return number && std::isfinite(value);
}

std::vector<NumberRow> read_number_rows(const std::string& bytes, const std::string& file, char separator, bool header,
                                        std::size_t skip) {
  std::vector<NumberRow> rows;
  std::istringstream lines(bytes);
  std::string line;
  bool first = true;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (trimmed(line).empty() || trimmed(line).front() == '#') continue;
    std::vector<std::string_view> cells = cells_of(line, separator);
    cells.erase(cells.begin(), cells.begin() + std::ptrdiff_t(std::min(skip, cells.size())));
    double value = 0;
    const bool is_header = header && first && std::none_of(cells.begin(), cells.end(), [&](std::string_view cell) {
                             return parse_number(cell, value);
                           });
    first = false;
    if (is_header) continue;
    NumberRow row{number, {}};
    for (const std::string_view cell : cells) {
      if (!parse_number(cell, value))
        throw InputError({file, number}, in_quotes(cell) + " is not a number", "finite numbers with a decimal point");
      row.values.push_back(value);
    }
    if (row.values.empty() || (!rows.empty() && row.values.size() != rows.front().values.size()))
      throw InputError(
          {file, number}, fmt::format("has {} numbers", row.values.size()),
          rows.empty() ? "at least one" : fmt::format("the rows before have {}", rows.front().values.size()));
    rows.push_back(std::move(row));
  }
  if (rows.empty()) throw InputError({file, 0}, "has no poses", "one line of numbers a pose");
  return rows;
}

}  // namespace posewright::formats
