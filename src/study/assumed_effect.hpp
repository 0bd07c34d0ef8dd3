#pragma once

#include "posewright/study/study.hpp"

namespace posewright {

/// Blocks, prior and effects for `bias` without a truth: the variant's columns, then features of a smooth effect that
/// the fit does not estimate. It is that of `unmodelled`, else one of 60 deg and twice the noise of a pose. Errors
/// count where the candidates are, as readings in units of their noise. Throws CannotDo if the readings contain no tip.
/// @param prior  of the columns of the variant's search
SearchPart part_with_assumed_effect(const Study& study, const Configurations& configurations, int threads,
                                    const Eigen::MatrixXd& prior);

/// True if the readings contain a position of the tip, so that an assumed effect shows.
bool moves_the_tip(const Study& study, int threads);

}  // namespace posewright
