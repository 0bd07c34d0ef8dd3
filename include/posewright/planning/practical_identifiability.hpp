#pragma once

#include <Eigen/Core>
#include <vector>

#include "posewright/blocks/identifiability.hpp"
#include "posewright/support/monitor.hpp"

namespace posewright {

/// Best σ of N poses, compared with the prior knowledge (theory.md eq. (31)).
struct PracticalIdentifiability {
  int poses = 0;
  /// 1σ of every parameter after N poses spread as the D-optimal weights say, SI. A plan of N whole poses comes near.
  Eigen::VectorXd sigma;
  /// Share of each parameter's effect that the others together do not explain, √(1 − R²) = 1/√(M_jj (M⁻¹)_jj) in (0,
  /// 1].
  Eigen::VectorXd unexplained;
  /// Parameters of which less than `near_share` is their own, smallest first, with the combination they resemble,
  /// its terms by the size of their effect.
  std::vector<Dependency> near;
  /// Indices of the parameters to identify: of those that are told less than their tolerance says already, the worst is
  /// fixed, then the rest is judged again, until every one left is worth it. Nuisance parameters always stay.
  std::vector<int> recommended;
};

/// @param pool        raw blocks of many configurations, columns independent (see identifiability())
/// @param poses       N
/// @param near_share  e.g. 0.1: nine tenths of an effect look like other parameters'
/// Throws CannotDo if the pool leaves the information singular.
PracticalIdentifiability practical_identifiability(const BlockArray& pool, const std::vector<Parameter>& parameters,
                                                   int poses, double near_share, const Monitor& monitor);

}  // namespace posewright
