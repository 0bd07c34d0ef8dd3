#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "effect_mix.hpp"
#include "gram.hpp"
#include "kernels/kernels.hpp"
#include "posewright/criterion/criterion.hpp"
#include "posewright/criterion/effect_criteria.hpp"
#include "posewright/support/dense.hpp"
#include "recomputed_state.hpp"
#include "regular.hpp"

namespace posewright {
namespace {

using Square = Eigen::MatrixXd;

// Candidates, by what adding them gives, among which a swap is looked for before all others are tried.
constexpr std::size_t looked_at_first = 64;
// Pivots of a swap below which rounding is amplified too much: from scratch then.
constexpr double safe_bias_pivot = 1e-4;
// Candidates in one pass over rows.
constexpr std::size_t rows_chunk = 64;

/// Products of the rows of two candidates i and j that changes of φ are made of. With Θ the fit of the effects, V =
/// M_aa⁻¹, B = V LᵀL V, e = F Z − A Θ the effects' residuals at a candidate and g = A V Lᵀ E:
struct Products {
  Square D, T, K, H;  ///< A_i V A_jᵀ, A_i B A_jᵀ, e_i e_jᵀ, e_i g_jᵀ
};

/// Exact changes of φ = tr(L V Lᵀ) + ‖E‖², E = L Θ − b. Rows Ã that come in with sign Σ (one that leaves: −1) give,
/// with S = Σ + Ã V Ãᵀ and Θ' = Θ + V Ãᵀ S⁻¹ ẽ,
///   Δφ = −tr(S⁻¹ T) + 2 tr(S⁻¹ ẽ g̃ᵀ) + tr(S⁻¹ T S⁻¹ ẽ ẽᵀ),   T = Ã B Ãᵀ
/// (theory.md eq. (64); Woodbury). Not concave, so nothing bounds a swap: candidates that give most when added are
/// tried first, and all others where none of those gains.
class BiasState : public RecomputedState {
 public:
  BiasState(const CandidateView& view, std::vector<int> members, std::shared_ptr<const BiasFunction> function)
      : RecomputedState(view, std::move(members), *function),
        shared_(std::move(function)),
        function_(*shared_),
        fitted_(function_.rows().cols()),
        rows_(view.blocks->rows()),
        vectors_(padded_rows(5 * rows_, view.blocks->stride())),
        crossed_(rows_, 5 * rows_) {
    refresh();
  }

  double value() const override { return singular() ? -infinity : -std::log(error_); }
  double loss(int position) const override {
    const Products& k = own_[std::size_t(members()[std::size_t(position)])];
    return k.T.trace() - 2 * k.H.trace();
  }

  Swap best_addition() override {
    Swap best{-1, -infinity};
    for (const int j : order_)
      if (blocked()[std::size_t(j)] == 0) {
        best = {j, gain_of(added_[std::size_t(j)])};
        break;
      }
    return best;
  }

 private:
  Swap do_best_swap(int position, double min_gain) override {
    const int k = members()[std::size_t(position)];
    leave(k);
    Swap best{-1, min_gain};
    std::size_t tried = 0;
    for (const int j : order_) {
      if (blocked()[std::size_t(j)] != 0) continue;
      if (tried++ == looked_at_first && best.enter >= 0) break;
      const double gain = gain_of(swapped(k, j));
      if (gain > best.gain) best = {j, gain};
    }
    return best.enter < 0 ? Swap{} : best;
  }

  double gain_of(double change) const { return change > -error_ ? -std::log1p(change / error_) : -infinity; }

  /// φ, what its changes hang on, and every candidate's own products.
  void update() override {
    const Eigen::Index a = fitted_, k = function_.mix().rows();
    const Eigen::MatrixXd& L = function_.rows();
    const Eigen::LLT<Eigen::MatrixXd> factor(information().topLeftCorner(a, a));
    V_ = factor.solve(Eigen::MatrixXd::Identity(a, a));
    const Eigen::MatrixXd spread = V_ * L.transpose();
    const Eigen::MatrixXd fit = V_ * (information().topRightCorner(a, k) * function_.mix());
    const Eigen::MatrixXd error = L * fit - function_.offset();
    error_ = L.transpose().cwiseProduct(spread).sum() + error.squaredNorm();
    B_ = spread * spread.transpose();
    pull_ = spread * error;
    residual_.resize(a + k, fit.cols());
    residual_ << -fit, function_.mix();
    multiply_rows();
    order_by_addition();
  }

