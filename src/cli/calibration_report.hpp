#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "posewright/pipeline/calibrate_problem.hpp"

namespace posewright::cli {

/// A test that chance fails this seldom is worth a sentence.
inline constexpr double seldom = 0.01;
/// "= 0.12", "below 1e-6": after a p.
std::string chance_text(double probability);

/// What a person reads: parameters with intervals, residuals before and after, what the residuals say of the model.
std::string calibration_text(const Calibration& calibration);

/// The same for machines, nothing left out: what posewright/calibration/1 has besides program and problem.
nlohmann::ordered_json calibration_json(const Calibration& calibration);

/// Parts of both: errors by axis before and after, poses that were not fitted, the identification in steps, constants
/// of a compensator from listed compliances. Text is empty where there is nothing of the kind.
std::string axes_text(const Calibration& calibration);
/// RMS and largest error before and after and by how much they are better: names and cells of these columns.
std::vector<std::string> improvement_columns();
std::vector<std::string> improvement_cells(const AxisImprovement& improvement);
std::string predicted_poses_text(const Calibration& calibration);
std::string steps_text(const Calibration& calibration);
std::string compensator_text(const CompensatorConstants& constants);
nlohmann::ordered_json axes_json(const Calibration& calibration);
nlohmann::ordered_json pose_accuracy_json(const std::optional<PoseAccuracy>& accuracy);
nlohmann::ordered_json steps_json(const Calibration& calibration);
nlohmann::ordered_json compensator_json(const CompensatorConstants& constants);
std::string platform_text(const PlatformDeformation& platform);
nlohmann::ordered_json platform_json(const PlatformDeformation& platform);
/// The map of a platform's deformation as a picture: displacement of every joint centre over its own actuator,
/// measured, by κ and by K.
std::string platform_svg(const PlatformDeformation& platform);

/// Several models of one robot, judged on the same data.
std::string models_text(const std::vector<Calibration>& models);

}  // namespace posewright::cli
