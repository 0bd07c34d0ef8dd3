#pragma once

#include <string>

namespace posewright {

enum class Role { interest, nuisance };

/// One model parameter ξ_j: the label of one column of G.
struct Parameter {
  std::string name;        ///< e.g. "joint_2.offset", "leg_1.ax", "base.rz"
  std::string unit;        ///< SI: "m", "rad", "1" (dimensionless)
  double nominal = 0.0;    ///< informative; models take corrections to it, zero at nominal
  double tolerance = 0.0;  ///< prior 1σ from manufacture and assembly, in `unit`; > 0
  Role role = Role::interest;
};

}  // namespace posewright
