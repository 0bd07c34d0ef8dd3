#pragma once

#include <Eigen/Core>
#include <memory>

#include "posewright/criterion/criterion.hpp"
#include "posewright/criterion/criterion_data.hpp"
#include "posewright/criterion/information_function.hpp"

namespace posewright {

/// Φ = ln T, T = tr(Zᵀ S Z): the part of the effects outside the fitted columns (A, the leading ones), S = M_ff −
/// M_fa M_aa⁻¹ M_af the Schur complement of the trailing columns (f). T is the least sum of squared residuals that
/// fitting leaves of one effect, the expected one for several that are independent. It is concave and of degree one in
/// M, so degree() is 1. −∞ where the fitted columns are not determined or no residual is left. Atkinson & Fedorov
/// (1975), Biometrika 62(1), for T-optimality.
class DiscriminateFunction : public InformationFunction {
 public:
  /// @param fitted  number of leading columns
  /// @param mix     trailing columns × effects, in the coordinates of M
  DiscriminateFunction(int fitted, const Eigen::MatrixXd& mix);
  double value(const Eigen::MatrixXd& information) const override;
  Eigen::MatrixXd gradient(const Eigen::MatrixXd& information) const override;
  bool concave() const override { return true; }
  double degree() const override { return 1.0; }
  std::unique_ptr<Expansion> expand(const Eigen::MatrixXd& information) const override;
  int fitted() const { return fitted_; }
  /// Upper triangular, half halfᵀ = mix mixᵀ.
  const Eigen::MatrixXd& half() const { return half_; }

 private:
  int fitted_;
  Eigen::MatrixXd half_;
};

/// Φ = −ln φ, φ = tr(L M_aa⁻¹ Lᵀ) + ‖L M_aa⁻¹ M_af Z − b‖²: mean squared error by noise and by effects that are not
/// fitted. Not concave: more information may weigh the effects worse. Jones & Nachtsheim (2011), Technometrics 53(1),
/// for the minimal aliasing of a design.
class BiasFunction : public InformationFunction {
 public:
  /// @param rows    L, targets × fitted columns
  /// @param mix     Z, trailing columns × effects
  /// @param offset  b, targets × effects
  BiasFunction(const Eigen::MatrixXd& rows, Eigen::MatrixXd mix, const Eigen::MatrixXd& offset);
  double value(const Eigen::MatrixXd& information) const override;
  Eigen::MatrixXd gradient(const Eigen::MatrixXd& information) const override;
  bool concave() const override { return false; }
  const Eigen::MatrixXd& rows() const { return rows_; }
  const Eigen::MatrixXd& mix() const { return mix_; }
  const Eigen::MatrixXd& offset() const { return offset_; }

 private:
  Eigen::MatrixXd rows_, mix_, offset_;
};

/// `discriminate`, `bias`. Throw CannotDo if no effects are known.
std::unique_ptr<Criterion> make_discriminate_criterion(const CriterionData& data);
std::unique_ptr<Criterion> make_bias_criterion(const CriterionData& data);

}  // namespace posewright
