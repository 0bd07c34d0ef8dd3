#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "posewright/planning/evaluate.hpp"
#include "posewright/search/design_measure.hpp"
#include "posewright/study/study.hpp"
#include "posewright/study/unmodelled.hpp"

namespace posewright {

/// Evaluation of a list of configurations from the list alone: equal for a plan and a user's poses.
struct Judgement {
  std::vector<Evaluation> evaluations;           ///< of every variant; contributions in the order measured, then poses
  std::optional<double> rho0;                    ///< first variant, m
  std::vector<double> test_errors;               ///< m
  std::optional<double> turn;                    ///< as rho0, of the orientation, rad
  std::vector<std::array<double, 6>> test_axes;  ///< 1σ at each test pose: x, y, z (m), rx, ry, rz (rad)
  std::optional<PlannedEffect> unmodelled;       ///< if the first variant lacks an effect
  std::optional<Discrimination> discrimination;  ///< if a truth is named
};

/// @param poses  come to those that are measured already
/// Throws CannotDo if they do not identify all parameters.
Judgement judge(const Study& study, const Configurations& poses);

/// Φ of the poses under a criterion (theory.md), by the criterion's own function.
/// @param poses  beside those that are measured already
double phi_of(const DesignMeasure& measure, const std::string& criterion, const Study& study,
              const Configurations& poses);

/// ln of each variant's efficiency against its reference.
std::vector<double> log_efficiencies(const Judgement& judgement, const Study& study,
                                     const std::vector<double>& references);

}  // namespace posewright
