#pragma once

#include <string>

#include "posewright/study/study.hpp"

namespace posewright {

/// Whether the criterion counts an effect that nobody stated.
bool assumes_effect(const Settings& settings);

/// Reason in the design for which `auto` takes no bias, whatever the robot; empty: none.
std::string why_not_bias(const Problem& problem, const Settings& settings);

}  // namespace posewright
