#pragma once

#include <optional>

namespace posewright {

/// Chance that a chi-square test of known noise rejects at `level` while the sum of squares has the noncentrality
/// `lambda`: 1 − F(x; df, λ) with x the (1 − level) quantile of the central distribution.
/// @param degrees_of_freedom  > 0
/// Throws std::invalid_argument for numbers out of range.
double chi_square_power(double lambda, double degrees_of_freedom, double level);

/// Number of repeated measurements for the power of the residual test: λ and the readings count k
/// times, the fitted parameters once. None if a million times do not suffice.
/// @param readings  of the measurement done once
/// @param fitted    parameters, estimated from all readings together
std::optional<int> repetitions_for_power(double lambda, int readings, int fitted, double level, double power);

/// Variant for the test along one known effect: one degree of freedom for any number.
std::optional<int> repetitions_along_effect(double lambda, double level, double power);

}  // namespace posewright
