#include "read_poses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "posewright/problem/units.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/file.hpp"

namespace posewright {
namespace {

constexpr std::uintmax_t size_limit = 100'000'000;

std::string trimmed(std::string text) {
  const auto blank = [](unsigned char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && blank(static_cast<unsigned char>(text.back()))) text.pop_back();
  while (!text.empty() && blank(static_cast<unsigned char>(text.front()))) text.erase(text.begin());
  return text;
}

/// "joint_1 [deg]" → name and unit.
std::pair<std::string, std::string> name_and_unit(const std::string& header) {
  const auto open = header.rfind('[');
  if (open == std::string::npos || header.back() != ']') return {header, ""};
  return {trimmed(header.substr(0, open)), header.substr(open + 1, header.size() - open - 2)};
}

double in_si(const std::string& cell, const std::string& unit, const Coordinate& c, const SourcePlace& place) {
  const Quantity own = c.unit == "m" ? Quantity::length : Quantity::angle;
  try {
    return parse_value(unit.empty() ? cell : cell + " " + unit, own);
  } catch (const InputError&) {
    throw InputError(place, fmt::format("'{}' of '{}' is no value", cell.substr(0, 40), c.name),
                     "a number; in the header, a unit: " + allowed_units({own}));
  }
}

double of_label(const std::string& label, const Coordinate& c, const SourcePlace& place) {
  const auto at = std::find(c.labels.begin(), c.labels.end(), label);
  if (at == c.labels.end())
    throw InputError(place, fmt::format("'{}' is no {}", label.substr(0, 40), c.name),
                     fmt::format("allowed: {}", fmt::join(c.labels, ", ")));
  return c.values[std::size_t(at - c.labels.begin())];
}

class CsvReader {
 public:
  CsvReader(const std::string& file, const std::vector<Coordinate>& coordinates)
      : file_(file), coordinates_(coordinates), column_(coordinates.size(), -1), unit_(coordinates.size()) {
    list_.name = file;
  }

  PoseList read(const std::string& text) {
    std::istringstream lines(text);
    std::string line;
    for (int number = 1; std::getline(lines, line); ++number) {
      line = trimmed(line);
      if (line.empty() || line.front() == '#') continue;
      if (cells_ == 0) read_header(line, number);
      else read_row(line, number);
    }
    if (list_.configurations.empty()) throw InputError({file_, 0}, "has no poses", "a header and one line a pose");
    return std::move(list_);
  }

 private:
  void read_header(const std::string& line, int number) {
    const std::vector<std::string> cells = csv_cells(line);
    cells_ = cells.size();
    for (std::size_t k = 0; k < coordinates_.size(); ++k) {
      for (std::size_t i = 0; i < cells.size(); ++i) {
        const auto [name, unit] = name_and_unit(cells[i]);
        if (name != coordinates_[k].name) continue;
        column_[k] = int(i);
        unit_[k] = unit;
      }
      // A choice among one thing needs no column.
      if (column_[k] < 0 && !(coordinates_[k].choice() && coordinates_[k].labels.size() == 1))
        throw InputError({file_, number}, "has no column '" + coordinates_[k].name + "'",
                         "a header with the names of all coordinates");
    }
    for (std::size_t i = 0; i < cells.size(); ++i)
      if (cells[i] == "weight") weight_ = int(i);
  }

  void read_row(const std::string& line, int number) {
    const SourcePlace place{file_, number};
    const std::vector<std::string> cells = csv_cells(line);
    if (cells.size() != cells_)
      throw InputError(place, fmt::format("has {} cells", cells.size()), fmt::format("the header has {}", cells_));
    std::vector<double> q;
    for (std::size_t k = 0; k < coordinates_.size(); ++k) {
      const Coordinate& c = coordinates_[k];
      if (column_[k] < 0) q.push_back(c.values.front());
      else if (c.choice()) q.push_back(of_label(cells[std::size_t(column_[k])], c, place));
      else q.push_back(in_si(cells[std::size_t(column_[k])], unit_[k], c, place));
      require_inside(q.back(), c, place);
      if (!c.choice() && !c.periodic) q.back() = std::clamp(q.back(), c.lower, c.upper);
    }
    list_.configurations.push_back(std::move(q));
    if (weight_ < 0) return;
    double weight = 0;
    const std::string& cell = cells[std::size_t(weight_)];
    const auto [end, code] = std::from_chars(cell.data(), cell.data() + cell.size(), weight);
    if (code != std::errc() || end != cell.data() + cell.size() || !(weight > 0) || !std::isfinite(weight))
      throw InputError(place, "weight '" + cell.substr(0, 40) + "'", "a positive number is expected");
    list_.weights.push_back(weight);
  }

  std::string file_;
  const std::vector<Coordinate>& coordinates_;
  std::vector<int> column_;
  std::vector<std::string> unit_;
  std::size_t cells_ = 0;
  int weight_ = -1;
  PoseList list_;
};

PoseList from_plan(const std::string& text, const std::string& file, const std::vector<Coordinate>& coordinates) {
  using Json = nlohmann::json;
  const SourcePlace place{file, 0};
  PoseList list;
  list.name = file;
  try {
    const Json plan = Json::parse(text);
    for (const Json& pose : plan.at("poses")) {
      std::vector<double> q;
      const Json& names = pose.at("names");
      for (const Coordinate& c : coordinates) {
        if (c.choice()) {
          q.push_back(c.labels.size() == 1 ? c.values.front() : of_label(pose.at(c.name).get<std::string>(), c, place));
          continue;
        }
        const auto at = std::find(names.begin(), names.end(), c.name);
        if (at == names.end())
          throw InputError(place, "a pose has no coordinate '" + c.name + "'", "a plan of the same robot is expected");
        q.push_back(pose.at("configuration").at(std::size_t(at - names.begin())).get<double>());
        require_inside(q.back(), c, place);
      }
      list.configurations.push_back(std::move(q));
      list.measured.push_back(pose.value("measured", false));
    }
  } catch (const Json::exception&) {
    throw InputError(place, "is no plan with configurations", "plan.json as posewright writes it, or CSV");
  }
  if (list.configurations.empty()) throw InputError(place, "has no poses", "at least one is needed");
  return list;
}

}  // namespace

void require_inside(double value, const Coordinate& c, const SourcePlace& place) {
  // What a controller shows has few digits: a hair beyond a limit is the limit.
  const double slack = 1e-6 * (1 + std::abs(c.upper - c.lower));
  if (c.choice() || c.periodic || (value >= c.lower - slack && value <= c.upper + slack)) return;
  throw InputError(place, fmt::format("'{}' is {:.6g} {}", c.name, value, c.unit),
                   fmt::format("allowed: {:.6g} to {:.6g} {}", c.lower, c.upper, c.unit));
}

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
  for (std::string& cell : cells) cell = trimmed(cell);
  return cells;
}

PoseList read_poses(const std::filesystem::path& file, const std::vector<Coordinate>& coordinates) {
  return read_poses_text(read_file(file, size_limit), file.string(), coordinates);
}

PoseList read_poses_text(std::string text, const std::string& name, const std::vector<Coordinate>& coordinates) {
  // Spreadsheets write a byte order mark.
  if (text.starts_with("\xef\xbb\xbf")) text.erase(0, 3);
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first != std::string::npos && text[first] == '{') return from_plan(text, name, coordinates);
  return CsvReader(name, coordinates).read(text);
}

}  // namespace posewright
