#pragma once

#include <cstddef>
#include <tuple>
#include <vector>

#include "posewright/planning/approximate_design.hpp"

namespace posewright {

/// Candidates that no process holds all of. Every process calls the same functions in the same order and gets the same
/// answers.
class SpreadBlocks {
 public:
  /// A candidate and the requested figure.
  struct Ranked {
    double value = 0.0;
    int candidate = -1;

    static auto fields(auto& own) { return std::tie(own.value, own.candidate); }
  };

  virtual ~SpreadBlocks() = default;
  virtual std::size_t count() const = 0;
  virtual int rows() const = 0;
  virtual int columns() const = 0;
  /// The blocks of some candidates (ascending), on every process.
  virtual BlockArray fetch(const std::vector<int>& candidates) = 0;
  /// Computes d_i = ‖J_i T‖² of all candidates, T upper triangular; for largest().
  virtual void pass(const Eigen::MatrixXd& T) = 0;
  /// The `most` largest d_i above `least`, largest first and ties by index, without `except` (ascending).
  virtual std::vector<Ranked> largest(std::size_t most, double least, const std::vector<int>& except) = 0;
  /// True if any process was stopped.
  virtual bool stopped() = 0;
};

/// solve_approximate_design() over such candidates: the working set's blocks are on every process, which all solve for
/// the same weights; a pass over the shares gives the largest d_i, which prove the bound, and the candidates that
/// enter. The sensitivity of every candidate is not part of the result. A round sends the largest d_i and the blocks of
/// those that enter. Throws std::invalid_argument as it does, and for a prior or a cap that leaves no choice.
ApproximateDesign solve_spread_design(SpreadBlocks& candidates, const InformationFunction& function,
                                      const ApproximateDesignOptions& options, const Monitor& monitor);

}  // namespace posewright
