#pragma once

#include <span>
#include <vector>

#include "posewright/blocks/block_array.hpp"
#include "posewright/planning/ascent.hpp"
#include "posewright/planning/configuration_space.hpp"

namespace posewright {

/// Gradient of a number that depends on a configuration through its block alone, along the axes of a space: by the
/// probe's own derivatives where it has them, else by central differences of blocks. The only place that knows which.
class BlockGradient {
 public:
  BlockGradient(const ConfigurationSpace& space, int rows, int columns);

  /// Continuous axes with room to move, ascending.
  const std::vector<std::size_t>& moving() const { return moving_; }

  /// @param slope     ∂f/∂J, r × m, at the block J of q
  /// @param gradient  one number for each of moving(): change of f as the axis moves by its whole range; 0 where there
  /// is
  ///                  no block beside q
  void at(ConfigurationSpace::Probe& probe, std::span<const double> q, const BlockArray::RowMatrix& slope,
          std::span<double> gradient);

 private:
  void differences(ConfigurationSpace::Probe& probe, std::span<const double> q, const BlockArray::RowMatrix& slope,
                   std::span<double> gradient);

  const std::vector<ConfigurationSpace::Axis>& axes_;
  std::vector<std::size_t> moving_;
  std::vector<double> all_, near_;
  ProbedBlock low_, high_;
};

}  // namespace posewright
