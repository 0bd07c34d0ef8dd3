#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "posewright/blocks/block_array.hpp"
#include "posewright/planning/configuration_space.hpp"

namespace posewright {

/// A number to maximise that depends on a configuration through its block alone.
class BlockObjective {
 public:
  virtual ~BlockObjective() = default;
  /// @param J  r × m, whitened
  virtual double value(const BlockArray::ConstMap& J) = 0;
  /// ∂f/∂(JᵀJ) at the block, m × m: f changes by 2⟨J S, dJ⟩.
  virtual const Eigen::MatrixXd& gradient(const BlockArray::ConstMap& J) = 0;
};

struct AscentResult {
  std::vector<double> q;  ///< feasible; the start where nothing better was found
  double value = 0.0;
  int evaluations = 0;
};

/// Local maximum of f over the continuous axes of the space from a feasible start, by NLopt. Where the feasible set is
/// bounded by the axes and smooth margins: SLSQP with the derivative of f (BlockGradient), and where there are margins
/// SBPLX after it. Elsewhere SBPLX, infeasible configurations counting as worse than the start. Every configuration is
/// checked: the result is feasible and never worse than the start.
/// @param accept  more conditions on a result (minimum distance); may be empty
AscentResult ascend(const ConfigurationSpace& space, ConfigurationSpace::Probe& probe, BlockObjective& objective,
                    int rows, int columns, std::vector<double> start, int max_evaluations,
                    const std::function<bool(std::span<const double>)>& accept = {});

/// Block of one configuration with padded rows as BlockArray has them.
class ProbedBlock {
 public:
  ProbedBlock(int rows, int columns) : array_(1, rows, columns) {}
  bool at(ConfigurationSpace::Probe& probe, std::span<const double> q) {
    return probe.block(q, array_.row(0, 0), array_.stride());
  }
  BlockArray::ConstMap map() const { return std::as_const(array_).block(0); }

 private:
  BlockArray array_;
};

}  // namespace posewright
