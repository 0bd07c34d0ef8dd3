#pragma once

#include "command.hpp"
#include "posewright/calibration/fit.hpp"

namespace posewright::cli {

/// What --weights takes, and results state.
inline std::string weighting_word(Weighting weighting) {
  return weighting == Weighting::ordinary ? "ols" : weighting == Weighting::weighted ? "wls" : "robust";
}

/// --weights ols|wls|robust; weighted where it is not given.
inline Weighting weighting_of(const po::variables_map& values) {
  const std::string word = choice_of(values, "weights", {"ols", "wls", "robust"});
  for (const Weighting weighting : {Weighting::ordinary, Weighting::robust})
    if (word == weighting_word(weighting)) return weighting;
  return Weighting::weighted;
}

}  // namespace posewright::cli
