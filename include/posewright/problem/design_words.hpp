#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "posewright/problem/design_specs.hpp"

/// Choices of the design block as words, the same in files, on the command line and in Python.
namespace posewright {

/// tolerance, norm or none.
std::string scaling_text(Scaling scaling);
/// None for another word.
std::optional<Scaling> scaling_of(std::string_view word);

/// forbid, allow or the number.
std::string repeats_text(Repeats repeats);
/// None for anything but forbid, allow and a whole number from 1 to 1000000.
std::optional<Repeats> repeats_of(std::string_view text);
/// What is to be said where there is none.
inline constexpr const char* repeats_allowed =
    "allowed: allow, forbid, or how often a pose may be measured: 1 to 1000000";

}  // namespace posewright
