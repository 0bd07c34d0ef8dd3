#pragma once

#include <memory>
#include <vector>

#include "posewright/criterion/criterion.hpp"
#include "posewright/criterion/spectral.hpp"

namespace posewright {

/// State of `o2` to `o5` with exact swaps.
std::unique_ptr<DesignState> start_spectral(const CandidateView& view, std::vector<int> members,
                                            std::shared_ptr<const SpectralFunction> function);

}  // namespace posewright
