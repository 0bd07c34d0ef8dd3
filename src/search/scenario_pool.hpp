#pragma once

#include <memory>
#include <vector>

#include "posewright/criterion/scenarios.hpp"
#include "scenario_figures.hpp"

namespace posewright {

/// The candidates that a plan over scenarios is sought among, with their whitened blocks in every scenario.
class ScenarioPool {
 public:
  /// The plan given, the candidates with weight, and those of largest sensitivity to the scenarios that count where
  /// the parts of the aim are `values`. All named must outlive it.
  ScenarioPool(const ScenarioFigures& figures, const RobustRequest& request, const std::vector<double>& values,
               const CandidateWeights& weighted);

  /// Ascending.
  const std::vector<int>& candidates() const { return candidates_; }
  std::vector<int> in_pool(const std::vector<int>& members) const;
  /// One weight for each candidate of the pool.
  std::vector<double> in_pool(const CandidateWeights& weights) const;
  /// At nominal parameters.
  CandidateView view() const;
  const BlockArray& blocks(std::size_t scenario) const { return *blocks_[scenario]; }
  const Eigen::MatrixXd& prior(std::size_t scenario) const { return priors_[scenario]; }
  ScenarioCriterion criterion(const std::vector<int>& scenarios) const;
  /// ln e in every scenario, from a fresh sum of the blocks.
  std::vector<double> values_of(const std::vector<int>& members) const;
  /// As many as a plan has, of largest weight, at the minimum distance; in the pool's numbers. Empty if too few fit.
  std::vector<int> heaviest(const CandidateWeights& weights) const;

 private:
  const ScenarioFigures& figures_;
  const RobustRequest& request_;
  std::vector<int> candidates_;
  BlockArray nominal_;
  Spacing spacing_;
  std::vector<std::shared_ptr<const BlockArray>> blocks_;
  std::vector<Eigen::MatrixXd> priors_;
};

/// Few scenarios that stand for all while many plans are tried, ascending: for the mean those whose mean sensitivities
/// among the candidates are nearest to that of all (kernel herding: Welling 2009); else the worst at `values`, beside
/// those that were looked at before.
std::vector<int> representatives(const ScenarioFigures& figures, const RobustAim& aim,
                                 const std::vector<int>& candidates, const std::vector<double>& values,
                                 const std::vector<int>& before);

}  // namespace posewright
