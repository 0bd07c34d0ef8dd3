#pragma once

#include <Eigen/Core>
#include <vector>

#include "posewright/blocks/block_array.hpp"

namespace posewright {

/// tr(J_i M⁻¹ J_iᵀ) of every candidate for the leading `columns` columns.
/// @param inverse_factor  L⁻¹ of M = L Lᵀ; its leading columns × columns part is used
/// @param d               resized to blocks.count()
void information_traces(const BlockArray& blocks, const Eigen::MatrixXd& inverse_factor, int columns,
                        std::vector<double>& d, int threads = 1);

/// d_i = tr(J_i S J_iᵀ) of every candidate for S = T Tᵀ: gain of Φ by a unit of weight on i (see Expansion). One pass
/// over the blocks, O(n r m²/2), on `threads` threads (0 = all).
/// @param T  m × m, upper triangular
/// @param d  resized to blocks.count()
void sensitivities(const BlockArray& blocks, const Eigen::MatrixXd& T, int threads, std::vector<double>& d);

/// Keeps the candidates of largest d, largest first, equal ones by index: `count`, or as many as there are.
void keep_largest(std::vector<int>& candidates, const std::vector<double>& d, std::size_t count);

}  // namespace posewright
