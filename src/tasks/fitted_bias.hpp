#pragma once

#include <Eigen/Core>
#include <optional>

#include "posewright/study/study.hpp"

namespace posewright {

/// Estimate less truth of every column of `fitted`, SI, where readings without noise come from `truth` at its nominal
/// values: the whole nonlinear fit, actuators standing alike. Empty if the fit does not arrive.
std::optional<Eigen::VectorXd> fitted_bias(const Variant& fitted, const Variant& truth, const Configurations& poses,
                                           bool prior);

}  // namespace posewright
