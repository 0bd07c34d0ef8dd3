#pragma once

#include <optional>
#include <vector>

#include "posewright/calibration/fit.hpp"

namespace posewright {

/// Displacement of later poses against the fitted ones: the motion of the base that explains most of what the
/// estimate leaves of their readings. An instrument that was moved in between has another frame.
struct FrameShift {
  double before = 0.0, after = 0.0;  ///< root mean square of their whitened residuals, without and with the motion
  double moved = 0.0, turned = 0.0;  ///< of the base: m, rad

  /// Residuals that are many times the noise and fall to a small part of it: nothing but a frame does that.
  bool is_another_frame() const { return before > 5 && after < 0.2 * before; }
};

/// @param correction  of all parameters, as they were fitted
/// None if the model has no base, there are fewer than three poses, or they do not tell where it is.
std::optional<FrameShift> frame_shift(const IdentificationModel& model, const std::vector<MeasuredPose>& poses,
                                      const std::vector<double>& correction);

}  // namespace posewright
