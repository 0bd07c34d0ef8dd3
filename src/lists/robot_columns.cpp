#include "robot_columns.hpp"

#include <algorithm>

#include "cell_in_si.hpp"
#include "orientation_columns.hpp"
#include "posewright/model/placement.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

constexpr std::array<const char*, 3> angle_names = {"robot.roll", "robot.pitch", "robot.yaw"};

double value_of(const PoseTable& table, const PoseRow& row, const std::string& name, const std::string& unit,
                const SourcePlace& place) {
  const auto at = std::size_t(std::find(table.names.begin(), table.names.end(), name) - table.names.begin());
  const auto* text = std::get_if<std::string>(&row.cells[at]);
  if (text == nullptr) return std::get<double>(row.cells[at]);
  return cell_in_si(*text, table.units.empty() ? "" : table.units[at], name,
                    unit == "rad" ? Quantity::angle : Quantity::number, place);
}

}  // namespace

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

}  // namespace posewright
