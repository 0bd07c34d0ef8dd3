#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "posewright/calibration/experiment.hpp"
#include "posewright/criterion/criterion_data.hpp"
#include "posewright/model/variant_columns.hpp"
#include "posewright/problem/problem.hpp"
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

/// One side of the experiment.
struct Side {
  const VariantSpec* spec;
  const IdentificationModel* model;
  const VariantColumns* columns;  ///< estimated, or drawn
};
/// The problem's test poses. Null if it has none, or where the robot has no tip.
std::unique_ptr<PlacesToCheck> places_to_check(const Problem& problem, const Side& fitted, const Side& truth,
                                               std::uint64_t seed);

}  // namespace posewright
