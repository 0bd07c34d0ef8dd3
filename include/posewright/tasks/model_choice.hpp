#pragma once

#include <vector>

#include "posewright/results/calibration.hpp"

namespace posewright {

/// The model of the fewest parameters that predicts poses left out no worse than the best one does: its loss, paired
/// over the poses, is within one standard error (Breiman et al. 1984). Models that did not converge or predict no
/// better than base and tool alone are out.
ModelChoice choose_model(const std::vector<Calibration>& models);

}  // namespace posewright
