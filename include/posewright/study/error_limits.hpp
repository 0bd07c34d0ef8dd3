#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "posewright/calibration/possible_effects.hpp"
#include "posewright/study/forecast.hpp"
#include "posewright/study/variant.hpp"

namespace posewright {

/// Limits that hold with 95 % confidence after a calibration, SI, whatever effect the readings leave possible.
struct ErrorLimits {
  std::optional<double> error;   ///< root mean square at the test poses, m; none without test points
  std::optional<double> effect;  ///< part of it that a missing effect may have, m
  /// Along x, y, z (m) and about them (rad) at the worst test pose; none without test points, or where nothing turns.
  std::array<std::optional<double>, 6> axes{};
  Eigen::VectorXd parameters;  ///< σ of the variant's columns
};

/// Mean and mean square of Σ λ_i χ²_1 as noise s and effect τ add up, Σ_p = s² N + τ² E: theory.md eq. (67).
struct ErrorParts {
  double noise = 0, effect = 0;                            ///< tr N, tr E
  double noise_squared = 0, both = 0, effect_squared = 0;  ///< tr N², tr NE, tr E²
};

/// Value that the root of a mean square does not exceed with 95 % confidence, eq. (51).
/// @param parts  of each of `effects`
double upper_error(const std::vector<PossibleEffects>& effects, const std::vector<ErrorParts>& parts);
/// This limit for the size of a normal error.
/// @param noise   its variance for s = 1
/// @param effect  variance by each shape for τ = 1 m
double upper_normal(const std::vector<PossibleEffects>& effects, double noise, const std::vector<double>& effect);
/// This limit for σ itself.
double upper_sigma(const std::vector<PossibleEffects>& effects, double noise, const std::vector<double>& effect);

/// @param noise  tolerances that counted in the fit, and the factor of the noise there
/// @param poses  that determine all columns
/// @param axes  asked for: a limit for each test pose
ErrorLimits error_limits(const Variant& variant, const ForecastNoise& noise, const std::vector<MeasuredPose>& poses,
                         const std::vector<PossibleEffects>& effects, bool axes);

}  // namespace posewright
