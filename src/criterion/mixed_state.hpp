#pragma once

#include <memory>
#include <vector>

#include "posewright/criterion/criterion.hpp"
#include "posewright/criterion/criterion_data.hpp"

namespace posewright {

/// State of `compound` (minimum = false) and `maximin` with exact swaps.
/// @param variants  weights that sum to one
std::unique_ptr<DesignState> start_mixed(const CandidateView& view, std::vector<int> members,
                                         const std::vector<VariantGroup>& variants, bool minimum);

}  // namespace posewright
