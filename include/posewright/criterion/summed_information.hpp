#pragma once

#include <Eigen/Core>
#include <utility>
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

/// Weights on candidates, Σw = 1.
using CandidateWeights = std::vector<std::pair<int, double>>;

/// Prior per unit of weight (empty: none) plus Σ w JᵀJ.
inline Eigen::MatrixXd weighted_information(const BlockArray& blocks, const Eigen::MatrixXd& prior,
                                            const CandidateWeights& weights) {
  const auto m = blocks.columns();
  Eigen::MatrixXd sum = prior.size() > 0 ? prior : Eigen::MatrixXd::Zero(m, m);
  for (const auto& [candidate, weight] : weights) sum += weight * block_information(blocks, candidate);
  return sum;
}

}  // namespace posewright
