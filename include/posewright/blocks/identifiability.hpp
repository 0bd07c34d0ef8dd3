#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "posewright/blocks/block_array.hpp"
#include "posewright/blocks/parameter.hpp"

namespace posewright {

/// A parameter whose effect on every measurement equals a combination of kept ones (to `remainder` of its own effect).
struct Dependency {
  struct Term {
    int parameter;       ///< index of a kept parameter
    double coefficient;  ///< SI: effect of one unit of `dropped` = Σ coefficient · effect of one unit of `parameter`
  };
  int dropped = -1;
  std::vector<Term> terms;  ///< without negligible ones; empty: the parameter has no effect at all
  double remainder = 0.0;   ///< share of the column's norm that the terms do not explain
};

/// Structural identifiability of a set of columns over a sample of configurations.
struct Identifiability {
  int rank = 0;                          ///< columns kept
  Eigen::VectorXd singular_values;       ///< of G with columns in units of tolerance, descending
  std::vector<int> kept;                 ///< an irreducible subset, ascending
  std::vector<Dependency> dependencies;  ///< one per dropped column
};

struct IdentifiabilityOptions {
  /// A column counts as dependent when less than this share of its norm is outside the span of the kept ones. Exact
  /// dependencies leave 1e-12 and less; what leaves 1e-4 needs noise 10,000 times below the effect.
  double threshold = 1e-4;
  /// Tier of each column, smaller is kept first; empty = all equal.
  std::vector<int> tiers;
};

/// Rank-revealing QR with column pivoting (Golub & Van Loan, Matrix Computations, §5.4) on columns in units of their
/// tolerance: within a tier the column with the largest remaining norm is kept next, so of a dependent group the
/// parameters with the largest tolerance stay. Nearly equal norms (1e-6) go to the first in order.
/// @param sample      blocks over many configurations; uses all rows
/// @param parameters  labels of the columns
Identifiability identifiability(const BlockArray& sample, const std::vector<Parameter>& parameters,
                                const IdentifiabilityOptions& options = {});

/// Blocks in an order in which every one brings as many new independent rows as any left could, as long as one brings
/// some: combinations that few configurations determine, even if most of them are blind to a parameter (a compliance
/// that counts at one position only). Columns in units of tolerance.
std::vector<int> most_independent(const BlockArray& sample, const std::vector<Parameter>& parameters);

/// "az = −bz + 0.98·l" with units where they differ; the words of every report.
std::string describe(const Dependency& dependency, const std::vector<Parameter>& parameters);

}  // namespace posewright
