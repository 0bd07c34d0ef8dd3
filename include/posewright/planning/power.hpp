#pragma once

#include <optional>

namespace posewright {

/// Chance that a chi-square test of known noise rejects at `level` while the sum of squares has the noncentrality
/// `lambda`: 1 − F(x; df, λ) with x the (1 − level) quantile of the central distribution.
/// @param degrees_of_freedom  > 0
/// Throws std::invalid_argument for numbers out of range.
double chi_square_power(double lambda, double degrees_of_freedom, double level);

/// How often a measurement must be done for the test of its residuals to have the power: λ and the readings count k
/// times, what is fitted once. None if a million times do not suffice.
/// @param readings  of the measurement done once
/// @param fitted    parameters, estimated from all readings together
std::optional<int> repetitions_for_power(double lambda, int readings, int fitted, double level, double power);

/// The same for the test along one known effect: one degree of freedom, however often.
std::optional<int> repetitions_along_effect(double lambda, double level, double power);

}  // namespace posewright
