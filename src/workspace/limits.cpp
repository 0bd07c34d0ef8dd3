#include "limits.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "posewright/model/pair_names.hpp"
#include "posewright/problem/units.hpp"

namespace posewright {
namespace {

// Limits written with fewer digits than the robot's own ("3.1416") are taken as the same.
constexpr double slack = 1e-4;

std::string range_text(const Coordinate& c) {
  const bool angle = c.unit == "rad";
  const double scale = angle ? 57.295779513082323 : 1e3;
  return fmt::format("{:.6g} to {:.6g} {}", c.lower * scale, c.upper * scale, angle ? "deg" : "mm");
}

void narrow(Coordinate& c, const CoordinateLimits& limits, const SourcePlace& place) {
  if (!fits_unit(limits.quantity, c.unit))
    throw InputError(place, "limits of '" + limits.name.value + "' have the wrong unit",
                     "allowed: " + allowed_units({c.unit == "rad" ? Quantity::angle : Quantity::length}));
  if (limits.lower < c.lower - slack || limits.upper > c.upper + slack)
    throw InputError(place, "limits of '" + limits.name.value + "' go beyond the robot's own",
                     "allowed: " + range_text(c));
  c.periodic = false;
  c.lower = std::max(c.lower, limits.lower);
  c.upper = std::min(c.upper, limits.upper);
}

/// Listed positions that are left inside the limits.
void keep_listed(Coordinate& c, const SourcePlace& place) {
  if (!c.discrete() || c.choice()) return;
  std::erase_if(c.values, [&](double value) { return value < c.lower || value > c.upper; });
  if (c.values.empty())
    throw InputError(place, "workspace: limits and margin of '" + c.name + "' leave none of its listed positions",
                     "positions are listed in robot: elastostatic");
}

void narrow(std::vector<Coordinate>& coordinates, const CoordinateLimits& limits, const Problem& problem) {
  bool found = false;
  for (Coordinate& c : coordinates) {
    // A pair of configurations has every coordinate twice; one line narrows both.
    if (c.choice() || (c.name != limits.name.value && c.name != limits.name.value + second_suffix)) continue;
    found = true;
    narrow(c, limits, problem.at(limits.name.line));
  }
  if (!found) throw_unknown_coordinate(problem.at(limits.name.line), limits.name.value, coordinates);
}

}  // namespace

std::vector<Coordinate> limits_in_force(const IdentificationModel& model, const Problem& problem, const Cell* cell) {
  std::vector<Coordinate> coordinates = model.coordinates();
  for (const CoordinateLimits& limits : problem.workspace.limits) narrow(coordinates, limits, problem);
  for (Coordinate& c : coordinates) {
    double margin = c.unit == "rad" ? problem.workspace.joint_margin : problem.workspace.joint_margin_length;
    if (cell != nullptr)
      if (const auto more = cell->joint_margin.find(c.name); more != cell->joint_margin.end()) margin += more->second;
    const Coordinate before = c;
    if (c.periodic || c.choice()) continue;
    c.lower += margin;
    c.upper -= margin;
    if (!(c.lower < c.upper))
      throw InputError(problem.at(0), "workspace: nothing is left of the range of '" + c.name + "' inside the margin",
                       "its limits are " + range_text(before));
    keep_listed(c, problem.at(0));
  }
  return coordinates;
}

}  // namespace posewright
