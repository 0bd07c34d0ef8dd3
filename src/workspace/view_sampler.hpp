#pragma once

#include <span>
#include <vector>

#include "posewright/cell/line_of_sight.hpp"
#include "posewright/support/random.hpp"
#include "tip_mover.hpp"

namespace posewright {

/// Configurations from which the instrument sees its targets: a pose of the tip that does, and the joints that reach
/// it. Const and callable from several threads.
class ViewSampler {
 public:
  /// @param coordinates  where configurations are proposed
  /// All must outlive the sampler.
  ViewSampler(const IdentificationModel& model, const LineOfSight& sight, const std::vector<Coordinate>& coordinates);

  /// Moves q to where the tip has a pose that sees. False if no configuration near q within the limits reaches it; q is
  /// then the nearest that was found, and may still see.
  bool move_to_view(std::span<double> q, Random& random) const;

 private:
  const LineOfSight& sight_;
  TipMover mover_;
};

}  // namespace posewright
