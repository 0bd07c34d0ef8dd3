#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "posewright/problem/design_specs.hpp"

/// Words of the design, the same in files, on the command line and in Python.
namespace posewright {

/// tolerance, norm or none.
std::string scaling_text(Scaling scaling);
/// None for another word.
std::optional<Scaling> scaling_of(std::string_view word);

/// Number of drawn robots and measure of their efficiencies, with defaults; none if both are missing.
/// @param option  name of the measure there, for messages
/// Throws InputError for another measure.
std::optional<RobustSpec> robust_spec(std::optional<int> draws, const std::string& measure, const std::string& option);

}  // namespace posewright
