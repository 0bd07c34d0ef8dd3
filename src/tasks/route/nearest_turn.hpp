#pragma once

#include <span>
#include <vector>

#include "posewright/study/variant.hpp"

namespace posewright {

/// This pose with every joint of an arm that can turn more than once on the turn nearest to home. A configuration
/// stays as it is if the tip or a column of the variant is another one there: a gear's error grows from turn to turn.
/// @param home  a whole configuration
std::vector<double> nearest_turn(const Variant& variant, std::span<const double> home, std::vector<double> q);

}  // namespace posewright
