#pragma once

#include "posewright/criterion/information_function.hpp"
#include "posewright/planning/approximate_design.hpp"

namespace posewright {

/// The bound over candidates and a few more blocks, from the optimal weights over the candidates: weights are solved on
/// those of large sensitivity and the new ones, one pass over all gives the proof, violators enter, until the ratio is
/// within `options.tolerance` or after a few rounds (the bound is valid all the same).
/// @param design  optimal weights on `candidates`, with their sensitivities
/// @return        support, weights and sensitivity are those of the pool, not of the candidates; use bound, value,
/// factor
ApproximateDesign extended_bound(const BlockArray& candidates, const ApproximateDesign& design, const BlockArray& more,
                                 const InformationFunction& function, const ApproximateDesignOptions& options,
                                 const Monitor& monitor);

}  // namespace posewright
