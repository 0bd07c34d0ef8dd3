#pragma once

#include <memory>
#include <span>
#include <vector>

#include "posewright/cell/cell.hpp"
#include "posewright/support/random.hpp"
#include "tip_mover.hpp"

namespace posewright {

/// Configurations from which the instrument that reads sees its targets: a pose of the tip that does, and the joints
/// that reach it. Const and callable from several threads.
class ViewSampler {
 public:
  /// @return null if no instrument of the cell has a direction to propose views by
  /// @param coordinates  where configurations are proposed
  /// All must outlive the sampler.
  static std::unique_ptr<ViewSampler> make(const IdentificationModel& model, const Cell& cell,
                                           const std::vector<Coordinate>& coordinates);

  /// Moves q to where the tip has a pose that sees. False if no configuration near q within the limits reaches it; q is
  /// then the nearest that was found, and may still see. An instrument without a direction sees from anywhere.
  bool move_to_view(std::span<double> q, Random& random) const;

 private:
  ViewSampler(const IdentificationModel& model, const Cell& cell, const std::vector<Coordinate>& coordinates);
  const Cell& cell_;
  TipMover mover_;
};

}  // namespace posewright
