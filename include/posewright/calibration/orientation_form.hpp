#pragma once

#include "posewright/model/euler_turns.hpp"

namespace posewright {

/// How a file of readings writes an orientation.
struct OrientationForm {
  enum Kind { vector, quaternion, angles };
  Kind kind = vector;
  EulerTurns turns{};  ///< of `angles`
};

}  // namespace posewright
