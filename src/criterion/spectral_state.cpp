#include "spectral_state.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "by_bound.hpp"
#include "posewright/criterion/summed_information.hpp"
#include "posewright/support/dense.hpp"
#include "regular.hpp"

namespace posewright {
namespace {

// What rounding may take from a bound: of Φ, and of an eigenvalue relatively.
constexpr double eigenvalue_rounding = 1e-10;
// Of a start that is singular, gains are those of M plus a ridge: no more than so many are computed.
constexpr int most_of_singular = 16;
// Eigenvectors beside the rank of a change that a first look takes.
constexpr Eigen::Index first_look = 4;

/// Exact swaps of functions of eigenvalues. Where nuisance columns are eliminated too, what is left without the leaving
/// member, diag(λ) in its own eigenvectors, changes by Yᵀ Y, Y = (I + D_n)^{-1/2} J C W V, D_n = J_n M_nn⁻¹ J_nᵀ. Of
/// what that can gain there are bounds, each dearer and tighter (theory.md eq. (46)):
///   - concavity in M: λ_min' ≤ λ_min + ‖J_j z‖² − ‖J_k z‖² with z of the eigenvector before (o2, o3, o4); the
///     square of o5, and of any mean of powers, is concave as a whole;
///   - interlacing (Weyl): a change of rank r lifts λ_min to λ_{r+1} at most;
///   - diagonal entries λ_i + ‖Y_i‖²: none is below λ_min' or above λ_max', and they are majorised by the eigenvalues;
///   - Sylvester's law of inertia: λ_min' > t exactly if I + Y (Λ − t)⁻¹ Yᵀ has as many negative eigenvalues as Λ − t;
///     first in the space of the few least eigenvalues alone, where λ_min' is no less.
/// Eigenvalues are computed for what is left.
class SpectralState : public DesignState {
 public:
  SpectralState(const CandidateView& view, std::vector<int> members, std::shared_ptr<const SpectralFunction> function)
      : DesignState(view, std::move(members)),
        shared_(std::move(function)),
        function_(*shared_),
        share_least_(function_.index() == SpectralIndex::o4 ? 1.0 : 0.5),
        share_most_(function_.index() == SpectralIndex::o2 || function_.index() == SpectralIndex::o4 ? 0.5 : 0.0) {
    refresh();
  }

  double value() const override { return singular_ ? -infinity : value_; }
  double loss(int position) const override { return d_[members()[std::size_t(position)]]; }

  Swap best_addition() override { return best_of(-1, -infinity); }

  double removal(int position) override {
    return function_.value(information_ - block_information(blocks(), members()[std::size_t(position)])) - value_;
  }

  bool refresh() override {
    information_ = summed_information(blocks(), view().prior, members());
    singular_ = !update();
    if (singular_) {
      information_.diagonal().array() += start_ridge;
      update();
    }
    return !singular_;
  }

 private:
  Swap do_best_swap(int position, double min_gain) override {
    return best_of(members()[std::size_t(position)], min_gain);
  }

  void do_change(int leave, int enter) override {
    if (enter >= 0) information_ += block_information(blocks(), enter);
    if (leave >= 0) information_ -= block_information(blocks(), leave);
    // A start that was singular may have become regular.
    if (singular_ || !update()) refresh();
  }

  /// Value and, of every candidate, the derivative and ‖J z‖²; false if the information is singular.
  bool update() {
    const SpectralFunction::Spectrum s = function_.spectrum(information_, true);
    if (!s.regular) return false;
    value_ = function_.of(s.lambda);
    least_ = s.lambda[0];
    const Eigen::MatrixXd all = function_.directions(s);
    const auto count = Eigen::Index(blocks().count()), r = Eigen::Index(blocks().rows());
    d_.resize(count);
    pull_.resize(count);
    if (function_.of_all()) {
      const Eigen::VectorXd share = function_.by_eigenvalue(s.lambda);
      projected_.noalias() = blocks().all() * Eigen::MatrixXd(all * share.cwiseSqrt().asDiagonal());
      for (Eigen::Index j = 0; j < count; ++j) d_[j] = projected_.middleRows(j * r, r).squaredNorm();
      pull_ = d_;
      return true;
    }
    Eigen::MatrixXd ends(all.rows(), 2);
    ends << all.col(0), all.rightCols(1);
    projected_.noalias() = blocks().all() * ends;
    const double most = s.lambda[s.lambda.size() - 1];
    for (Eigen::Index j = 0; j < count; ++j) {
      const auto rows = projected_.middleRows(j * r, r);
      pull_[j] = rows.col(0).squaredNorm();
      d_[j] = share_least_ * pull_[j] / least_ - share_most_ * rows.col(1).squaredNorm() / most;
    }
    return true;
  }

  /// The pull less that of the leaving member from which on Φ may exceed value_ + gain; infinite: nowhere.
  double wanted_pull(double gain, double most_at_least) const {
    if (!std::isfinite(gain)) return -infinity;
    if (function_.of_all()) return 0.5 * std::expm1(2 * (gain - eigenvalue_rounding));
    return least_wanted(gain, most_at_least) - least_;
  }

  /// λ_min' that Φ' > value_ + gain asks for, if λ_max' is `most` or more.
  double least_wanted(double gain, double most) const {
    const double log_most = share_most_ > 0 ? share_most_ * std::log(most) : 0.0;
    return std::exp((value_ + gain - eigenvalue_rounding + log_most) / share_least_);
  }

