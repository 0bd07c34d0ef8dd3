#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "posewright/cell/cell.hpp"
#include "posewright/support/monitor.hpp"

namespace posewright {

/// Throws CannotDo where tips are joined: motions between their poses would open the loop.
void require_free_tips(const MeasurementSpec& measurement);

/// Motions of the robot between poses: the continuous coordinates of its configurations, collisions on the way, and
/// how long a motion takes. What is chosen per measurement (load case, station) does not move; listed joint positions
/// may be passed. Members are const and may run in several threads at once.
class MotionSpace {
 public:
  /// @param cell  of the problem; null: only limits and actuators constrain
  /// Throws InputError for velocities of things that do not move, and where a velocity is not known.
  MotionSpace(const Problem& problem, std::shared_ptr<const Cell> cell);
  ~MotionSpace();
  MotionSpace(const MotionSpace&) = delete;
  MotionSpace& operator=(const MotionSpace&) = delete;

  /// Coordinates that move, with the limits in force.
  const std::vector<Coordinate>& coordinates() const;
  /// Limits less the margin: the range of via points.
  const std::vector<Coordinate>& proposed() const;
  /// Moving coordinates of a configuration, and back: choices at their first values.
  std::vector<double> reduced(std::span<const double> configuration) const;
  std::vector<double> whole(std::span<const double> q) const;
  std::vector<double> home() const;
  /// Start of the last straight motion to a configuration: every coordinate with an approach its
  /// overrun away on the side that is stated. The configuration itself if there are none.
  std::vector<double> lead(std::span<const double> configuration) const;

  /// Reason that forbids q ("limits", "collision with table", …); empty if it is free.
  std::string violation(std::span<const double> q) const;
  bool is_free(std::span<const double> q) const;
  /// True if the straight motion is free all the way, both ends included.
  bool is_free(std::span<const double> from, std::span<const double> to) const;
  /// Seconds of the straight motion from standstill to standstill: every coordinate accelerates, travels and brakes
  /// together with the slowest. Coordinates of a parallel robot are timed by its actuators.
  double seconds(std::span<const double> from, std::span<const double> to) const;
  /// Variant for the shortest conceivable motion, from both ends only.
  double least_seconds(std::span<const double> from, std::span<const double> to) const;
  /// A distance that shrinks on the straight way from one to the other, for planners: seconds of an arm, the largest
  /// share of a coordinate's range for a parallel robot, whose actuators may go back and forth on the way.
  double distance(std::span<const double> from, std::span<const double> to) const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// A motion through via points, straight from one to the next.
struct Motion {
  std::vector<std::vector<double>> points;  ///< both ends included
  double seconds = 0.0;                     ///< standing still at every point
  const char* found_by = "straight";        ///< straight, roadmap or rrt_connect
};

/// Purpose of a roadmap. Motions are short where milestones are joined on several ways; to know what is
/// connected, one way is enough, and most straight motions need no look.
enum class RoadmapUse { motions, connection };

/// One roadmap that serves all queries (PRM with a fixed number of milestones, so that it is the same on every run),
/// and that grows by what RRT-Connect finds where it does not connect. Not for several threads.
class Roadmap {
 public:
  /// @param space, monitor  must outlive the roadmap; where the monitor says stop, it stays smaller and finds less
  Roadmap(const MotionSpace& space, int milestones, std::uint64_t seed, RoadmapUse use, const Monitor& monitor);
  ~Roadmap();
  Roadmap(const Roadmap&) = delete;
  Roadmap& operator=(const Roadmap&) = delete;

  /// A motion between two free configurations along the roadmap, simplified; empty `points` if it connects them not.
  Motion motion(std::span<const double> from, std::span<const double> to);
  /// Variant by RRT-Connect, seconds without a solution; its way then belongs to the roadmap.
  Motion grow(std::span<const double> from, std::span<const double> to);
  /// Milestones that are connected with `q`, q first.
  std::vector<std::vector<double>> connected(std::span<const double> q);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace posewright
