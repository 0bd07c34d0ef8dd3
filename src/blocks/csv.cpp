#include <cmath>
#include <string>
#include <vector>

#include "block_formats.hpp"
#include "posewright/support/read_number.hpp"
#include "posewright/support/trimmed.hpp"

namespace posewright {
namespace {

/// Calls body(cell, index) for each comma-separated cell; returns their number.
template <class Body>
int for_each_cell(std::string_view line, const Body& body) {
  int index = 0;
  while (true) {
    const auto comma = line.find(',');
    body(trimmed(line.substr(0, comma)), index++);
    if (comma == std::string_view::npos) return index;
    line.remove_prefix(comma + 1);
  }
}

bool parse_number(std::string_view cell, double& value) {
  if (cell.starts_with('+')) cell.remove_prefix(1);
  const std::optional<double> number = read_double(cell);
  if (number) value = *number;
  return number && std::isfinite(value);
}

/// Rows of numbers as one long vector; a first line with a cell that is not a number is the header.
struct Table {
  std::vector<double> values;
  std::vector<std::string> header;
  int columns = 0;
  std::size_t rows = 0;

  void add(std::string_view line, const SourcePlace& place) {
    const std::size_t before = values.size();
    std::string wrong;
    const int cells = for_each_cell(line, [&](std::string_view cell, int) {
      double value = 0;
      if (!parse_number(cell, value) && wrong.empty()) wrong = "'" + std::string(cell) + "'";
      values.push_back(value);
    });
    if (!wrong.empty() && rows == 0 && header.empty() &&
        line.find_first_of("abcdefghijklmnopqrstuvwxyz_\"") != line.npos && wrong != "'nan'" && wrong != "'inf'" &&
        wrong != "'-inf'") {
      values.resize(before);
      columns = for_each_cell(line, [&](std::string_view cell, int) { header.emplace_back(cell); });
      return;
    }
    if (!wrong.empty()) throw InputError(place, wrong + " is not a finite number", "decimal point, no units");
    if (columns == 0) columns = cells;
    if (cells != columns)
      throw InputError(place, "has " + std::to_string(cells) + " columns",
                       "every row needs " + std::to_string(columns));
    ++rows;
  }
};

}  // namespace

std::size_t count_blocks(std::size_t table_rows, std::optional<int> rows, const SourcePlace& place) {
  if (!rows) throw InputError(place, "is a table of rows", "say with --rows how many make one block");
  if (table_rows % std::size_t(*rows) != 0)
    throw InputError(place, "has " + std::to_string(table_rows) + " rows",
                     "a multiple of --rows " + std::to_string(*rows) + " is needed");
  return table_rows / std::size_t(*rows);
}

BlockFile parse_csv(std::string_view bytes, std::optional<int> rows, const SourcePlace& place) {
  Table table;
  SourcePlace here = place;
  while (!bytes.empty()) {
    ++here.line;
    const auto newline = bytes.find('\n');
    const std::string_view line = trimmed(bytes.substr(0, newline));
    bytes.remove_prefix(newline == std::string_view::npos ? bytes.size() : newline + 1);
    if (!line.empty() && line.front() != '#') table.add(line, here);
  }
  const std::size_t n = count_blocks(table.rows, rows, place);
  if (n == 0) throw InputError(place, "has no rows of numbers", "n·r rows of m columns are needed");
  BlockFile file{BlockArray(n, *rows, table.columns), std::move(table.header), {}};
  for (std::size_t i = 0; i < table.rows; ++i)
    std::copy_n(table.values.begin() + std::ptrdiff_t(i) * table.columns, table.columns,
                file.blocks.row(i / std::size_t(*rows), int(i % std::size_t(*rows))));
  return file;
}

}  // namespace posewright
