#include "posewright/criterion/determinant.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "determinant_nuisance.hpp"
#include "kernels/kernels.hpp"
#include "posewright/criterion/inverse_information.hpp"

namespace posewright {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
// In whitened coordinates an average pose adds the identity, so this is a thousandth of a pose.
constexpr double start_ridge = 1e-3;
// Removing a block that carries (almost) all information about some direction: 1 − λmax(D_k) below this.
constexpr double indispensable = 1e-8;
constexpr int refresh_after = 40;

double log_det_positive(const Eigen::MatrixXd& a, Eigen::LLT<Eigen::MatrixXd>& factor) {
  factor.compute(a);
  if (factor.info() != Eigen::Success) return -infinity;
  return 2 * factor.matrixLLT().diagonal().array().log().sum();
}

double power(double base, int exponent) {
  double result = 1;
  for (; exponent > 0; exponent >>= 1, base *= base)
    if (exponent & 1) result *= base;
  return result;
}

/// The part of a swap that depends on the leaving block k alone, and the gain of any entering block j:
///   ln det(M − J_kᵀJ_k + J_jᵀJ_j) − ln det M = ln det(I − D_k) + ln det(I + D_j + C (I − D_k)⁻¹ Cᵀ),  C = J_j V J_kᵀ,
/// or, where I − D_k is singular, = ln det(I + D_j) + ln det(I − D_k + Cᵀ (I + D_j)⁻¹ C).
class SwapGain {
 public:
  SwapGain(InverseInformation& inverse, int rows)
      : inverse_(inverse),
        rows_(rows),
        d_k_(rows, rows),
        c_(rows, rows),
        d_j_(rows, rows),
        b_(rows, rows),
        work_(rows, rows) {}

  void leave(int k) {
    inverse_.project(k, y_);
    inverse_.cross(k, y_, d_k_);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(d_k_);
    slack_ = 1 - eigen.eigenvalues().maxCoeff();
    regular_ = slack_ > indispensable;
    if (!regular_) return;
    const Eigen::VectorXd rest = 1 - eigen.eigenvalues().array();
    leave_log_det_ = rest.array().log().sum();
    b_ = eigen.eigenvectors() * rest.cwiseInverse().asDiagonal() * eigen.eigenvectors().transpose();
  }

  /// ln det(I + D_j).
  double addition(int j) {
    inverse_.own(j, d_j_);
    d_j_.diagonal().array() += 1;
    return log_det_positive(d_j_, factor_);
  }
  /// ln det(I − D_k); −∞ where k is indispensable.
  double removal(int k) {
    inverse_.own(k, d_j_);
    d_j_ = -d_j_;
    d_j_.diagonal().array() += 1;
    const double change = log_det_positive(d_j_, factor_);
    return change < rows_ * std::log(indispensable) ? -infinity : change;
  }

  /// exp(gain) is at most this, from tr D_j alone: D_j + C (I − D_k)⁻¹ Cᵀ ≼ D_j/(1 − λmax), and the geometric mean of
  /// eigenvalues is at most the arithmetic; also at most det(I + D_j) since the swap cannot beat adding without
  /// leaving.
  double ratio_bound(double trace_j) const {
    const double added = power(1 + trace_j / rows_, rows_);
    if (!regular_) return added;
    return std::min(added, std::exp(leave_log_det_) * power(1 + trace_j / (rows_ * slack_), rows_));
  }
  /// Sharper bound with the cross terms known.
  double bound_with_cross(int j, double trace_j) {
    inverse_.cross(j, y_, c_);
    if (!regular_) return infinity;
    work_.noalias() = c_ * b_;
    return leave_log_det_ + rows_ * std::log1p((trace_j + work_.cwiseProduct(c_).sum()) / rows_);
  }
  /// Exact gain; call bound_with_cross(j) first.
  double exact(int j) {
    inverse_.own(j, d_j_);
    if (regular_) {
      work_.noalias() = c_ * b_ * c_.transpose();
      work_ += d_j_;
      work_.diagonal().array() += 1;
      return leave_log_det_ + log_det_positive(work_, factor_);
    }
    d_j_.diagonal().array() += 1;
    const double added = log_det_positive(d_j_, factor_);
    work_ = c_;
    factor_.matrixL().solveInPlace(work_);
    d_j_.noalias() = work_.transpose() * work_ - d_k_;
    d_j_.diagonal().array() += 1;
    return added + log_det_positive(d_j_, factor_);
  }

