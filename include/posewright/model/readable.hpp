#pragma once

#include <span>

#include "posewright/model/identification_model.hpp"

namespace posewright {

/// True if a robot with other parameters reaches the nominal one's actuators at q and can be
/// measured there.
/// @param correction  ξ − nominal for every parameter
/// @param stands      size of q: where it then stands
inline bool readable(const IdentificationModel& model, std::span<const double> q, std::span<const double> correction,
                     std::span<double> stands) {
  return model.settled(q, correction, stands) && model.measurable(stands, correction);
}

}  // namespace posewright
