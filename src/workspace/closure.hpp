#pragma once

#include <memory>
#include <span>
#include <vector>

#include "posewright/problem/measurement_specs.hpp"
#include "tip_mover.hpp"

namespace posewright {

/// Reason of drawn configurations from which no joint angles close the loop.
inline constexpr const char* open_loop_reason = "the loop stays open";

/// Joined tips (PoseMeasurement::joined): moves joints to the nearest configuration in which they meet, by the nominal
/// model. Const and callable from several threads.
class Closure {
 public:
  /// @return null if no tips are joined
  /// @param coordinates  where configurations are proposed
  /// All must outlive the closure.
  static std::unique_ptr<Closure> make(const IdentificationModel& model, const MeasurementSpec& measurement,
                                       const std::vector<Coordinate>& coordinates);

  /// Coordinates at an end of their limits stay there if the others close the loop.
  /// @return false if none does within the limits
  bool close(std::span<double> q) const;

 private:
  Closure(const IdentificationModel& model, const std::vector<Coordinate>& coordinates, std::vector<TipGoal> goals);

  const std::vector<Coordinate>& coordinates_;
  std::vector<TipGoal> goals_;
  TipMover mover_;
};

}  // namespace posewright
