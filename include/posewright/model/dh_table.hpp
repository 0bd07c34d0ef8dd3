#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "posewright/model/calibrated_values.hpp"
#include "posewright/model/dh_chain.hpp"

namespace posewright {

/// One joint of a table of Denavit–Hartenberg parameters; m and rad. The reading is added to theta, or to d where the
/// joint is prismatic.
///   distal:    Rz(θ) Tz(d) Tx(a) Rx(α) Ry(β)
///   proximal:  Tx(a) Rx(α) Ry(β) Rz(θ) Tz(d)
struct DhRow {
  std::string joint;
  bool prismatic = false;
  double theta = 0.0, d = 0.0, a = 0.0, alpha = 0.0;
  std::optional<double> beta;  ///< Hayati's, where the axis is parallel to the next (distal) or the one before
};

/// A serial arm as a table: tip in the measurement frame = X_MeasureBase · X_BaseFirst · Π rows · X_LastTip.
struct DhTable {
  DhConvention convention = DhConvention::distal;
  Eigen::Isometry3d X_MeasureBase = Eigen::Isometry3d::Identity();  ///< the URDF's base link, calibrated
  Eigen::Isometry3d X_BaseFirst = Eigen::Isometry3d::Identity();  ///< frame on the first joint's axis in the base link
  std::vector<DhRow> rows;
  Eigen::Isometry3d X_LastTip = Eigen::Isometry3d::Identity();
  std::vector<std::string> left_out;  ///< corrections that a table cannot hold: "NAME = VALUE UNIT: why"

  /// Tip in the measurement frame. @param q  one reading a row, rad or m
  Eigen::Isometry3d tip(std::span<const double> q) const;
};

/// The table of a calibrated arm.
/// @param names       whose names the values have
/// @param convention  of the table; need not be that of the values
/// Throws as read_urdf_chain, chain_correction and denavit_hartenberg.
DhTable dh_table(const SerialArmSpec& arm, const SourcePlace& place, VariantSpec::Convention names,
                 const std::vector<CalibratedValue>& values, DhConvention convention);

}  // namespace posewright
