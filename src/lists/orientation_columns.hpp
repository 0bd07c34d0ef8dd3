#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "posewright/calibration/orientation_form.hpp"
#include "posewright/support/error.hpp"

namespace posewright {

/// Throws InputError at this place if the quaternion (x, y, z, w) has not length 1.
Eigen::Matrix3d rotation_of_quaternion(const Eigen::Vector4d& quaternion, const SourcePlace& place);

/// Columns of a file that have an orientation: PREFIX.rx, .ry, .rz (rotation vector), PREFIX.qx, .qy, .qz, .qw (unit
/// quaternion), or three angles in the order of their turns, PREFIX.fixed_xyz.1, .2, .3 or PREFIX.moving_zyz.1, .2, .3.
class OrientationColumns {
 public:
  OrientationColumns() = default;
  /// Throws InputError at the header if the names have an orientation twice.
  OrientationColumns(const std::string& prefix, const std::vector<std::string>& names, const SourcePlace& header);

  /// False: no orientation is there.
  bool found() const { return !columns_.empty(); }
  const OrientationForm& form() const { return form_; }
  /// The orientation of one row; none if a value is NaN. Throws InputError if a quaternion has not length 1.
  /// @param value  of a column in SI, by its name and unit ("rad" or "1")
  std::optional<Eigen::Matrix3d> rotation(const std::function<double(const std::string&, const std::string&)>& value,
                                          const SourcePlace& row) const;

 private:
  OrientationForm form_{};
  std::vector<std::string> columns_;
};

}  // namespace posewright
