#pragma once

#include <cstdint>
#include <string>

#include "posewright/study/variant.hpp"
#include "posewright/workspace/candidates.hpp"

namespace posewright {

/// A sentence on poses of a plan that robots drawn from the tolerances cannot take, or that the instrument cannot
/// read there (the board leaves the picture, the distance the instrument's range); empty: none is lost by one in
/// twenty.
/// @param first  what the first of the poses is called; the others follow
std::string poses_at_risk(const Variant& variant, const Configurations& poses, int first, std::uint64_t seed);

}  // namespace posewright
