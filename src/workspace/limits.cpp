#include "limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "posewright/model/pair_names.hpp"
#include "posewright/problem/units.hpp"

namespace posewright {
namespace {

// Limits written with fewer digits than the robot's own ("3.1416") are taken as the same.
constexpr double slack = 1e-4;
// The margin if none is asked for: of the range, and at most.
constexpr double default_share = 0.01, most_angle = 2 * std::numbers::pi / 180, most_length = 5e-3;

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
                     "allowed: " + range_text(c) + (c.limited_by.empty() ? "" : " by " + c.limited_by));
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

void shrink(Coordinate& c, double margin, const SourcePlace& place) {
  const Coordinate before = c;
  c.lower += margin;
  c.upper -= margin;
  if (!(c.lower < c.upper))
    throw InputError(place, "workspace: no range is left for '" + before.name + "' inside the margin",
                     "its limits are " + range_text(before));
}

/// A pose at the very limit is one that a controller may refuse, for its own rounding or its own, narrower limits.
void keep_off_own_limits(Coordinate& c, const Coordinate& own) {
  const double margin = std::min(default_share * (own.upper - own.lower), c.unit == "rad" ? most_angle : most_length);
  const double lower = std::max(c.lower, own.lower + margin), upper = std::min(c.upper, own.upper - margin);
  // Limits of the problem that lie in the margin altogether are what its writer wants.
  if (!(lower < upper)) return;
  c.lower = lower;
  c.upper = upper;
}

void narrow(std::vector<Coordinate>& coordinates, const CoordinateLimits& limits, const SourcePlace& place) {
  bool found = false;
  for (Coordinate& c : coordinates) {
    // A pair of configurations has every coordinate twice; one line narrows both.
    if (c.choice() || (c.name != limits.name.value && c.name != limits.name.value + second_suffix)) continue;
    found = true;
    narrow(c, limits, place);
  }
  if (!found) throw_unknown_coordinate(place, limits.name.value, coordinates);
}

/// A controller's ranges in the robot's own terms: value = sign · (q, less f · q of the second axis) + zero.
class ControllerRanges {
 public:
  ControllerRanges(const ControllerSettings& settings, const std::vector<Coordinate>& coordinates)
      : settings_(settings) {
    for (const Coordinate& c : coordinates)
      if (!c.choice() && !is_second(c.name)) axes_.push_back(&c);
    for (const auto& [size, key] :
         {std::pair(settings.range_deg.size(), "range_deg"), std::pair(settings.sign.size(), "sign"),
          std::pair(settings.zero_deg.size(), "zero_deg"), std::pair(settings.axes.size(), "axes")})
      if (size > 0 && size != axes_.size())
        throw InputError({settings.file, settings.lines.at(key)}, fmt::format("{} has {} entries", key, size),
                         fmt::format("one for each of {} joints", axes_.size()));
  }

  std::size_t count() const { return axes_.size(); }
  const Coordinate& axis(std::size_t i) const { return *axes_[i]; }
  bool is_coupled(std::size_t i) const {
    return settings_.coupling.value_or(0) != 0 && i == settings_.coupled_axes().second && axes_.size() > 2;
  }
  const Coordinate& second() const { return *axes_[settings_.coupled_axes().first]; }
  double coupling() const { return settings_.coupling.value_or(0); }

  /// rad or m, before sign and zero.
  std::pair<double, double> range(std::size_t i) const {
    const double scale = axes_[i]->unit == "rad" ? std::numbers::pi / 180 : 1e-3;
    const double sign = settings_.sign.empty() ? 1.0 : settings_.sign[i];
    const double zero = settings_.zero_deg.empty() ? 0.0 : settings_.zero_deg[i];
    return std::minmax(
        {scale * (settings_.range_deg[i][0] - zero) / sign, scale * (settings_.range_deg[i][1] - zero) / sign});
  }

  SourcePlace place() const { return {settings_.file, settings_.lines.at("range_deg")}; }

 private:
  const ControllerSettings& settings_;
  std::vector<const Coordinate*> axes_;
};

void keep_controller_ranges(std::vector<Coordinate>& coordinates, const ControllerSettings& settings) {
  const std::vector<Coordinate> own = coordinates;
  const ControllerRanges ranges(settings, own);
  for (std::size_t i = 0; i < ranges.count(); ++i) {
    if (ranges.is_coupled(i)) continue;
    const auto [lower, upper] = ranges.range(i);
    for (Coordinate& c : coordinates) {
      if (first_name(c.name) != ranges.axis(i).name || (lower <= c.lower && upper >= c.upper)) continue;
      c.lower = std::max(c.lower, lower);
      c.upper = std::min(c.upper, upper);
      c.periodic = false;
      if (!(c.lower < c.upper))
        throw InputError(ranges.place(), "no range is left for '" + c.name + "'",
                         "its own limits are " + range_text(ranges.axis(i)));
    }
  }
}

}  // namespace

std::vector<CoupledLimits> coupled_limits(const IdentificationModel& model, const WorkspaceSpec& spec) {
  std::vector<CoupledLimits> all = spec.coupled;
  if (!spec.controller) return all;
  const ControllerRanges ranges(*spec.controller, model.coordinates());
  for (std::size_t i = 0; i < ranges.count(); ++i) {
    if (!ranges.is_coupled(i)) continue;
    const auto [lower, upper] = ranges.range(i);
    all.push_back({{{{ranges.axis(i).name, 0}, 1.0}, {{ranges.second().name, 0}, -ranges.coupling()}},
                   lower,
                   upper,
                   Quantity::angle,
                   0});
  }
  return all;
}

std::vector<Coordinate> limits_in_force(const IdentificationModel& model, const Problem& problem, const Cell* cell) {
  std::vector<Coordinate> coordinates = model.coordinates();
  for (const CoordinateLimits& limits : problem.workspace.limits)
    narrow(coordinates, limits, problem.at(limits.name.line));
  if (problem.workspace.controller) keep_controller_ranges(coordinates, *problem.workspace.controller);
  for (Coordinate& c : coordinates) {
    if (c.periodic || c.choice()) continue;
    if (cell != nullptr)
      if (const auto room = cell->joint_margin.find(c.name); room != cell->joint_margin.end())
        shrink(c, room->second, problem.at(0));
    keep_listed(c, problem.at(0));
  }
  return coordinates;
}

std::vector<Coordinate> proposed_limits(const IdentificationModel& model, const Problem& problem,
                                        std::vector<Coordinate> in_force) {
  const WorkspaceSpec& spec = problem.workspace;
  const bool is_arm = std::holds_alternative<SerialArmSpec>(problem.robot);
  for (std::size_t i = 0; i < in_force.size(); ++i) {
    Coordinate& c = in_force[i];
    if (c.periodic || c.choice()) continue;
    if (const auto margin = c.unit == "rad" ? spec.joint_margin : spec.joint_margin_length) {
      shrink(c, *margin, problem.at(0));
      keep_listed(c, problem.at(0));
    } else if (is_arm && !c.discrete()) {
      keep_off_own_limits(c, model.coordinates()[i]);
    }
  }
  return in_force;
}

}  // namespace posewright
