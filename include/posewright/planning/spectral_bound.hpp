#pragma once

#include <Eigen/Core>
#include <optional>

#include "posewright/blocks/block_array.hpp"
#include "posewright/criterion/information_function.hpp"
#include "posewright/support/monitor.hpp"

namespace posewright {

/// Upper bound for plans of exactly N of these candidates.
struct SpectralBound {
  double bound = 0.0;  ///< of Φ
  double gap = 0.0;    ///< what numbers of poses that need not be whole reach lies at most this much lower (ln σ)
};

/// Options of spectral_bound.
struct SpectralBoundOptions {
  int poses = 1;            ///< N
  int repeats = 1;          ///< how often a candidate may be chosen
  Eigen::MatrixXd prior{};  ///< M0 of the whole plan, m × m, in the blocks' coordinates; empty: none
  double tolerance = 1e-4;  ///< stop where the gap is no more
  int threads = 1;          ///< 0 = all
};

/// Bounds of eigenvalues that two criteria share: o4 has that of o3 and that of o2. Of the same blocks, scale, nuisance
/// columns and options.
struct EigenvalueBounds {
  struct Bound {
    double bound = 0.0;     ///< of λ_min or of λ_min/λ_max
    double attained = 0.0;  ///< by numbers of poses that need not be whole
  };
  std::optional<Bound> least{}, ratio{};  ///< none: not known yet
};

/// Bounds of o2, o3 and o4 (theory.md eq. (44), (45)). For any E, F ⪰ 0 of trace 1 and any N poses of information M,
///   λ_min(M) ≤ tr(E M) ≤ tr(E M0) + Σ of the N largest tr(J_i E J_iᵀ),
///   λ_min(M)/λ_max(M) ≤ t  if  tr(M0 (E − tF)) + Σ of the N largest tr(J_i (E − tF) J_iᵀ) ≤ 0;
/// o4 = o3 · o2 is bounded by the product. E and F come from an interior-point method on a working set; the pass over
/// all candidates is the proof, whatever the method did.
/// None for another Φ, and none for o2 with nuisance columns: λ_max of a Schur complement is no longer linear from
/// below in M (o4 is bounded by o3 then, o2 ≤ 1). A stop gives the bound so far, none before the first.
/// @param known  takes what is computed, and saves what it has; null: nothing is known
std::optional<SpectralBound> spectral_bound(const BlockArray& blocks, const InformationFunction& function,
                                            const SpectralBoundOptions& options, const Monitor& monitor,
                                            EigenvalueBounds* known = nullptr);

}  // namespace posewright
