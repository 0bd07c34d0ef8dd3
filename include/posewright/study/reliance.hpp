#pragma once

#include <optional>

#include "posewright/outputs/plan.hpp"
#include "posewright/planning/evaluate.hpp"
#include "posewright/study/study.hpp"

namespace posewright {

/// Errors of a plain fit of these configurations by a smooth unmodelled effect: sizes of 1, 2 and 4 times
/// the noise of one pose, the length UnmodelledSize::assumed_length. Least squares V Jᵀ r of readings r = J θ + F u + ε
/// that count no effect miss a place with the parameters' Jacobian A and the effect's B by A V Jᵀ(F u + ε) − B u
/// (theory.md eq. (35)). At the variant's test poses; without any at 200 of the study's configurations.
/// @param poses       all that are measured
/// @param evaluation  of these
/// @return none for a variant that counts an effect itself, and where the readings tell of no single tip
std::optional<Reliance> reliance_of(const Problem& problem, const Study& study, const Variant& variant,
                                    const Configurations& poses, const Evaluation& evaluation, int threads);

}  // namespace posewright
