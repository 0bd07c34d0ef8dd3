#pragma once

#include <span>

#include "posewright/model/identification_model.hpp"

namespace posewright {

/// Whether a robot with other parameters can stand where its actuators are as the nominal one's are at q, and be
/// measured there.
/// @param correction  ξ − nominal for every parameter
/// @param stands      size of q: where it then stands
inline bool readable(const IdentificationModel& model, std::span<const double> q, std::span<const double> correction,
                     std::span<double> stands) {
  return model.settled(q, correction, stands) && model.measurable(stands, correction);
}

}  // namespace posewright
