#pragma once

#include "command.hpp"
#include "posewright/calibration/fit.hpp"

namespace posewright::cli {

/// --weights ols|wls|robust; weighted where it is not given.
inline Weighting weighting_of(const po::variables_map& values) {
  const std::string word = choice_of(values, "weights", {"ols", "wls", "robust"});
  return word == "ols" ? Weighting::ordinary : word == "robust" ? Weighting::robust : Weighting::weighted;
}

}  // namespace posewright::cli
