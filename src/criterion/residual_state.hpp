#pragma once

#include <memory>
#include <vector>

#include "posewright/criterion/criterion.hpp"
#include "posewright/criterion/effect_criteria.hpp"

namespace posewright {

/// State of `discriminate` with exact swaps.
std::unique_ptr<DesignState> start_residual(const CandidateView& view, std::vector<int> members,
                                            std::shared_ptr<const DiscriminateFunction> function);

}  // namespace posewright
