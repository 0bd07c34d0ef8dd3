#pragma once

#include <string>

#include "posewright/study/setup.hpp"

namespace posewright {

/// True if the criterion counts an effect that nobody stated.
bool assumes_effect(const Setup& setup);

/// Reason in the design for which `auto` takes no bias for so many poses, whatever the robot; empty: none.
/// @param first  of the variants
std::string why_not_bias(const Setup& setup, const VariantSpec& first, const std::optional<int>& poses);

/// Columns of an assumed effect make each candidate several times as costly: fewer starts, and no moves between
/// candidates, where nobody stated them.
void limit_search_with_effect(Setup& setup);

}  // namespace posewright
