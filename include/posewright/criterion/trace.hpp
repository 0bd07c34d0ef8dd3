#pragma once

#include <memory>
#include <string>
#include <utility>

#include "posewright/criterion/criterion.hpp"
#include "posewright/criterion/criterion_data.hpp"
#include "posewright/criterion/information_function.hpp"

namespace posewright {

/// A of the criteria Φ = −ln tr(A M⁻¹ Aᵀ) in whitened coordinates (k × m).
/// `a`: the parameters of interest in units of `scale`; φ is the sum of their variances.
Eigen::MatrixXd variance_rows(const CriterionData& data);
/// False: every plan is as accurate at these points.
bool any_is_moved(const std::vector<TestPoint>& points);
/// `test_pose`: rows √(w_t/Σw) A_t; φ is the mean squared position error at the test points.
/// Throws CannotDo if there are no test points.
Eigen::MatrixXd test_point_rows(const CriterionData& data);

/// Φ = −ln φ, φ = tr(A M⁻¹ Aᵀ). 1/φ is concave and of degree one in M, so degree() is 1 and an efficiency is a ratio of
/// variances. S = V AᵀA V / φ with V = M⁻¹. A-optimality: Chernoff (1953); test poses: Wu, Klimchik et al. (2013).
class TraceFunction : public InformationFunction {
 public:
  explicit TraceFunction(Eigen::MatrixXd A) : A_(std::move(A)) {}
  double value(const Eigen::MatrixXd& information) const override;
  Eigen::MatrixXd gradient(const Eigen::MatrixXd& information) const override;
  bool concave() const override { return true; }
  double degree() const override { return 1.0; }
  std::unique_ptr<Expansion> expand(const Eigen::MatrixXd& information) const override;
  const Eigen::MatrixXd& A() const { return A_; }

 private:
  Eigen::MatrixXd A_;
};

/// Variant with exact rank-r swaps (src/criterion/trace_state.cpp). The logarithm makes gains independent of units.
class TraceCriterion : public Criterion {
 public:
  TraceCriterion(std::string name, Eigen::MatrixXd A) : name_(std::move(name)), function_(std::move(A)) {}
  std::string name() const override { return name_; }
  const InformationFunction& function() const override { return function_; }
  std::unique_ptr<DesignState> start(const CandidateView& view, std::vector<int> members) const override;

 private:
  std::string name_;
  TraceFunction function_;
};

/// `test_pose_max`: Φ = −ln max_t tr(A_t M⁻¹ A_tᵀ), concave. Throws CannotDo if there are no test points.
std::unique_ptr<Criterion> make_worst_test_point_criterion(const CriterionData& data);

}  // namespace posewright
