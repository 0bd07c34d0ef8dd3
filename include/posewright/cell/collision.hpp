#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "posewright/cell/necessary_limits.hpp"
#include "posewright/model/identification_model.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

struct Scene;

/// Two bodies of the robot that are never twice as far apart as their clearance asks for, a gun and its wrist: they
/// keep half of the largest distance that was found instead, 1 mm at least.
struct ReducedClearance {
  std::string first, second;
  double clearance = 0.0;  ///< m, that is kept
};

/// Distance of two bodies.
struct Separation {
  double distance = 0.0;  ///< m; 0: they touch
  std::string first, second;
  /// Nearest points, one of the first and one of the second body, measurement frame, m; none where they touch or
  /// no pair of points is as far apart as they are.
  std::optional<std::array<Eigen::Vector3d, 2>> points{};
};

/// Collisions of robot, tool and obstacles. Const and callable from several threads.
class Collision {
 public:
  /// @param model  nominal one of the problem (Problem::workspace has a collision block); must outlive this
  /// @param same_robot  of the same robot, tool and clearances, its obstacles elsewhere: what is known of pairs of the
  ///                    robot's own bodies is taken over; null: none
  /// Throws InputError for links, packages and meshes that are missing or broken.
  Collision(const Problem& problem, const IdentificationModel& model, const Collision* same_robot = nullptr);
  ~Collision();

  /// "self-collision", "collision with table", …
  const std::vector<std::string>& reasons() const;
  /// Pairs of links that touch wherever the robot stands, and are therefore not checked.
  const std::vector<std::string>& always_touching() const;
  /// Pairs that cannot keep the clearance asked for by design.
  const std::vector<ReducedClearance>& reduced() const;
  /// Largest margin (m) that was added to a clearance for a robot that is not calibrated yet.
  double margin() const;

  /// Index into reasons() of a collision at q, or −1. Bodies keep their clearance, and half a millimetre more.
  int violation(std::span<const double> q) const;
  /// Functions that are never negative where violation() is −1: balls within bodies are above half spaces.
  NecessaryLimits necessary_limits() const;
  void necessary_values(std::span<const double> q, std::span<double> values) const;
  /// The first pair that is too near, "link_3", "table"; none if q is free.
  std::optional<std::pair<std::string, std::string>> colliding(std::span<const double> q) const;
  /// Smallest distance of any pair beyond its clearance (m), at most `cap`; negative: none of its clearance is kept.
  double slack(std::span<const double> q, double cap) const;

  /// The two bodies that are nearest to each other, of all pairs that are checked; none if nothing is.
  std::optional<Separation> nearest(std::span<const double> q) const;
  /// Variant for the straight motion, where the smallest distance is at most half a millimetre below the one returned.
  std::optional<Separation> nearest(std::span<const double> from, std::span<const double> to) const;

  /// True if the straight motion from `from` to `to` keeps every clearance all the way, not only at some states: a pair
  /// that is d apart keeps its clearance until its bodies can have moved by what d has to spare (bounds on the motion
  /// of a link, and halving of what two states leave open, as Schwarzer, Saha & Latombe 2005).
  bool motion_is_free(std::span<const double> from, std::span<const double> to) const;

  /// True if a body other than those of `station` comes nearer than `radius` to the segment at the first pose of q.
  bool blocked(std::span<const double> q, const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius,
               const std::string& station) const;
  /// Measurement frame of an instrument in the frame that bodies stand in: they differ for robots with several tips.
  /// @param in  tip that carries it; empty: the base
  Eigen::Isometry3d measurement_frame(std::span<const double> q, const std::string& in) const;
  /// Name of a body, other than those of `station`, that a point (frame of the bodies) is in at q; empty: none.
  std::string inside(std::span<const double> q, const Eigen::Vector3d& point, const std::string& station) const;

  /// Bodies as drawn: name, pose at q, corners; for tests and reports.
  const Scene& scene() const { return *scene_; }

 private:
  std::unique_ptr<Scene> scene_;
};

}  // namespace posewright