 private:
  InverseInformation& inverse_;
  int rows_;
  std::vector<double> y_;
  Eigen::MatrixXd d_k_, c_, d_j_, b_, work_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
  double slack_ = 0, leave_log_det_ = 0;
  bool regular_ = true;
};

/// Without nuisance columns: running inverse, cached traces, pruned scans.
class DeterminantState : public DesignState {
 public:
  DeterminantState(const CandidateView& view, std::vector<int> members)
      : DesignState(view, std::move(members)),
        inverse_(*view.blocks, view.blocks->columns(), view.prior),
        gain_(inverse_, view.blocks->rows()) {
    refresh();
  }

  double value() const override { return singular_ ? -infinity : inverse_.log_det(); }

  double loss(int position) const override { return inverse_.trace(members()[std::size_t(position)]); }

  Swap best_addition() override {
    Swap best{-1, -infinity};
    const int n = static_cast<int>(blocks().count()), r = blocks().rows();
    double ratio = 0;
    for (int j = 0; j < n; ++j) {
      if (blocked()[std::size_t(j)] != 0 || power(1 + inverse_.trace(j) / r, r) <= ratio) continue;
      const double gain = gain_.addition(j);
      if (gain > best.gain) {
        best = {j, gain};
        ratio = std::exp(gain);
      }
    }
    return best;
  }

  double removal(int position) override { return gain_.removal(members()[std::size_t(position)]); }

  bool refresh() override {
    since_refresh_ = 0;
    singular_ = !inverse_.refresh(members(), 0.0);
    if (singular_) inverse_.refresh(members(), start_ridge);
    return !singular_;
  }

 private:
  Swap do_best_swap(int position, double min_gain) override {
    const int k = members()[std::size_t(position)];
    return blocks().rows() == 1 ? best_row(k, min_gain) : best_block(k, min_gain);
  }

  void do_change(int leave, int enter) override {
    // A ridge is for starts; every change may be the one that makes it needless.
    if (singular_ || !inverse_.change(leave, enter) || ++since_refresh_ >= refresh_after) refresh();
  }

  Swap best_row(int k, double min_gain) {
    inverse_.project(k, y_);
    double best = std::expm1(min_gain);
    const long j = kernels().scan_rows(blocks().data(), blocks().count(), blocks().stride(), y_.data(),
                                       inverse_.traces().data(), inverse_.trace(k), blocked().data(), &best);
    return j < 0 ? Swap{} : Swap{static_cast<int>(j), std::log1p(best)};
  }

  Swap best_block(int k, double min_gain) {
    gain_.leave(k);
    Swap best{-1, min_gain};
    double ratio = std::exp(min_gain);
    const int n = static_cast<int>(blocks().count());
    for (int j = 0; j < n; ++j) {
      const double d = inverse_.trace(j);
      // log det is concave: no swap gains more than its derivative promises.
      if (d - inverse_.trace(k) <= best.gain || blocked()[std::size_t(j)] != 0) continue;
      if (gain_.ratio_bound(d) <= ratio || gain_.bound_with_cross(j, d) <= best.gain) continue;
      const double gain = gain_.exact(j);
      if (gain > best.gain) {
        best = {j, gain};
        ratio = std::exp(gain);
      }
    }
    return best.enter < 0 ? Swap{} : best;
  }

  InverseInformation inverse_;
  SwapGain gain_;
  std::vector<double> y_;
  int since_refresh_ = 0;
  bool singular_ = false;
};

}  // namespace

std::unique_ptr<DesignState> DeterminantCriterion::start(const CandidateView& view, std::vector<int> members) const {
  if (view.nuisance > 0) return start_with_nuisance(view, std::move(members));
  return std::make_unique<DeterminantState>(view, std::move(members));
}

}  // namespace posewright
