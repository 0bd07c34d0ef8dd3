#pragma once

#include <memory>
#include <vector>

#include "posewright/criterion/criterion.hpp"
#include "posewright/criterion/discrepancy.hpp"

namespace posewright {

/// State of `discriminate` with exact swaps.
/// @param function  outlives the state
std::unique_ptr<DesignState> start_residual(const CandidateView& view, std::vector<int> members,
                                            const DiscriminateFunction& function);

}  // namespace posewright
