#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "posewright/criterion/criterion.hpp"
#include "posewright/criterion/determinant.hpp"
#include "posewright/support/robust_aim.hpp"

namespace posewright {

/// The candidates as they would be if the parameters had other values: same columns, other blocks.
struct Scenario {
  std::shared_ptr<const BlockArray> blocks;  ///< one for each candidate of the view; all zero: tells nothing there
  int nuisance = 0;                          ///< leading columns
  double weight = 1.0;                       ///< > 0
  double reference = 0.0;                    ///< log det of the interest information that counts as efficiency 1
  Eigen::MatrixXd prior{};                   ///< information that is there before; empty: none
};

/// Φ = combined(aim, ln e_k): of one plan over several scenarios, ln e_k = (log det of the interest information in
/// scenario k − reference_k) / (number of interest parameters), nuisance parameters eliminated (Chaloner & Larntz 1989
/// for the mean). Concave in the weights of the candidates, of degree one. Swaps are exact: each scenario's by its own
/// determinant formula (LeaveOneOut).
class ScenarioCriterion : public Criterion {
 public:
  /// @param whole  weight of all scenarios that there are, where these are the worst of them
  ScenarioCriterion(std::vector<Scenario> scenarios, const RobustAim& aim, double whole);
  std::string name() const override { return "robust"; }
  /// Information of the view's own blocks: Φ is no function of it.
  const InformationFunction& function() const override { return function_; }
  bool of_information_alone() const override { return false; }
  std::unique_ptr<DesignState> start(const CandidateView& view, std::vector<int> members) const override;

 private:
  std::vector<Scenario> scenarios_;
  LogDetFunction function_;
  RobustAim aim_;
  double whole_;
};

}  // namespace posewright