  void multiply_rows() {
    own_.resize(blocks().count());
    added_.resize(blocks().count());
    const Eigen::Index a = fitted_, r = rows_;
    BlockArray::RowMatrix AV, AB, e, g;
    for (std::size_t first = 0; first < own_.size(); first += rows_chunk) {
      const std::size_t count = std::min(rows_chunk, own_.size() - first);
      const auto rows = blocks().all().middleRows(Eigen::Index(first) * r, Eigen::Index(count) * r);
      AV.noalias() = rows.leftCols(a) * V_;
      AB.noalias() = rows.leftCols(a) * B_;
      e.noalias() = rows * residual_;
      g.noalias() = rows.leftCols(a) * pull_;
      for (std::size_t i = 0; i < count; ++i) {
        const Eigen::Index at = Eigen::Index(i) * r;
        const auto A = rows.block(at, 0, r, a);
        const auto own_e = e.middleRows(at, r);
        Products& own = own_[first + i];
        own.D.noalias() = AV.middleRows(at, r) * A.transpose();
        own.T.noalias() = AB.middleRows(at, r) * A.transpose();
        own.K.noalias() = own_e * own_e.transpose();
        own.H.noalias() = own_e * g.middleRows(at, r).transpose();
        added_[first + i] = addition(own);
      }
    }
  }

  void order_by_addition() {
    order_.resize(own_.size());
    for (std::size_t j = 0; j < order_.size(); ++j) order_[j] = int(j);
    std::sort(order_.begin(), order_.end(), [this](int i, int j) {
      const double x = added_[std::size_t(i)], y = added_[std::size_t(j)];
      return x != y ? x < y : i < j;
    });
  }

  double addition(const Products& own) {
    half_ = Square::Identity(rows_, rows_);
    S_ = own.D;
    S_.diagonal().array() += 1.0;
    factor_.compute(S_);
    factor_.solveInPlace(half_);
    return change(half_, own);
  }

  double change(const Square& inverse, const Products& p) {
    IT_.noalias() = inverse * p.T;
    IK_.noalias() = inverse * p.K;
    return IT_.cwiseProduct(IK_.transpose()).sum() - IT_.trace() + 2 * inverse.cwiseProduct(p.H).sum();
  }

  /// Vectors whose products with a candidate's rows are those of both.
  void leave(int k) {
    const Eigen::Index a = fitted_, r = rows_, all = blocks().columns();
    const auto J = blocks().block(std::size_t(k));
    const auto A = J.leftCols(a);
    const BlockArray::RowMatrix e = J * residual_, g = A * pull_;
    vectors_.block(0, 0, r, a).noalias() = A * V_;
    vectors_.block(r, 0, r, a).noalias() = A * B_;
    vectors_.block(2 * r, 0, r, all).noalias() = e * residual_.transpose();
    vectors_.block(3 * r, 0, r, all).noalias() = g * residual_.transpose();
    vectors_.block(4 * r, 0, r, a).noalias() = e * pull_.transpose();
  }

  /// Change of φ if k leaves and j comes.
  double swapped(int k, int j) {
    const Eigen::Index r = rows_;
    kernels().cross(blocks().row(std::size_t(j), 0), rows_, blocks().stride(), vectors_.data(), int(5 * r),
                    crossed_.data());
    const Products &in = own_[std::size_t(j)], &out = own_[std::size_t(k)];
    if (!invert(in.D, out.D)) return from_scratch(k, j);
    both_.T.resize(2 * r, 2 * r);
    both_.K.resize(2 * r, 2 * r);
    both_.H.resize(2 * r, 2 * r);
    const auto T = crossed_.middleCols(r, r), K = crossed_.middleCols(2 * r, r);
    both_.T << in.T, T, T.transpose(), out.T;
    both_.K << in.K, K, K.transpose(), out.K;
    both_.H << in.H, crossed_.middleCols(3 * r, r), crossed_.middleCols(4 * r, r).transpose(), out.H;
    return change(inverse_, both_);
  }

  /// S⁻¹ = N⁻ᵀ Σ N⁻¹ with N = (X 0; C_ᵀ Y), X Xᵀ = I + D_j, C_ = X⁻¹ D_jk, Y Yᵀ = I − D_k + C_ᵀ C_: added first, so
  /// that nobody is indispensable. False where a pivot is small.
  bool invert(const Square& in, const Square& out) {
    const Eigen::Index r = rows_;
    S_ = in;
    S_.diagonal().array() += 1.0;
    factor_.compute(S_);
    half_ = crossed_.leftCols(r);
    factor_.matrixL().solveInPlace(half_);
    S_.noalias() = half_.transpose() * half_ - out;
    S_.diagonal().array() += 1.0;
    second_.compute(S_);
    if (second_.info() != Eigen::Success || !(second_.matrixLLT().diagonal().minCoeff() > safe_bias_pivot))
      return false;
    lower_.setIdentity(2 * r, 2 * r);
    factor_.matrixL().solveInPlace(lower_.topLeftCorner(r, r));
    second_.matrixL().solveInPlace(lower_.bottomRightCorner(r, r));
    lower_.bottomLeftCorner(r, r).noalias() =
        -lower_.bottomRightCorner(r, r) * (half_.transpose() * lower_.topLeftCorner(r, r));
    inverse_.noalias() = lower_.topRows(r).transpose() * lower_.topRows(r);
    inverse_.noalias() -= lower_.bottomRows(r).transpose() * lower_.bottomRows(r);
    return true;
  }

