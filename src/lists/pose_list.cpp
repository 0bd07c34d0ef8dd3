#include "posewright/lists/pose_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "posewright/lists/read_poses.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

/// Values of q that are no choice follow `coordinates` where choices are left out.
std::vector<double> completed(const std::vector<double>& q, const std::vector<Coordinate>& coordinates,
                              const SourcePlace& place) {
  if (q.size() == coordinates.size()) return q;
  const auto open = std::count_if(coordinates.begin(), coordinates.end(),
                                  [](const Coordinate& c) { return !c.choice() || c.labels.size() > 1; });
  if (q.size() != std::size_t(open)) {
    std::string names;
    for (const Coordinate& c : coordinates) names += (names.empty() ? "" : ", ") + c.name;
    throw InputError(place, fmt::format("has {} values", q.size()),
                     fmt::format("one for each of {} is expected", names));
  }
  std::vector<double> whole;
  whole.reserve(coordinates.size());
  auto next = q.begin();
  for (const Coordinate& c : coordinates)
    whole.push_back(c.choice() && c.labels.size() == 1 ? c.values.front() : *next++);
  return whole;
}

void judge_value(double& value, const Coordinate& c, const SourcePlace& place) {
  if (!std::isfinite(value)) throw InputError(place, fmt::format("'{}' is not finite", c.name), "a number is expected");
  if (c.choice()) {
    if (!c.measurable && std::find(c.values.begin(), c.values.end(), value) == c.values.end())
      throw InputError(
          place, fmt::format("'{}' is {:.6g}", c.name, value),
          fmt::format("a number from 0 to {} stands for one of {}", c.labels.size() - 1, fmt::join(c.labels, ", ")));
    return;
  }
  require_inside(value, c, place);
  value = as_allowed(value, c);
}

}  // namespace

void require_fits(const PoseList& list, const std::vector<Coordinate>& coordinates) {
  for (const auto& q : list.configurations)
    if (q.size() != coordinates.size())
      throw InputError({list.name, 0}, fmt::format("has poses of {} values", q.size()),
                       fmt::format("{} coordinates of this problem", coordinates.size()));
}

void require_at_most(const PoseList& list, std::size_t most, const std::string& task) {
  if (list.configurations.size() > most)
    throw InputError({list.name, 0}, "has " + std::to_string(list.configurations.size()) + " poses",
                     task + " at most " + std::to_string(most));
}

PoseList poses_given(const std::vector<std::vector<double>>& configurations,
                     const std::vector<Coordinate>& coordinates) {
  PoseList list;
  list.name = "configurations";
  if (configurations.empty()) throw InputError({list.name, 0}, "has no poses", "at least one is needed");
  for (std::size_t i = 0; i < configurations.size(); ++i) {
    const SourcePlace place{fmt::format("{}: pose {}", list.name, i + 1), 0};
    std::vector<double> q = completed(configurations[i], coordinates, place);
    for (std::size_t k = 0; k < q.size(); ++k) judge_value(q[k], coordinates[k], place);
    list.configurations.push_back(std::move(q));
  }
  return list;
}

}  // namespace posewright
