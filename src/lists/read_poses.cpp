#include "posewright/lists/read_poses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>

#include "orientation_columns.hpp"
#include "posewright/formats/pose_formats.hpp"
#include "posewright/lists/samples.hpp"
#include "posewright/model/placement.hpp"
#include "posewright/problem/units.hpp"
#include "posewright/support/file.hpp"
#include "posewright/support/read_number.hpp"

namespace posewright {
namespace {

/// Value of a cell in SI. Throws InputError.
/// @param unit    of its column as written; empty: SI, or in the cell
/// @param column  that names it in a message
double cell_in_si(const std::string& cell, const std::string& unit, const std::string& column, Quantity quantity,
                  const SourcePlace& place) {
  try {
    return parse_value(unit.empty() ? cell : cell + " " + unit, quantity);
  } catch (const InputError&) {
    throw InputError(place, fmt::format("'{}' of '{}' is not a value", cell.substr(0, 40), column),
                     "a number; in the header, a unit: " + allowed_units({quantity}));
  }
}

constexpr std::array<const char*, 3> angle_names = {"robot.roll", "robot.pitch", "robot.yaw"};

double value_of(const PoseTable& table, const PoseRow& row, const std::string& name, const std::string& unit,
                const SourcePlace& place) {
  const auto at = std::size_t(std::find(table.names.begin(), table.names.end(), name) - table.names.begin());
  const auto* text = std::get_if<std::string>(&row.cells[at]);
  if (text == nullptr) return std::get<double>(row.cells[at]);
  return cell_in_si(*text, table.units.empty() ? "" : table.units[at], name,
                    unit == "rad" ? Quantity::angle : Quantity::number, place);
}

/// Adds columns robot.roll, robot.pitch, robot.yaw (GivenPoses) where a table has the orientations of a robot's poses
/// in another form (OrientationColumns). Other tables, and those of robots with joints, stay. Throws InputError with
/// file and line.
void add_pose_coordinates(PoseTable& table, const std::string& file, const std::vector<Coordinate>& coordinates) {
  const auto has = [&](const std::string& name) { return std::ranges::find(table.names, name) != table.names.end(); };
  if (std::ranges::none_of(coordinates, [](const Coordinate& c) { return c.name == angle_names[0]; })) return;
  const OrientationColumns orientation("robot", table.names, {file, table.header});
  if (!orientation.found()) return;
  if (has(angle_names[0]))
    throw InputError({file, table.header}, "has the robot's orientation twice", "robot.roll …, or another form of it");
  for (PoseRow& row : table.rows) {
    const SourcePlace place{file, row.line};
    const auto value = [&](const std::string& name, const std::string& unit) {
      return value_of(table, row, name, unit, place);
    };
    const auto R = orientation.rotation(value, place);
    if (!R) throw InputError(place, "the orientation of the robot is not whole", "a number in each column");
    for (const double angle : rpy_of(*R)) row.cells.emplace_back(angle);
  }
  for (const char* name : angle_names) {
    table.names.emplace_back(name);
    if (!table.units.empty()) table.units.emplace_back();
  }
}

constexpr std::uintmax_t list_size_limit = 100'000'000;

double temperature_of(const std::string& cell, const Coordinate& c, const SourcePlace& place) {
  constexpr double coldest = -100, hottest = 300;  // degrees Celsius, of a robot that somebody measures
  const std::optional<double> value = read_double(cell);
  if (!value || !(*value >= coldest && *value <= hottest))
    throw InputError(place, fmt::format("'{}' is no {}", cell.substr(0, 40), c.name),
                     fmt::format("degrees Celsius, {} to {}", coldest, hottest));
  return *value;
}

double of_label(const std::string& label, const Coordinate& c, const SourcePlace& place) {
  const auto at = std::find(c.labels.begin(), c.labels.end(), label);
  if (at == c.labels.end() && c.measurable) return temperature_of(label, c, place);
  if (at == c.labels.end())
    throw InputError(place, fmt::format("'{}' is no {}", label.substr(0, 40), c.name),
                     fmt::format("allowed: {}", fmt::join(c.labels, ", ")));
  return c.values[std::size_t(at - c.labels.begin())];
}

/// Puts the cells of a list to the coordinates of a problem: the one place where names and units meet them.
class ColumnMap {
 public:
  ColumnMap(const std::string& file, const std::vector<Coordinate>& coordinates, const PoseTable& table)
      : file_(file), coordinates_(coordinates), table_(table), column_(coordinates.size(), -1) {
    list_.name = file;
    list_.problem_sha256 = table.problem_sha256;
    list_.parameters_file = table.parameters_file;
    if (table.names.empty()) map_by_order();
    else map_by_name();
  }

