#pragma once

#include "scenario_pool.hpp"

namespace posewright {

/// Weights on the pool's candidates that are good over the scenarios, from `start` on: multiplicative steps w_i ∝ w_i
/// Σ_k λ_k d_ik (Silvey, Titterington & Torsney 1978) with what is above the cap shared among the others. Any weights
/// give a valid bound; how good these are decides how near it is.
CandidateWeights robust_weights(const ScenarioFigures& figures, const RobustRequest& request, const ScenarioPool& pool,
                                const CandidateWeights& start, const Monitor& monitor);

}  // namespace posewright
