#pragma once

#include "command.hpp"
#include "posewright/results/calibration.hpp"

namespace posewright::cli {

/// --weights ols|wls|robust; weighted if it is not given.
inline Weighting weighting_of(const po::variables_map& values) {
  return posewright::weighting_of(choice_of(values, "weights", {"ols", "wls", "robust"}));
}

}  // namespace posewright::cli