  Swap best_of(int k, double min_gain) {
    rest_ = information_;
    if (k >= 0) rest_ -= block_information(blocks(), k);
    const SpectralFunction::Spectrum s = function_.spectrum(rest_, true);
    const bool formula = s.eliminated && function_.inside(rest_, inside_);
    const double most_left = formula ? s.lambda[s.lambda.size() - 1] : 0.0;
    const double before = k < 0 ? 0.0 : pull_[k];
    Swap best{-1, min_gain};
    double wanted = wanted_pull(min_gain, most_left);
    if (formula) {
      lambda_ = s.lambda.cwiseMax(0.0);
      directions_ = function_.directions(s);
      if (!attainable(best.gain)) return {};
    }
    queue_.clear();
    for (int j = 0; j < int(blocks().count()); ++j)
      if (blocked()[std::size_t(j)] == 0 && pull_[j] - before > wanted) queue_.add(pull_[j] - before, j);
    queue_.order();
    for (int looked = 0; !queue_.empty() && !(singular_ && looked == most_of_singular); ++looked) {
      const auto [bound, j] = queue_.next();
      if (bound <= wanted) break;
      const double gain =
          formula ? gain_of(j, best.gain) : function_.value(rest_ + block_information(blocks(), j)) - value_;
      if (!(gain > best.gain)) continue;
      best = {j, gain};
      wanted = wanted_pull(gain, most_left);
      if (formula && !attainable(gain)) break;
    }
    return best.enter < 0 ? Swap{} : best;
  }

  /// By interlacing.
  bool attainable(double gain) const {
    const Eigen::Index r = blocks().rows(), s = lambda_.size();
    return function_.of_all() || r >= s || !std::isfinite(gain) || lambda_[r] > least_wanted(gain, lambda_[s - 1]);
  }

  /// Exact, or −∞ as soon as it is clear that it is no more than `wanted`.
  double gain_of(int j, double wanted) {
    const auto J = blocks().block(std::size_t(j));
    if (inside_.cols() > 0) {
      nuisance_.noalias() = J.leftCols(inside_.rows()) * inside_;
      D_.noalias() = nuisance_ * nuisance_.transpose();
      D_.diagonal().array() += 1.0;
      factor_.compute(D_);
    }
    const Eigen::Index s = lambda_.size(), few = blocks().rows() + first_look;
    if (std::isfinite(wanted) && !function_.of_all() && 2 * few < s) {
      project(J, few);
      if (!promising_ends(wanted, std::max(diagonal_.maxCoeff(), lambda_[s - 1]))) return -infinity;
    }
    project(J, s);
    if (std::isfinite(wanted) &&
        !(function_.of_all() ? promising_sum(wanted) : promising_ends(wanted, diagonal_.maxCoeff())))
      return -infinity;
    changed_.noalias() = Y_.transpose() * Y_;
    changed_.diagonal() += lambda_;
    eigen_.compute(changed_, Eigen::EigenvaluesOnly);
    return function_.of(eigen_.eigenvalues()) - value_;
  }

  /// Y in the directions of the `count` least eigenvalues, and the diagonal there.
  template <class Block>
  void project(const Block& J, Eigen::Index count) {
    Y_.noalias() = J * directions_.leftCols(count);
    if (inside_.cols() > 0) factor_.matrixL().solveInPlace(Y_);
    diagonal_ = lambda_.head(count) + Y_.colwise().squaredNorm().transpose();
  }

  bool promising_sum(double wanted) const { return function_.mean(diagonal_) > value_ + wanted - eigenvalue_rounding; }

  /// @param most  λ_max' or less
  bool promising_ends(double wanted, double most) {
    const double t = least_wanted(wanted, most);
    if (diagonal_.minCoeff() <= t) return false;
    Eigen::Index below = 0;
    weight_ = lambda_.head(Y_.cols()).array() - t * (1 - eigenvalue_rounding);
    while (below < weight_.size() && weight_[below] < 0) ++below;
    if (below == 0) return true;
    // An eigenvalue at t itself: nothing to divide by.
    if (!(weight_.cwiseAbs().minCoeff() > 1e-14 * lambda_[lambda_.size() - 1])) return true;
    if (Y_.rows() == 1) return 1 + (Y_.row(0).transpose().array().square() / weight_.array()).sum() < 0;
    small_changed_.noalias() = Y_ * weight_.cwiseInverse().asDiagonal() * Y_.transpose();
    small_changed_.diagonal().array() += 1.0;
    small_.compute(small_changed_, Eigen::EigenvaluesOnly);
    return (small_.eigenvalues().array() < 0).count() >= below;
  }

  std::shared_ptr<const SpectralFunction> shared_;  // a state may outlive its criterion
  const SpectralFunction& function_;
  double share_least_, share_most_;  // Φ = share_least ln λ_min − share_most ln λ_max
  Eigen::MatrixXd information_, rest_;
  Eigen::VectorXd d_, pull_;
  BlockArray::RowMatrix projected_;
  double value_ = 0.0, least_ = 0.0;
  bool singular_ = false;
  ByBound queue_;
  Eigen::MatrixXd directions_, inside_, Y_, nuisance_, D_, changed_, small_changed_;
  Eigen::VectorXd lambda_, diagonal_, weight_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen_, small_;
};

}  // namespace

std::unique_ptr<DesignState> start_spectral(const CandidateView& view, std::vector<int> members,
                                            std::shared_ptr<const SpectralFunction> function) {
  return std::make_unique<SpectralState>(view, std::move(members), std::move(function));
}

}  // namespace posewright
