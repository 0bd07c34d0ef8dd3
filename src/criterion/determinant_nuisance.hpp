#pragma once

#include <memory>
#include <vector>

#include "posewright/criterion/criterion.hpp"

namespace posewright {

/// State of the determinant criterion where nuisance columns are eliminated.
std::unique_ptr<DesignState> start_with_nuisance(const CandidateView& view, std::vector<int> members);

}  // namespace posewright
