#pragma once

#include <memory>
#include <vector>

#include "posewright/criterion/criterion.hpp"
#include "posewright/criterion/criterion_data.hpp"
#include "posewright/criterion/scenarios.hpp"
#include "posewright/support/robust_aim.hpp"

namespace posewright {

/// State of `compound` (minimum = false) and `maximin` with exact swaps.
/// @param variants  weights that sum to one
std::unique_ptr<DesignState> start_mixed(const CandidateView& view, std::vector<int> members,
                                         const std::vector<VariantGroup>& variants, bool minimum);

/// Variant for scenarios with their own blocks.
std::unique_ptr<DesignState> start_mixed(const CandidateView& view, std::vector<int> members,
                                         const std::vector<Scenario>& scenarios, const RobustAim& aim, double whole);

}  // namespace posewright