  /// +∞ where the fitted columns would not be determined.
  double from_scratch(int k, int j) const { return std::exp(-value_of_swap(k, j)) - error_; }

  std::shared_ptr<const BiasFunction> shared_;  // a state may outlive its criterion
  const BiasFunction& function_;
  Eigen::Index fitted_;
  int rows_;
  Eigen::MatrixXd V_, B_, pull_, residual_;  // pull_: V Lᵀ E; residual_: e = J residual_
  std::vector<Products> own_;                // of each candidate with itself
  std::vector<double> added_;                // change of φ if it is added
  std::vector<int> order_;                   // by added_
  double error_ = 0.0;
  BlockArray::RowMatrix vectors_, crossed_;
  Products both_;
  Square S_, half_, lower_, inverse_, IT_, IK_;
  Eigen::LLT<Eigen::MatrixXd> factor_, second_;
};

/// φ and its parts at one M.
struct MeanSquare {
  Eigen::LLT<Eigen::MatrixXd> factor;  // of M_aa
  Eigen::MatrixXd spread;              // M_aa⁻¹ Lᵀ
  Eigen::MatrixXd error;               // by each effect
  double value = infinity;

  MeanSquare(const Eigen::MatrixXd& information, const Eigen::MatrixXd& rows, const Eigen::MatrixXd& mix,
             const Eigen::MatrixXd& offset)
      : factor(information.topLeftCorner(rows.cols(), rows.cols())) {
    if (!is_regular(factor)) return;
    spread = factor.solve(rows.transpose());
    error = spread.transpose() * (information.topRightCorner(rows.cols(), mix.rows()) * mix) - offset;
    value = rows.transpose().cwiseProduct(spread).sum() + error.squaredNorm();
  }
};

}  // namespace

BiasFunction::BiasFunction(const Eigen::MatrixXd& rows, Eigen::MatrixXd mix, const Eigen::MatrixXd& offset)
    : rows_(rows), mix_(std::move(mix)), offset_(offset) {
  // Many places, few columns: only the triangle of [L b] counts.
  const Eigen::Index m = rows.cols(), all = m + offset.cols();
  if (rows.rows() <= all) return;
  Eigen::MatrixXd both(rows.rows(), all);
  both << rows, offset;
  const Eigen::MatrixXd R =
      Eigen::HouseholderQR<Eigen::MatrixXd>(both).matrixQR().topRows(all).triangularView<Eigen::Upper>();
  rows_ = R.leftCols(m);
  offset_ = R.rightCols(offset.cols());
}

double BiasFunction::value(const Eigen::MatrixXd& information) const {
  return -std::log(MeanSquare(information, rows_, mix_, offset_).value);
}

/// dφ = −tr(L V dM V Lᵀ) + 2 tr(Qᵀ L V (dM_af Z − dM_aa V M_af Z)), V = M_aa⁻¹, Q the errors.
Eigen::MatrixXd BiasFunction::gradient(const Eigen::MatrixXd& information) const {
  const Eigen::Index m = rows_.cols(), k = mix_.rows();
  const MeanSquare at(information, rows_, mix_, offset_);
  const Eigen::MatrixXd taken = at.factor.solve(information.topRightCorner(m, k) * mix_);
  const Eigen::MatrixXd weighted = at.spread * at.error;
  const Eigen::MatrixXd product = weighted * taken.transpose();
  Eigen::MatrixXd S = Eigen::MatrixXd::Zero(m + k, m + k);
  S.topLeftCorner(m, m) = at.spread * at.spread.transpose() + product + product.transpose();
  S.topRightCorner(m, k) = -weighted * mix_.transpose();
  S.bottomLeftCorner(k, m) = S.topRightCorner(m, k).transpose();
  return S / at.value;
}

namespace {

class BiasCriterion : public Criterion {
 public:
  explicit BiasCriterion(std::shared_ptr<const BiasFunction> function) : function_(std::move(function)) {}
  std::string name() const override { return "bias"; }
  const InformationFunction& function() const override { return *function_; }
  std::unique_ptr<DesignState> start(const CandidateView& view, std::vector<int> members) const override {
    return std::make_unique<BiasState>(view, std::move(members), function_);
  }

 private:
  std::shared_ptr<const BiasFunction> function_;
};

}  // namespace

std::unique_ptr<Criterion> make_bias_criterion(const CriterionData& data) {
  require_effects(data);
  const EffectGroup& effects = data.effects;
  const Eigen::Index k = effects.columns, m = data.R.cols() - k;
  Eigen::MatrixXd rows = effects.error_rows;
  data.R.topLeftCorner(m, m).triangularView<Eigen::Upper>().solveInPlace<Eigen::OnTheRight>(rows);
  // The raw trailing columns hold R_af of the whitened fitted ones: that share is taken up whatever the plan.
  const Eigen::MatrixXd offset = effects.error_offset - rows * (data.R.topRightCorner(m, k) * effects.mix);
  return std::make_unique<BiasCriterion>(std::make_shared<BiasFunction>(rows, whitened_mix(data), offset));
}

}  // namespace posewright