  PoseList map() {
    for (const PoseRow& row : table_.rows) add(row);
    for (std::size_t k = 0; k < coordinates_.size(); ++k)
      if (column_[k] < 0 && !coordinates_[k].arrives.empty()) arrive_in_order(k);
    return std::move(list_);
  }

 private:
  /// A choice among one thing needs no column.
  static bool needs_column(const Coordinate& c) { return !c.choice() || (c.labels.size() > 1 && c.arrives.empty()); }

  /// Without a column for the side of arrival, a joint's last motion in the order of the list gives it.
  void arrive_in_order(std::size_t approach) {
    const Coordinate& c = coordinates_[approach];
    const auto joint = std::size_t(
        std::find_if(coordinates_.begin(), coordinates_.end(), [&](const auto& o) { return o.name == c.arrives; }) -
        coordinates_.begin());
    double side = c.values.front(), before = list_.configurations.front()[joint];
    for (std::vector<double>& q : list_.configurations) {
      if (q[joint] != before) side = q[joint] > before ? c.values.front() : c.values.back();
      before = q[joint];
      q[approach] = side;
    }
    list_.notes.push_back(fmt::format(
        "{} has no column '{}': the order of its poses gives the side from which {} arrived, {} at the first", file_,
        c.name, c.arrives, c.labels.front()));
  }

  void map_by_name() {
    for (std::size_t k = 0; k < coordinates_.size(); ++k) {
      for (std::size_t i = 0; i < table_.names.size(); ++i)
        if (table_.names[i] == coordinates_[k].name) {
          if (column_[k] >= 0)
            throw InputError({file_, table_.header}, "has column '" + coordinates_[k].name + "' twice",
                             "each name once");
          column_[k] = int(i);
        }
      if (column_[k] < 0 && needs_column(coordinates_[k]))
        throw InputError({file_, table_.header}, "has no column '" + coordinates_[k].name + "'",
                         "the names of all coordinates are expected");
    }
    for (std::size_t i = 0; i < table_.names.size(); ++i) {
      if (table_.names[i] == "weight") weight_ = int(i);
      if (table_.names[i] == "fixed") mark_ = int(i);
      if (table_.names[i] == "id" || table_.names[i] == "pose") id_ = int(i);
    }
    list_.columns = table_.names;
  }

  void map_by_order() {
    const std::size_t columns = table_.rows.front().cells.size();
    std::size_t next = 0;
    std::string names;
    for (std::size_t k = 0; k < coordinates_.size(); ++k) {
      const Coordinate& c = coordinates_[k];
      if (c.choice() && needs_column(c))
        throw InputError({file_, 0}, "has no place for the " + c.name + " of a pose", "a format with named columns");
      if (c.choice()) continue;
      column_[k] = int(next++);
      names += (names.empty() ? "" : ", ") + c.name;
    }
    if (next != columns)
      throw InputError({file_, table_.rows.front().line}, fmt::format("has {} numbers a pose", columns),
                       fmt::format("{} in this order: {}", next, names));
    list_.notes.push_back(file_ + " names no joints: its columns are taken as " + names);
  }

  void add(const PoseRow& row) {
    const SourcePlace place{file_, row.line};
    if (table_.names.empty() && row.cells.size() != table_.rows.front().cells.size())
      throw InputError(place, fmt::format("has {} numbers", row.cells.size()),
                       fmt::format("the first pose has {}", table_.rows.front().cells.size()));
    std::vector<double> q;
    for (std::size_t k = 0; k < coordinates_.size(); ++k) {
      const Coordinate& c = coordinates_[k];
      if (column_[k] < 0) q.push_back(c.values.front());
      else q.push_back(value_of(row.cells[std::size_t(column_[k])], unit_of(column_[k]), c, place));
      // What was measured was there.
      if (row.measured && !c.discrete()) continue;
      require_inside(q.back(), c, place);
      q.back() = as_allowed(q.back(), c);
    }
    list_.configurations.push_back(std::move(q));
    list_.measured.push_back(row.measured);
    list_.ids.push_back(row.id > 0 ? row.id : int(list_.configurations.size()));
    list_.lines.push_back(row.line);
    if (id_ >= 0 || row.id > 0) list_.own_ids.push_back(row.id > 0 ? row.id : id_of(row.cells[std::size_t(id_)]));
    if (mark_ >= 0) list_.marks.push_back(text_of(row.cells[std::size_t(mark_)]));
    if (weight_ >= 0) list_.weights.push_back(weight_of(row.cells[std::size_t(weight_)], place));
  }

  std::string unit_of(int column) const {
    return table_.units.empty() ? std::string() : table_.units[std::size_t(column)];
  }

