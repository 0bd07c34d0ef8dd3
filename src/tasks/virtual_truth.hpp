#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "posewright/calibration/experiment.hpp"
#include "posewright/criterion/criterion_data.hpp"
#include "posewright/model/variant_columns.hpp"
#include "posewright/problem/problem.hpp"
#include "posewright/study/variant.hpp"
#include "posewright/tasks/simulate_problem.hpp"

namespace posewright {

/// The problem with the noise that the measured robot has.
Problem with_truth_noise(Problem problem, const TruthNoise& noise);

/// Configurations of robot `to` with the actuators (the joints of an arm) of `from`.
/// Throws CannotDo if it cannot, or where the two have different coordinates.
std::vector<std::vector<double>> same_actuators(const IdentificationModel& from, const IdentificationModel& to,
                                                const std::vector<std::vector<double>>& configurations);

/// Places to check and their predicted errors; the models that the places need live here.
struct PlacesToCheck {
  std::unique_ptr<IdentificationModel> fitted, truth;
  CheckPlaces places;
  std::vector<TestPoint> points;  ///< the same places, linearised for the fitted variant's columns
};

/// The test poses of the fitted variant's problem. Null if it has none, or where the robot has no tip.
/// @param drawn  columns of the truth
std::unique_ptr<PlacesToCheck> places_to_check(const Variant& fitted, const Variant& truth, const VariantColumns& drawn,
                                               std::uint64_t seed);

}  // namespace posewright
