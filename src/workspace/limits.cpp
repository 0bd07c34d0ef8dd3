#include "limits.hpp"

#include <fmt/format.h>

#include <algorithm>

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

std::string names(const std::vector<Coordinate>& coordinates) {
  std::string text;
  for (const Coordinate& c : coordinates) text += (text.empty() ? "" : ", ") + c.name;
  return text;
}

void narrow(std::vector<Coordinate>& coordinates, const CoordinateLimits& limits, const Problem& problem) {
  const SourcePlace place = problem.at(limits.name.line);
  const auto found = std::find_if(coordinates.begin(), coordinates.end(),
                                  [&](const Coordinate& c) { return c.name == limits.name.value; });
  if (found == coordinates.end())
    throw InputError(place, "'" + limits.name.value + "' is no coordinate of this robot",
                     "allowed: " + names(coordinates));
  if (limits.quantity != Quantity::number &&
      limits.quantity != (found->unit == "rad" ? Quantity::angle : Quantity::length))
    throw InputError(place, "limits of '" + limits.name.value + "' have the wrong unit",
                     "allowed: " + allowed_units({found->unit == "rad" ? Quantity::angle : Quantity::length}));
  if (limits.lower < found->lower - slack || limits.upper > found->upper + slack)
    throw InputError(place, "limits of '" + limits.name.value + "' go beyond the robot's own",
                     "allowed: " + range_text(*found));
  found->periodic = false;
  found->lower = std::max(found->lower, limits.lower);
  found->upper = std::min(found->upper, limits.upper);
}

}  // namespace

std::vector<Coordinate> limits_in_force(const IdentificationModel& model, const Problem& problem) {
  std::vector<Coordinate> coordinates = model.coordinates();
  for (const CoordinateLimits& limits : problem.workspace.limits) narrow(coordinates, limits, problem);
  for (Coordinate& c : coordinates) {
    const double margin = c.unit == "rad" ? problem.workspace.joint_margin : problem.workspace.joint_margin_length;
    const Coordinate before = c;
    if (c.periodic) continue;
    c.lower += margin;
    c.upper -= margin;
    if (!(c.lower < c.upper))
      throw InputError(problem.at(0), "workspace: nothing is left of the range of '" + c.name + "' inside the margin",
                       "its limits are " + range_text(before));
  }
  return coordinates;
}

}  // namespace posewright
