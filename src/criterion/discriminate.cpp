#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "by_bound.hpp"
#include "effect_mix.hpp"
#include "posewright/criterion/criterion.hpp"
#include "posewright/criterion/effect_criteria.hpp"
#include "posewright/support/dense.hpp"
#include "product_curvature.hpp"
#include "recomputed_state.hpp"
#include "regular.hpp"

namespace posewright {
namespace {

// Pivots of a swap below which rounding is amplified too much: from scratch then.
constexpr double safe_pivot = 1e-4;

/// Exact changes of T, the least sum of squares that fitting leaves of the effects. With Θ the fit, e_j = F_j + A_j Θ
/// the residuals at candidate j (A fitted columns, F effects), V = M_aa⁻¹, D_j = A_j V A_jᵀ and C = A_j V A_kᵀ:
///   adding j:          T rises by ‖L⁻¹ e_j‖², L Lᵀ = I + D_j,
///   then removing k:   T falls by tr(eᵀ H⁻¹ e), e = e_k − Cᵀ (I + D_j)⁻¹ e_j, H = I − D_k + Cᵀ (I + D_j)⁻¹ C
/// (theory.md eq. (47); Björck 1996, 3.1). Added first, so that nobody is indispensable. T is concave in M, so a
/// swap gains no more than ‖e_j‖² − ‖e_k‖².
class ResidualState : public RecomputedState {
 public:
  ResidualState(const CandidateView& view, std::vector<int> members,
                std::shared_ptr<const DiscriminateFunction> function)
      : RecomputedState(view, std::move(members), *function),
        shared_(std::move(function)),
        function_(*shared_),
        fitted_(function_.fitted()),
        half_(function_.half()) {
    refresh();
  }

  double value() const override { return singular() ? -infinity : std::log(T_); }
  double loss(int position) const override { return squares_[members()[std::size_t(position)]] / T_; }

  Swap best_addition() override { return best_of(-1, -infinity); }

 private:
  Swap do_best_swap(int position, double min_gain) override {
    return best_of(members()[std::size_t(position)], min_gain);
  }

  /// V, Θ, T and the residuals of all candidates.
  void update() override {
    const Eigen::Index a = fitted_, k = half_.rows();
    const Eigen::LLT<Eigen::MatrixXd> factor(information().topLeftCorner(a, a));
    V_ = factor.solve(Eigen::MatrixXd::Identity(a, a));
    const Eigen::MatrixXd crossed = information().bottomLeftCorner(k, a).transpose() * half_;
    BlockArray::RowMatrix directions(a + k, k);
    directions.topRows(a) = -factor.solve(crossed);
    directions.bottomRows(k) = half_;
    T_ = half_.cwiseProduct(information().bottomRightCorner(k, k).selfadjointView<Eigen::Lower>() * half_).sum() -
         factor.matrixL().solve(crossed).squaredNorm();
    residuals_.noalias() = blocks().all() * directions;
    const Eigen::Index r = blocks().rows();
    squares_.resize(Eigen::Index(blocks().count()));
    for (Eigen::Index j = 0; j < squares_.size(); ++j) squares_[j] = residuals_.middleRows(j * r, r).squaredNorm();
  }

  auto residual(int j) const { return residuals_.middleRows(Eigen::Index(j) * blocks().rows(), blocks().rows()); }
  auto own(int j) const { return blocks().block(std::size_t(j)).leftCols(fitted_); }

  Swap best_of(int k, double min_gain) {
    const double before = k < 0 ? 0.0 : squares_[k];
    double wanted = T_ * std::expm1(min_gain);
    queue_.clear();
    for (int j = 0; j < int(blocks().count()); ++j)
      if (blocked()[std::size_t(j)] == 0 && squares_[j] - before > wanted) queue_.add(squares_[j] - before, j);
    if (queue_.empty()) return {};
    queue_.order();
    if (k >= 0) leave(k);
    Swap best{-1, min_gain};
    while (!queue_.empty()) {
      const auto [bound, j] = queue_.next();
      if (bound <= wanted) break;
      const double rise = k < 0 ? added(j) : swapped(k, j);
      if (rise <= wanted || !(rise > -T_)) continue;
      const double gain = std::log1p(rise / T_);
      if (!(gain > best.gain)) continue;
      best = {j, gain};
      wanted = rise;
    }
    return best.enter < 0 ? Swap{} : best;
  }

  void leave(int k) {
    towards_.noalias() = V_ * own(k).transpose();
    left_.noalias() = -own(k) * towards_;
    left_.diagonal().array() += 1.0;
  }

  /// Factor of I + D_j; solved_ becomes L⁻¹ e_j.
  double added(int j) {
    projected_.noalias() = own(j) * V_;
    S_.noalias() = projected_ * own(j).transpose();
    S_.diagonal().array() += 1.0;
    factor_.compute(S_);
    solved_ = residual(j);
    factor_.matrixL().solveInPlace(solved_);
    return solved_.squaredNorm();
  }

  double swapped(int k, int j) {
    const double rise = added(j);
    C_.noalias() = own(j) * towards_;
    factor_.matrixL().solveInPlace(C_);
    S_ = left_;
    S_.noalias() += C_.transpose() * C_;
    factor_.compute(S_);
    if (factor_.info() != Eigen::Success || !(factor_.matrixLLT().diagonal().minCoeff() > safe_pivot))
      return from_scratch(k, j);
    error_ = residual(k);
    error_.noalias() -= C_.transpose() * solved_;
    factor_.matrixL().solveInPlace(error_);
    return rise - error_.squaredNorm();
  }

  /// −∞ where the fitted columns would not be determined.
  double from_scratch(int k, int j) const {
    const double phi = value_of_swap(k, j);
    return std::isfinite(phi) ? std::exp(phi) - T_ : -infinity;
  }

  std::shared_ptr<const DiscriminateFunction> shared_;  // a state may outlive its criterion
  const DiscriminateFunction& function_;
  Eigen::Index fitted_;
  const Eigen::MatrixXd& half_;
  Eigen::MatrixXd V_;
  BlockArray::RowMatrix residuals_;  // of all candidates, r rows each
  Eigen::VectorXd squares_;
  double T_ = 0.0;
  ByBound queue_;
  Eigen::MatrixXd towards_, left_, projected_, S_, C_, solved_, error_;  // V A_kᵀ, I − D_k, …
  Eigen::LLT<Eigen::MatrixXd> factor_;
};

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
    return std::make_unique<ResidualState>(view, std::move(members), function_);
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
