#pragma once

#include "posewright/criterion/information_function.hpp"
#include "posewright/criterion/spacing.hpp"
#include "posewright/planning/approximate_design.hpp"

namespace posewright {

/// A plan of so many of the blocks, for its bound.
struct LimitedChoice {
  const BlockArray& blocks;
  const Spacing& spacing;      ///< with points and limits `most` for the blocks; distances are not counted
  int poses = 0, repeats = 1;  ///< how many are chosen, and how often one of them at most
  Eigen::MatrixXd prior{};     ///< information known before, divided by `poses`; empty: none
};

/// Upper bound of Φ over all plans that keep the limits. Weights that keep them are improved by multiplication with
/// the sensitivities d_i; each pass over all blocks is a proof: no plan within the limits has a larger Σ d_i than the
/// largest d_i that the limits allow (the limits are a partition, so taking the largest first is best), and
/// Φ ≤ Φ(w) + h ln(Σ d_i / (N h)) + h ln N. Valid whenever it ends.
/// @param function  of positive degree h
/// @param start     weights without the limits
double limited_bound(const LimitedChoice& choice, const InformationFunction& function, const ApproximateDesign& start,
                     int threads, const Monitor& monitor);

}  // namespace posewright
