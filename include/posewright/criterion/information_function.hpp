#pragma once

#include <memory>
#include <string>

#include "posewright/criterion/criterion.hpp"

namespace posewright {

/// Φ as a function of the information matrix M alone (m × m, whitened coordinates).
class InformationFunction {
 public:
  virtual ~InformationFunction() = default;
  /// −∞ where M is singular.
  virtual double value(const Eigen::MatrixXd& information) const = 0;
  /// S = ∂Φ/∂M, symmetric: Φ grows by tr(J S Jᵀ) per unit of weight on J. Only where value() is finite.
  virtual Eigen::MatrixXd gradient(const Eigen::MatrixXd& information) const = 0;
  /// Whether Φ is concave: no swap then gains more than its derivative promises.
  virtual bool concave() const = 0;
};

/// Any Φ(M) as a criterion: candidates are screened by the derivative, the best few are evaluated exactly. For
/// criteria that have no cheap swap formula.
class FunctionCriterion : public Criterion {
 public:
  FunctionCriterion(std::string name, std::shared_ptr<const InformationFunction> function);
  std::string name() const override { return name_; }
  std::unique_ptr<DesignState> start(const CandidateView& view, std::vector<int> members) const override;

 private:
  std::string name_;
  std::shared_ptr<const InformationFunction> function_;
};

}  // namespace posewright
