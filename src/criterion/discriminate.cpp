#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "effect_mix.hpp"
#include "posewright/criterion/effect_criteria.hpp"
#include "posewright/support/dense.hpp"
#include "product_curvature.hpp"
#include "regular.hpp"
#include "residual_state.hpp"

namespace posewright {
namespace {

// A residual that is this share of the effect is rounding: the plan has no reading over.
constexpr double no_residual = 1e-10;

/// T and what it hangs on at one M.
struct Residual {
  Eigen::LLT<Eigen::MatrixXd> factor;  // of M_aa
  double T = 0.0;
  bool left = false;  // whether M_aa is regular and T is not rounding

  Residual(const Eigen::MatrixXd& information, Eigen::Index fitted, const Eigen::MatrixXd& half)
      : factor(information.topLeftCorner(fitted, fitted)) {
    if (!is_regular(factor)) return;
    const Eigen::Index k = half.rows();
    const double whole =
        half.cwiseProduct(information.bottomRightCorner(k, k).selfadjointView<Eigen::Lower>() * half).sum();
    const Eigen::MatrixXd crossed = information.bottomLeftCorner(k, fitted).transpose() * half;
    T = whole - factor.matrixL().solve(crossed).squaredNorm();
    left = T > no_residual * whole;
  }

  /// F of ∂Φ/∂M = F Fᵀ: the effects less what the fitted columns take up of them, over √T.
  Eigen::MatrixXd directions(const Eigen::MatrixXd& information, const Eigen::MatrixXd& half) const {
    const Eigen::Index fitted = factor.rows(), k = half.rows();
    Eigen::MatrixXd F(fitted + k, k);
    F.topRows(fitted) = -factor.solve(information.bottomLeftCorner(k, fitted).transpose() * half);
    F.bottomRows(k) = half;
    return F / std::sqrt(T);
  }
};

class DiscriminateExpansion : public Expansion {
 public:
  DiscriminateExpansion(const Residual& residual, Eigen::MatrixXd directions) : directions_(std::move(directions)) {
    const Eigen::Index fitted = residual.factor.rows();
    inverse_ = residual.factor.matrixL().solve(Eigen::MatrixXd::Identity(fitted, fitted)).transpose();
    value = std::log(residual.T);
    factor = upper_factor(directions_);
  }

  /// (2/T) tr(Y Bᵀ X_i V X_j B) + d_i d_j with X = JᵀJ, V the inverse of M_aa, zero elsewhere.
  void curvature(const BlockArray::RowMatrix& rows, int r, Eigen::MatrixXd& H) const override {
    const Eigen::VectorXd d = product_curvature(rows.leftCols(inverse_.rows()) * inverse_, rows * directions_, r, H);
    H.noalias() += d * d.transpose();
  }

 private:
  Eigen::MatrixXd directions_, inverse_;  // inverse_: L⁻ᵀ
};

}  // namespace

DiscriminateFunction::DiscriminateFunction(int fitted, const Eigen::MatrixXd& mix)
    : fitted_(fitted), half_(upper_factor(mix)) {}

double DiscriminateFunction::value(const Eigen::MatrixXd& information) const {
  const Residual residual(information, fitted_, half_);
  return residual.left ? std::log(residual.T) : -infinity;
}

Eigen::MatrixXd DiscriminateFunction::gradient(const Eigen::MatrixXd& information) const {
  const Eigen::MatrixXd F = Residual(information, fitted_, half_).directions(information, half_);
  return F * F.transpose();
}

std::unique_ptr<Expansion> DiscriminateFunction::expand(const Eigen::MatrixXd& information) const {
  const Residual residual(information, fitted_, half_);
  if (!residual.left) return nullptr;
  return std::make_unique<DiscriminateExpansion>(residual, residual.directions(information, half_));
}

namespace {

class DiscriminateCriterion : public Criterion {
 public:
  explicit DiscriminateCriterion(const CriterionData& data)
      : function_(
            std::make_shared<DiscriminateFunction>(int(data.R.cols()) - data.effects.columns, whitened_mix(data))) {}
  std::string name() const override { return "discriminate"; }
  const InformationFunction& function() const override { return *function_; }
  std::unique_ptr<DesignState> start(const CandidateView& view, std::vector<int> members) const override {
    return start_residual(view, std::move(members), function_);
  }

 private:
  std::shared_ptr<const DiscriminateFunction> function_;
};

}  // namespace

std::unique_ptr<Criterion> make_discriminate_criterion(const CriterionData& data) {
  require_effects(data);
  return std::make_unique<DiscriminateCriterion>(data);
}

}  // namespace posewright
