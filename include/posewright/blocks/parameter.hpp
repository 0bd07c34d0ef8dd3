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
  bool tolerance_stated = false;  ///< the user wrote the tolerance; else it is assumed
  bool places = false;  ///< places things (base, tool, targets, instruments), and is no parameter of the robot
};

/// Calibrated parameters that something was computed at; empty: the nominal ones.
struct ParametersFile {
  std::string file, sha256;
  std::string variant;  ///< that takes the values as its own
};

/// Tolerances used as one more measurement of their parameter (1σ): none, those of parameters that were
/// manufactured and those that the user stated (the pose of a base is unknown by default), or all.
enum class Prior { none, manufactured, every };

inline bool counts(const Parameter& parameter, Prior prior) {
  return prior == Prior::every || (prior == Prior::manufactured && (parameter.tolerance_stated || !parameter.places));
}

}  // namespace posewright
