#include <fmt/format.h>

#include "documents.hpp"
#include "posewright/formats/pose_formats.hpp"
#include "posewright/lists/read_poses.hpp"
#include "posewright/problem/units.hpp"
#include "posewright/support/trimmed.hpp"

namespace posewright {
namespace {

/// Cells of joints are replaced; comments, other columns and line ends stay.
class CsvDocument : public PoseDocument {
 public:
  CsvDocument(std::string bytes, const std::string& name, const std::vector<Coordinate>& coordinates)
      : bytes_(std::move(bytes)), width_(coordinates.size()) {
    if (bytes_.find(compensated_mark) != std::string::npos) refuse_twice(name);
    poses_ = read_poses_text(bytes_, name, coordinates);
    std::string plain = bytes_;
    if (plain.starts_with(byte_order_mark)) plain.erase(0, byte_order_mark.size());
    table_ = read_csv_table(plain, name);
    const std::vector<std::size_t> places = places_of(table_.names, coordinates);
    for (std::size_t i = 0; i < table_.names.size(); ++i)
      if (places[i] < coordinates.size() && !coordinates[places[i]].choice())
        columns_.push_back({i, places[i], unit_of(i, coordinates[places[i]].unit)});
  }

  std::string text(const OtherValues& values, const std::string& remark) const override {
    std::vector<Column> actuators;
    for (std::size_t i = 0; i < table_.names.size(); ++i)
      for (std::size_t k = 0; k < values.actuator_names.size(); ++k)
        if (table_.names[i] == values.actuator_names[k]) actuators.push_back({i, k, unit_of(i, "m")});
    const std::size_t first = bytes_.starts_with(byte_order_mark) ? byte_order_mark.size() : 0;
    const std::size_t end = bytes_.find('\n');
    const char* line_end = end != std::string::npos && end > 0 && bytes_[end - 1] == '\r' ? "\r\n" : "\n";
    std::string result = bytes_.substr(0, first) + "# " + remark + line_end;
    std::size_t pose = 0;
    int number = 1;
    for (std::size_t begin = first; begin < bytes_.size(); ++number) {
      const std::size_t stop = std::min(bytes_.find('\n', begin), bytes_.size());
      std::string line = bytes_.substr(begin, stop - begin);
      if (pose < table_.rows.size() && table_.rows[pose].line == number) {
        std::vector<std::string> cells(table_.names.size());
        // What stays is not written anew: digits of its own are somebody's.
        for (const Column& c : columns_)
          if (values.configurations[pose * width_ + c.value] != poses_.configurations[pose][c.value])
            cells[c.column] = fmt::format("{}", values.configurations[pose * width_ + c.value] / c.unit);
        for (const Column& c : actuators)
          cells[c.column] = fmt::format("{}", values.actuators[pose * values.actuator_names.size() + c.value] / c.unit);
        line = with_cells(line, cells);
        ++pose;
      }
      result += line;
      if (stop < bytes_.size()) result += '\n';
      begin = stop + 1;
    }
    return result;
  }

 private:
  static constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";

  struct Column {
    std::size_t column, value;
    double unit;  ///< of the header, in SI
  };

  double unit_of(std::size_t column, const std::string& own) const {
    const std::string& unit = table_.units[column];
    return unit.empty() ? 1.0 : parse_value("1 " + unit, own == "m" ? Quantity::length : Quantity::angle);
  }

  /// The line with cells that are not empty in the place of its own, the blanks around these kept.
  static std::string with_cells(const std::string& line, const std::vector<std::string>& cells) {
    std::string result;
    bool quoted = false;
    std::size_t begin = 0, cell = 0;
    for (std::size_t i = 0; i <= line.size(); ++i) {
      if (i < line.size() && line[i] == '"') quoted = !quoted;
      if (i < line.size() && (line[i] != ',' || quoted)) continue;
      const std::string_view own = std::string_view(line).substr(begin, i - begin);
      const std::string_view core = trimmed(own);
      if (cell < cells.size() && !cells[cell].empty() && !core.empty()) {
        const auto before = std::size_t(core.data() - own.data());
        result.append(own.substr(0, before)).append(cells[cell]).append(own.substr(before + core.size()));
      } else {
        result.append(own);
      }
      if (i < line.size()) result += ',';
      begin = i + 1;
      ++cell;
    }
    return result;
  }

  std::string bytes_;
  std::size_t width_;
  PoseTable table_;
  std::vector<Column> columns_;
};

}  // namespace

std::unique_ptr<PoseDocument> csv_document(std::string bytes, const std::string& name,
                                           const std::vector<Coordinate>& coordinates) {
  return std::make_unique<CsvDocument>(std::move(bytes), name, coordinates);
}

}  // namespace posewright
