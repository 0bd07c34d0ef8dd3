#pragma once

#include <Eigen/Geometry>
#include <vector>

namespace posewright {

/// Points fixed to a robot's tip, as an instrument saw them at one pose.
struct SeenPoints {
  Eigen::Isometry3d tip;    ///< in the robot's base, of the nominal robot
  Eigen::Matrix3Xd points;  ///< one column a point, instrument's frame, m; NaN: not seen
};

/// Fit of base and tool alone to the readings.
struct HandEye {
  double rms = 0.0;    ///< of the distances that are left, in the robot's lengths, m; infinite: too few were seen
  double scale = 1.0;  ///< by which the instrument's lengths were multiplied
  Eigen::Isometry3d X_BaseInstrument = Eigen::Isometry3d::Identity();
  Eigen::Matrix3Xd points{};  ///< on the tip, m
};

/// Fits s A p_ik = R_i t_k + o_i + c to all points p_ik seen at tips (R_i, o_i): A the rotation of the instrument, t_k
/// the points on the tip. No start is needed: with any matrix in place of s A the equation is linear in A, c and t;
/// the rotation nearest to that solution is the start of a few Gauss–Newton steps.
/// @param free_scale  s is fitted, too; else 1
HandEye hand_eye(const std::vector<SeenPoints>& seen, bool free_scale = false);

}  // namespace posewright
