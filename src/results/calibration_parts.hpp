#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "posewright/results/calibration.hpp"

namespace posewright {

/// A test that chance fails this seldom is worth a sentence.
inline constexpr double seldom = 0.01;
/// "= 0.12", "below 1e-6": after a p.
std::string chance_text(double probability);

/// Row by row.
nlohmann::ordered_json matrix_json(const Eigen::MatrixXd& matrix);

/// Parts of text and JSON: errors by axis before and after, poses that were not fitted, the identification in steps,
/// constants of a compensator. Text is empty if there is nothing of the kind.
std::string axes_text(const Calibration& calibration);
std::string requirements_text(const Calibration& calibration);
/// RMS and largest error before and after and by how much they are better: names and cells of these columns.
std::vector<std::string> improvement_columns();
std::vector<std::string> improvement_cells(const AxisImprovement& improvement);
std::string predicted_poses_text(const Calibration& calibration);
std::string steps_text(const Calibration& calibration);
nlohmann::ordered_json axes_json(const Calibration& calibration);
nlohmann::ordered_json requirements_json(const Calibration& calibration);
nlohmann::ordered_json pose_accuracy_json(const std::optional<PoseAccuracy>& accuracy);
nlohmann::ordered_json steps_json(const Calibration& calibration);
nlohmann::ordered_json compensator_json(const CompensatorConstants& constants);
/// Estimated frames as the problem file states them: position and rpy; JSON has the quaternion, too.
std::string frames_text(const Calibration& calibration);
nlohmann::ordered_json frames_json(const Calibration& calibration);
/// Points a_i and b_i of a robot with legs, in base and platform, nominal and by the estimate; empty: it has none.
nlohmann::ordered_json leg_points_json(const Calibration& calibration);
/// Whiteness, a smooth effect, its interpolation, normality.
std::string whiteness_text(const Calibration& calibration);
std::string revisits_text(const Calibration& calibration);
std::string not_in_auto_text(const Calibration& calibration);
std::string platform_text(const PlatformDeformation& platform);
nlohmann::ordered_json platform_json(const PlatformDeformation& platform);

}  // namespace posewright