  static double value_of(const PoseCell& cell, const std::string& unit, const Coordinate& c, const SourcePlace& place) {
    if (const auto* text = std::get_if<std::string>(&cell))
      return c.choice() ? of_label(*text, c, place)
                        : cell_in_si(*text, unit, c.name, c.unit == "m" ? Quantity::length : Quantity::angle, place);
    const double value = std::get<double>(cell);
    if (c.choice()) return of_label(fmt::format("{}", value), c, place);
    if (unit != degrees_or_millimetres) return value;
    return c.unit == "m" ? value * 1e-3 : value * (std::numbers::pi / 180);
  }

  static std::string text_of(const PoseCell& cell) {
    const auto* text = std::get_if<std::string>(&cell);
    return text == nullptr ? fmt::format("{}", std::get<double>(cell)) : *text;
  }

  static int id_of(const PoseCell& cell) {
    const auto* text = std::get_if<std::string>(&cell);
    int id = 0;
    if (text == nullptr) return 0;
    const auto [end, code] = std::from_chars(text->data(), text->data() + text->size(), id);
    return code == std::errc() && end == text->data() + text->size() && id > 0 ? id : 0;
  }

  static double weight_of(const PoseCell& cell, const SourcePlace& place) {
    const auto* text = std::get_if<std::string>(&cell);
    const double weight = text == nullptr ? std::get<double>(cell) : read_double(*text).value_or(0);
    if (!(weight > 0) || !std::isfinite(weight))
      throw InputError(place, "weight '" + (text == nullptr ? fmt::format("{}", weight) : text->substr(0, 40)) + "'",
                       "a positive number is expected");
    return weight;
  }

  std::string file_;
  const std::vector<Coordinate>& coordinates_;
  const PoseTable& table_;
  std::vector<int> column_;
  int weight_ = -1, id_ = -1, mark_ = -1;
  PoseList list_;
};

/// plan.json, route.json and the like by their first character, samples by their keys, else CSV.
PoseTable recognised(const std::string& text, const std::string& file) {
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first != std::string::npos && text[first] == '{') return table_of(parse_sequence(text, file));
  return samples_or_csv(text, file);
}

// rad or m, relative above one: what six digits of a list leave open.
constexpr double rounding_of_lists = 1e-6;
}  // namespace

bool inside(double value, const Coordinate& c) {
  // What a controller shows has few digits: a hair beyond a limit is the limit.
  const double slack = rounding_of_lists * (1 + std::abs(c.upper - c.lower));
  return c.choice() || c.periodic || (value >= c.lower - slack && value <= c.upper + slack);
}

std::vector<Coordinate> without_limits(std::vector<Coordinate> coordinates) {
  for (Coordinate& c : coordinates)
    if (!c.choice()) {
      c.lower = -std::numeric_limits<double>::max() / 4;
      c.upper = -c.lower;
    }
  return coordinates;
}

double as_allowed(double value, const Coordinate& c) {
  if (c.choice()) return value;
  if (!c.discrete()) return c.periodic ? value : std::clamp(value, c.lower, c.upper);
  const double nearest = *std::min_element(
      c.values.begin(), c.values.end(), [&](double a, double b) { return std::abs(a - value) < std::abs(b - value); });
  return std::abs(nearest - value) <= rounding_of_lists * (1 + std::abs(nearest)) ? nearest : value;
}

std::string margin_note(const std::string& file, const std::vector<int>& ids) {
  constexpr std::size_t most = 8;
  const std::size_t count = std::min(most, ids.size());
  return fmt::format("{}: {} {} nearer to a limit than the margin of proposed poses: {}{}", file, ids.size(),
                     ids.size() == 1 ? "pose is" : "poses are", fmt::join(ids.begin(), ids.begin() + long(count), ", "),
                     ids.size() > most ? ", …" : "");
}

void require_inside(double value, const Coordinate& c, const SourcePlace& place) {
  if (inside(value, c)) return;
  throw InputError(place, fmt::format("'{}' is {:.6g} {}", c.name, value, c.unit),
                   fmt::format("allowed: {:.6g} to {:.6g} {}", c.lower, c.upper, c.unit));
}

PoseList read_poses(const std::filesystem::path& file, const std::vector<Coordinate>& coordinates,
                    const std::string& format) {
  return read_poses_text(read_file(file, list_size_limit), file.string(), coordinates, format);
}

PoseList read_poses_text(std::string text, const std::string& name, const std::vector<Coordinate>& coordinates,
                         const std::string& format) {
  // Spreadsheets write a byte order mark.
  if (text.starts_with("\xef\xbb\xbf")) text.erase(0, 3);
  PoseTable table = format.empty() ? recognised(text, name) : find_readable_format(format).read(text, name);
  add_pose_coordinates(table, name, coordinates);
  return ColumnMap(name, coordinates, table).map();
}

}  // namespace posewright
