#pragma once

#include "posewright/criterion/criterion.hpp"
#include "posewright/criterion/criterion_data.hpp"
#include "posewright/criterion/information_function.hpp"

namespace posewright {

/// L of the criteria Φ = −ln tr(L M⁻¹) in whitened coordinates, symmetric positive semidefinite (m × m).
/// `a`: the variances of the parameters of interest in units of `scale`, L = Σ e_j e_jᵀ.
Eigen::MatrixXd variance_weights(const CriterionData& data);
/// `test_pose`: the mean squared position error at the test points, L = Σ_t w_t A_tᵀA_t / Σ w_t.
/// Throws CannotDo where there are no test points.
Eigen::MatrixXd test_point_weights(const CriterionData& data);

/// Φ = −ln φ, φ = tr(L M⁻¹), with exact rank-r swaps: with V = M⁻¹, B = V L V, U = [J_enter; J_leave] and S = diag(I,
/// −I),
///   φ(now) − φ(after) = tr((S + U V Uᵀ)⁻¹ U B Uᵀ)   (Sherman–Morrison–Woodbury).
/// 1/φ is concave in M, so Φ is, and candidates are skipped without loss where (tr J_j B J_jᵀ − tr J_k B J_kᵀ)/φ is
/// below the best found. The logarithm makes gains independent of units. A-optimality: Chernoff (1953); test poses: Wu,
/// Klimchik et al. (2013).
class TraceCriterion : public Criterion {
 public:
  TraceCriterion(std::string name, Eigen::MatrixXd L);
  std::string name() const override { return name_; }
  std::unique_ptr<DesignState> start(const CandidateView& view, std::vector<int> members) const override;

 private:
  std::string name_;
  Eigen::MatrixXd L_;
};

/// `test_pose_max`: Φ = −ln max_t tr(A_t M⁻¹ A_tᵀ), concave. Throws CannotDo where there are no test points.
std::unique_ptr<Criterion> make_worst_test_point_criterion(const CriterionData& data);

}  // namespace posewright
