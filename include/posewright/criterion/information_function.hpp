#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>

#include "posewright/criterion/criterion.hpp"

namespace posewright {

/// Φ near one information matrix M, for a solver of optimal weights (planning/approximate_design.hpp).
class Expansion {
 public:
  virtual ~Expansion() = default;
  double value = 0.0;
  /// T, m × m upper triangular, T Tᵀ = S = ∂Φ/∂M: candidate i adds d_i = tr(J_i S J_iᵀ) = ‖J_i T‖² per unit of weight.
  Eigen::MatrixXd factor;
  /// H_ij = −D²Φ[J_iᵀJ_i, J_jᵀJ_j], positive semidefinite; `rows` stacks blocks of r rows, H is resized.
  virtual void curvature(const BlockArray::RowMatrix& rows, int r, Eigen::MatrixXd& H) const = 0;
  /// U with H = U Uᵀ, if Φ has one of at most `most` columns: a solver then need not factorise H. Else empty.
  virtual BlockArray::RowMatrix curvature_factor(const BlockArray::RowMatrix& /*rows*/, int /*r*/,
                                                 Eigen::Index /*most*/) const {
    return {};
  }
};

/// Φ(M₀ + JᵀJ) of one block J after the other.
class BlockFunction {
 public:
  virtual ~BlockFunction() = default;
  /// −∞ where the information is singular.
  virtual double value(const BlockArray::ConstMap& J) = 0;
};

/// Φ as a function of the information matrix M alone (m × m, whitened coordinates).
class InformationFunction {
 public:
  virtual ~InformationFunction() = default;
  /// −∞ where M is singular.
  virtual double value(const Eigen::MatrixXd& information) const = 0;
  /// S = ∂Φ/∂M, symmetric: Φ grows by tr(J S Jᵀ) per unit of weight on J. Only where value() is finite.
  virtual Eigen::MatrixXd gradient(const Eigen::MatrixXd& information) const = 0;
  /// True if Φ is concave: no swap then gains more than its derivative.
  virtual bool concave() const = 0;
  /// h of Φ(cM) = Φ(M) + h ln c where e^{Φ/h} is concave: then Φ(v) ≤ Φ(w) + h ln(Σ v_i d_i(w) / h) for all weights v,
  /// w, and exp((Φ − bound)/h) is an efficiency. 0: Φ has no such bound, and expand() must not be called.
  virtual double degree() const { return 0.0; }
  /// Null if M is singular.
  virtual std::unique_ptr<Expansion> expand(const Eigen::MatrixXd& information) const;
  /// This function of M₀ and one block more; may refer to this object.
  virtual std::unique_ptr<BlockFunction> with_block(const Eigen::MatrixXd& information) const;
};

/// T upper triangular with T Tᵀ = F Fᵀ, F m × k.
Eigen::MatrixXd upper_factor(const Eigen::MatrixXd& F);

/// Any Φ(M) as a criterion: candidates are screened by the derivative, the best few are evaluated exactly. For
/// criteria that have no cheap swap formula.
class FunctionCriterion : public Criterion {
 public:
  FunctionCriterion(std::string name, std::shared_ptr<const InformationFunction> function);
  std::string name() const override { return name_; }
  const InformationFunction& function() const override { return *function_; }
  std::unique_ptr<DesignState> start(const CandidateView& view, std::vector<int> members) const override;

 private:
  std::string name_;
  std::shared_ptr<const InformationFunction> function_;
};

}  // namespace posewright
