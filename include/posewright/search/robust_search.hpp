#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "posewright/blocks/block_array.hpp"
#include "posewright/criterion/spacing.hpp"
#include "posewright/planning/design_task.hpp"
#include "posewright/support/monitor.hpp"
#include "posewright/support/repeats.hpp"
#include "posewright/support/robust_aim.hpp"

namespace posewright {

/// One list of candidates as several scenarios see it (robots drawn from the tolerances), and a plan of some of them.
struct RobustRequest {
  RobustAim aim;
  int scenarios = 0;  ///< ≥ 1
  int poses = 0, nuisance = 0;
  Repeats repeats;
  std::optional<Spacing> spacing;  ///< with a point for each candidate; none: no minimum distance
  PlannerOptions planner;
  std::vector<int> plan;  ///< the nominal plan, by index
  BlockArray nominal;     ///< raw blocks of all candidates at nominal parameters
  Eigen::MatrixXd prior;  ///< raw information that is there before; empty: none
  /// Raw blocks of scenario k for the candidates `which` (empty: all); all zero where nothing can be measured. Called
  /// from several threads.
  std::function<BlockArray(int scenario, const std::vector<int>& which)> blocks;
  /// Scenarios of the prior information; empty where `prior` is.
  std::function<Eigen::MatrixXd(int scenario)> prior_of;
};

/// Efficiency of a plan in every scenario.
struct RobustFigures {
  std::vector<double> efficiency;  ///< e_k: exp((log det − reference_k) / interest parameters), in (0, 1]; 0: singular
  double combined = 0.0;           ///< exp of combined(aim, ln e): a geometric mean, the least, that of the worst
};

struct RobustResult {
  std::vector<double> references;  ///< log det (raw) that no plan of as many poses exceeds in scenario k
  RobustFigures nominal;           ///< of the plan that was given
  RobustFigures robust;            ///< of the one that was found; no less by the aim
  double bound = 1.0;              ///< combined efficiency that no plan of as many of these candidates exceeds
  std::vector<int> plan;           ///< ascending
  long unreached = 0;              ///< pairs of scenario and candidate where nothing can be measured
  long exchanges = 0;
  bool stopped = false;  ///< before all was done: `plan` is the best so far, and with no scenario known the given one
};

/// Efficiency of the given plan; `robust` and `plan` repeat it.
RobustResult judge_robust(const RobustRequest& request, const Monitor& monitor);

/// Judges, then searches for the plan that is best over all scenarios: by exchange from the plan given among the
/// candidates of largest sensitivity, first over a few scenarios that stand for all (for the mean by kernel herding on
/// their sensitivities: Welling 2009; else the worst), then over all.
///
/// The bound: with weights w that are best at nominal parameters and λ supporting the aim, F(v) ≤ Σ λ_k ln e_k(v) ≤
/// Σ λ_k ln e_k(w) + ln(Σ_i v_i Σ_k λ_k d_ik / s) for all feasible v, because each e_k is concave and of degree one.
RobustResult search_robust(const RobustRequest& request, const Monitor& monitor);

}  // namespace posewright
