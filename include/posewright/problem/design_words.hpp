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

}  // namespace posewright
