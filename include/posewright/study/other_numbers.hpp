#pragma once

#include <optional>
#include <vector>

#include "posewright/results/plan.hpp"
#include "posewright/study/judgement.hpp"

namespace posewright {

/// Figures of a list by its judgement: log det, predicted error at the test poses, largest σ over tolerance of the
/// first variant's parameters of interest.
CurvePoint figures_of(const Study& study, const Judgement& judgement, int poses);

/// What other numbers of poses reach, from 0.6 to 2 times those of a plan: each a local search that begins with the
/// plan's poses (search/other_sizes.hpp). Fixed poses are in every one.
/// @param own         the plan's poses, without those that are fixed or measured
/// @param candidates  that may come beside them
/// @param references  bounds of the variants' log det, for criteria over several; empty: they are computed
/// @return ascending by number, without the plan's own; numbers that do not determine all parameters, that do not fit
/// or
///         that a stop cut off are left out
std::vector<CurvePoint> other_numbers(const Study& study, const Configurations& own, const Configurations& candidates,
                                      const std::vector<double>& references, const Monitor& monitor);

}  // namespace posewright
