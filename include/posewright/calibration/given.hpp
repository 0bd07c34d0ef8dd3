#pragma once

#include <string>
#include <vector>

#include "posewright/blocks/identifiability.hpp"

namespace posewright {

/// For each parameter the names of those left out whose effect is partly its own: its value holds for their nominal
/// values only. Of those left out that were manufactured, or whose tolerance is stated, something is known: they are
/// not named.
/// @param dependencies  of left-out parameters, over these
std::vector<std::vector<std::string>> given(const std::vector<Dependency>& dependencies,
                                            const std::vector<Parameter>& parameters);

}  // namespace posewright
