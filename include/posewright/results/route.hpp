#pragma once

#include <optional>
#include <string>
#include <vector>

#include "posewright/results/plan.hpp"

namespace posewright {

/// From one stop to the next, straight from via point to via point.
struct RouteMotion {
  int from = 0, to = 0;                     ///< pose ids; 0: home
  std::vector<std::vector<double>> points;  ///< both ends included, SI, in the order of Route::names
  double seconds = 0.0;                     ///< of travel, standing still at every point
  double change_seconds = 0.0;              ///< of moving the instrument or changing the load
  std::string found_by;                     ///< straight, roadmap, rrt_connect or via home
  std::optional<BodyDistance> nearest{};    ///< on the way, half a millimetre less at most
};

/// Reference targets measured while the robot stands at a pose.
struct ReferenceCheck {
  int pose = 0;
  std::vector<TargetSight> sights;
};

struct SkippedPose {
  int pose = 0;
  std::string reason;
  int by = 0;  ///< the pose that is measured in its place; 0: none
};

/// Efficiency of the poses of a route against all poses of its plan.
struct RouteWorth {
  double efficiency = 0.0;  ///< of the information, on the geometric mean of the parameters
  std::optional<ExpectedError> planned{}, left{};
};

/// The order of measurement and the motions between the poses.
struct Route {
  std::string plan_file;
  ProblemOrigin problem{};
  bool problem_changed = false;  ///< the problem file is not the one the plan was made for
  std::uint64_t seed = 0;
  bool closed = false, from_home = false;
  double settle = 0.0;                    ///< s, at each pose before it is read
  std::vector<std::string> names, units;  ///< of what moves
  std::vector<double> home;
  std::vector<PlannedPose> poses;    ///< in measuring order, with the ids of the plan
  std::vector<double> reading;       ///< s, of all readings at each of them, reference targets included; empty: 0
  std::vector<RouteMotion> motions;  ///< in order: from home (if asked), between the poses, back (if closed)
  std::vector<ReferenceCheck> references;
  std::vector<SkippedPose> unreachable;
  std::vector<SkippedPose> replaced;  ///< poses of the plan in whose place another one is on the route
  std::optional<RouteWorth> worth;    ///< where poses are left out or replaced; none: the others do not determine all
  double planned_seconds = 0.0;  ///< of the same poses in the plan's own order at least: straight motions, free or not
  bool optimal = false;          ///< no order of these motions is shorter
  bool interrupted = false;      ///< the search was ended: its best order so far
  double computing_seconds = 0.0;
  std::vector<std::string> notes{};  ///< on how the poses were read; not written

  double travel_seconds() const;
  double change_seconds() const;
  double settle_seconds() const { return settle * double(poses.size()); }
  double reading_seconds() const;
};

/// Schema posewright/route/1 (docs/cell.md).
std::string route_json(const Route& route, const std::vector<WrittenWith>& files = {});
/// "4 of 12 poses are left out: …" with what is left; empty if none is.
std::string route_loss(const Route& route);
/// The table a person reads.
std::string route_summary(const Route& route);
/// The poses in measuring order, as poses.csv of a plan.
std::string route_csv(const Route& route);

}  // namespace posewright
