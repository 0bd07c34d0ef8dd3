#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <vector>

#include "posewright/model/identification_model.hpp"

namespace posewright {

/// Pose that a tip is to have in the frame of measurement.
struct TipGoal {
  Eigen::Isometry3d wanted = Eigen::Isometry3d::Identity();
  std::vector<int> components{0, 1, 2, 3, 4, 5};  ///< x, y, z of the place, then of the rotation vector
  std::optional<double> instrument{};             ///< of a list, whose tip counts; none: the one that reads at q
};

/// Moves joints until tips are where they are wanted, by damped least squares from where they are (Levenberg 1944), so
/// that all branches of the inverse kinematics and all of a redundant arm's are found. Const and callable from several
/// threads.
class TipMover {
 public:
  /// @param coordinates  limits within which the continuous ones move
  /// Both must outlive the mover.
  TipMover(const IdentificationModel& model, const std::vector<Coordinate>& coordinates);

  /// @param near  error that need not become smaller: norm over all goals in m (by twice the length) and rad
  /// @param held  true for coordinates that stay; empty: none
  /// @return false if nothing near q within the limits meets all goals; q is then the nearest that was found
  bool move(std::span<double> q, std::span<const TipGoal> goals, double near, std::span<const char> held = {}) const;

 private:
  struct Work;
  void place(Work& work, std::span<const double> q) const;
  void fill_jacobian(Work& work, std::span<const double> q) const;

  const IdentificationModel& model_;
  const std::vector<Coordinate>& coordinates_;
  std::optional<std::size_t> instrument_;
};

}  // namespace posewright
