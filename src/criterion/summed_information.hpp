#pragma once

#include <Eigen/Core>
#include <vector>

#include "posewright/blocks/block_array.hpp"

namespace posewright {

/// JᵀJ of one candidate.
inline Eigen::MatrixXd block_information(const BlockArray& blocks, int candidate) {
  const auto block = blocks.block(std::size_t(candidate));
  return block.transpose() * block;
}

/// Prior (null: none) plus Σ JᵀJ over the members.
inline Eigen::MatrixXd summed_information(const BlockArray& blocks, const Eigen::MatrixXd* prior,
                                          const std::vector<int>& members) {
  const auto m = blocks.columns();
  Eigen::MatrixXd sum = prior != nullptr ? *prior : Eigen::MatrixXd::Zero(m, m);
  for (const int i : members) sum += block_information(blocks, i);
  return sum;
}

}  // namespace posewright
