#pragma once

#include "posewright/model/euler_turns.hpp"

namespace posewright {

/// Forms of an orientation in a file of readings.
struct OrientationForm {
  enum Kind { vector, quaternion, angles };
  Kind kind = vector;
  EulerTurns turns{};  ///< of `angles`
};

}  // namespace posewright
