#pragma once

#include <Eigen/Dense>
#include <vector>

#include "posewright/blocks/block_array.hpp"

namespace posewright {

/// tr(J_i M⁻¹ J_iᵀ) of every candidate for the leading `columns` columns.
/// @param inverse_factor  L⁻¹ of M = L Lᵀ; its leading columns × columns part is used
/// @param d               resized to blocks.count()
void information_traces(const BlockArray& blocks, const Eigen::MatrixXd& inverse_factor, int columns,
                        std::vector<double>& d);

/// d_i = tr(J_i M⁻¹ J_iᵀ) − tr(J_i,n M_nn⁻¹ J_i,nᵀ) of every candidate: what a unit of weight on i adds to the log det
/// of the interest information. One pass over the blocks, O(n r m²/2).
/// @param inverse_factor  L⁻¹ of M = L Lᵀ, nuisance columns first
/// @param d               resized to blocks.count()
void sensitivities(const BlockArray& blocks, int nuisance, const Eigen::MatrixXd& inverse_factor,
                   std::vector<double>& d);

}  // namespace posewright
