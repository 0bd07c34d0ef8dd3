#include <cmath>
#include <limits>
#include <utility>

#include "kernels/kernels.hpp"
#include "posewright/criterion/sensitivity.hpp"
#include "posewright/criterion/summed_information.hpp"
#include "posewright/criterion/trace.hpp"
#include "posewright/support/dense.hpp"
#include "regular.hpp"

namespace posewright {
namespace {

// Smallest eigenvalue of I − D_k for which removing k first keeps its digits.
constexpr double indispensable_in_trace = 1e-6;

/// Exact changes of φ = tr(L V), V = M⁻¹, B = V L V, by parts. With D_j = J_j V J_jᵀ and T_j = J_j B J_jᵀ,
///   adding j:    φ falls by tr((I + D_j)⁻¹ T_j),
///   removing k:  φ rises by tr(E T_k), E = (I − D_k)⁻¹,
///   both:        φ falls by tr(S⁻¹ Q) − tr(E T_k), S = I + D_j + C E Cᵀ, Q = T_j + C E Gᵀ + G E Cᵀ + C E T_k E Cᵀ,
/// C = J_j V J_kᵀ, G = J_j B J_kᵀ (Sherman–Morrison–Woodbury, the block of k eliminated once for all j).
/// Where k is indispensable, M without k plus a small ridge takes M's place.
/// S ≽ I and Q ≽ 0, so tr Q bounds what j can give: cheap to reject with.
class TraceState : public DesignState {
 public:
  TraceState(const CandidateView& view, std::vector<int> members, const Eigen::MatrixXd& A)
      : DesignState(view, std::move(members)), A_(A), rows_(view.blocks->rows()) {
    refresh();
  }

  double value() const override { return singular_ ? -infinity : -std::log(variance_); }
  double loss(int position) const override { return trace(members()[std::size_t(position)]); }

  Swap best_addition() override {
    double most = 0.0;
    int best = -1;
    for (int j = 0; j < int(blocks().count()); ++j) {
      if (blocked()[std::size_t(j)] != 0 || (best >= 0 && trace(j) <= most)) continue;
      own(j, V_, D_j_);
      D_j_.diagonal().array() += 1.0;
      own(j, B_, T_j_);
      const double fall = quotient(D_j_, T_j_);
      if (best < 0 || fall > most) {
        most = fall;
        best = j;
      }
    }
    return {best, gain_of(most)};
  }

  double removal(int position) override {
    if (!leave(members()[std::size_t(position)])) return -infinity;
    return gain_of(-leaving_);
  }

  bool refresh() override {
    information_ = summed_information(blocks(), view().prior, members());
    singular_ = !invert();
    if (singular_) {
      information_.diagonal().array() += start_ridge;
      invert();
    }
    return !singular_;
  }

 private:
  Swap do_best_swap(int position, double min_gain) override {
    const int k = members()[std::size_t(position)];
    if (!leave(k)) return best_for_indispensable(k, min_gain);
    // gain = ln(φ / (φ − fall)): what must be given to gain as much as the best so far.
    double needed = variance_ * -std::expm1(-min_gain) + leaving_, most = needed;
    Swap best{-1, min_gain};
    for (int j = 0; j < int(blocks().count()); ++j) {
      // Φ is concave: no swap gains more than its derivative promises.
      if (trace(j) - trace(k) <= best.gain * variance_ || blocked()[std::size_t(j)] != 0) continue;
      if (!promising(j, most)) continue;
      const double given = quotient(S_, Q_);
      if (given <= most) continue;
      most = given;
      best = {j, gain_of(given - leaving_)};
    }
    return best.enter < 0 || !(best.gain > min_gain) ? Swap{} : best;
  }

  void do_change(int leave, int enter) override {
    if (enter >= 0) information_ += block_information(blocks(), enter);
    if (leave >= 0) information_ -= block_information(blocks(), leave);
    // A start that was singular may have become regular.
    if (singular_ || !invert()) refresh();
  }

  double trace(int j) const { return traces_[std::size_t(j)]; }
  double gain_of(double fall) const { return fall < variance_ ? -std::log1p(-fall / variance_) : infinity; }

  /// V, B and the pass over all candidates from the information as it is; false if it is singular.
  bool invert() {
    const Eigen::LLT<Eigen::MatrixXd> factor(information_);
    if (!is_regular(factor)) return false;
    ++changes_;
    V_ = factor.solve(Eigen::MatrixXd::Identity(information_.rows(), information_.cols()));
    const Eigen::MatrixXd VA = factor.solve(A_.transpose());
    B_ = VA * VA.transpose();
    variance_ = A_.transpose().cwiseProduct(VA).sum();
    information_traces(blocks(), upper_factor(VA).transpose(), blocks().columns(), traces_);
    return true;
  }

  /// J_j W J_jᵀ.
  void own(int j, const BlockArray::RowMatrix& W, Eigen::MatrixXd& result) {
    const auto J = blocks().block(std::size_t(j));
    rotated_.noalias() = J * W;
    result.noalias() = rotated_ * J.transpose();
  }

  /// D_j and T_j: the same for every member that may leave, so they are kept until the next change.
  std::pair<Eigen::Map<const Eigen::MatrixXd>, Eigen::Map<const Eigen::MatrixXd>> own_both(int j) {
    const std::size_t square = std::size_t(rows_) * std::size_t(rows_);
    if (kept_.empty()) {
      kept_.resize(2 * square * blocks().count());
      kept_at_.assign(blocks().count(), 0);
    }
    double* const D = &kept_[2 * square * std::size_t(j)];
    if (kept_at_[std::size_t(j)] != changes_) {
      kept_at_[std::size_t(j)] = changes_;
      own(j, V_, D_j_);
      own(j, B_, T_j_);
      Eigen::Map<Eigen::MatrixXd>(D, rows_, rows_) = D_j_;
      Eigen::Map<Eigen::MatrixXd>(D + square, rows_, rows_) = T_j_;
    }
    return {{D, rows_, rows_}, {D + square, rows_, rows_}};
  }

  /// Projections of the leaving member; false if it is indispensable.
  bool leave(int k) {
    const auto J = blocks().block(std::size_t(k));
    project(J, V_, y_);
    project(J, B_, z_);
    own(k, V_, D_k_);
    own(k, B_, T_k_);
    const Eigen::MatrixXd rest = Eigen::MatrixXd::Identity(rows_, rows_) - D_k_;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(rest);
    if (!(eigen.eigenvalues()[0] > indispensable_in_trace)) return false;
    E_ = eigen.eigenvectors() * eigen.eigenvalues().cwiseInverse().asDiagonal() * eigen.eigenvectors().transpose();
    leaving_ = E_.cwiseProduct(T_k_).sum();
    return true;
  }

  /// W Jᵀ as r padded rows.
  template <class Block>
  void project(const Block& J, const BlockArray::RowMatrix& W, std::vector<double>& y) {
    y.assign(std::size_t(rows_ * blocks().stride()), 0.0);
    BlockArray::Map(y.data(), rows_, blocks().columns(), Eigen::OuterStride<>(blocks().stride())).noalias() = J * W;
  }

  /// S_ and Q_ of candidate j; false as soon as it is clear that it cannot give more than `most`.
  bool promising(int j, double most) {
    cross(j, y_, C_);
    cross(j, z_, G_);
    CE_.noalias() = C_ * E_;
    GE_.noalias() = CE_ * T_k_;
    // tr Q = tr T_j + 2⟨C E, G⟩ + ⟨C E T_k, C E⟩.
    if (trace(j) + 2 * CE_.cwiseProduct(G_).sum() + GE_.cwiseProduct(CE_).sum() <= most) return false;
    const auto [D, T] = own_both(j);
    S_ = D;
    S_.noalias() += CE_ * C_.transpose();
    S_.diagonal().array() += 1.0;
    Q_ = T;
    Q_.noalias() += GE_ * CE_.transpose();
    GE_.noalias() = CE_ * G_.transpose();
    Q_ += GE_ + GE_.transpose();
    return true;
  }

  void cross(int j, const std::vector<double>& y, Eigen::MatrixXd& c) {
    kernels().cross(blocks().row(std::size_t(j), 0), rows_, blocks().stride(), y.data(), rows_, c.data());
    c.transposeInPlace();
  }

  /// tr(S⁻¹ Q); overwrites Q.
  double quotient(const Eigen::MatrixXd& S, Eigen::MatrixXd& Q) {
    if (rows_ == 1) return Q(0, 0) / S(0, 0);
    factor_.compute(S);
    factor_.solveInPlace(Q);
    return Q.trace();
  }

  /// From M₋ = M − J_kᵀJ_k plus a ridge, and exactly for the winner.
  Swap best_for_indispensable(int k, double min_gain) {
    const Eigen::Index m = information_.rows();
    Eigen::MatrixXd rest = information_ - block_information(blocks(), k);
    rest.diagonal().array() += 1e-6;
    const Eigen::LLT<Eigen::MatrixXd> llt(rest);
    const BlockArray::RowMatrix V = llt.solve(Eigen::MatrixXd::Identity(m, m));
    const Eigen::MatrixXd VA = llt.solve(A_.transpose());
    const BlockArray::RowMatrix B = VA * VA.transpose();
    int best = -1;
    double most = 0.0;
    for (int j = 0; j < int(blocks().count()); ++j) {
      if (blocked()[std::size_t(j)] != 0) continue;
      own(j, V, D_j_);
      D_j_.diagonal().array() += 1.0;
      own(j, B, T_j_);
      const double given = quotient(D_j_, T_j_);
      if (best < 0 || given > most) {
        best = j;
        most = given;
      }
    }
    if (best < 0) return {};
    const double left = A_.transpose().cwiseProduct(VA).sum() - most;
    if (singular_) {
      const double gain = left > 0 ? std::log(variance_ / left) : infinity;
      return std::isfinite(gain) && gain > min_gain ? Swap{best, gain} : Swap{};
    }
    const double exact =
        function_value(information_ - block_information(blocks(), k) + block_information(blocks(), best)) - value();
    return exact > min_gain ? Swap{best, exact} : Swap{};
  }

  double function_value(const Eigen::MatrixXd& information) const { return TraceFunction(A_).value(information); }

  Eigen::MatrixXd A_;
  int rows_;
  Eigen::MatrixXd information_;
  BlockArray::RowMatrix V_, B_, rotated_;
  std::vector<double> traces_, y_, z_;
  std::vector<double> kept_;  // D_j, T_j of each candidate that was looked at closely
  std::vector<long> kept_at_;
  long changes_ = 0;  // of V and B
  Eigen::MatrixXd D_k_, T_k_, E_, D_j_, T_j_, C_ = Eigen::MatrixXd(rows_, rows_), G_ = Eigen::MatrixXd(rows_, rows_),
                                              CE_, GE_, S_, Q_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
  double variance_ = 0.0, leaving_ = 0.0;  // φ, tr(E T_k)
  bool singular_ = false;
};

}  // namespace

std::unique_ptr<DesignState> TraceCriterion::start(const CandidateView& view, std::vector<int> members) const {
  return std::make_unique<TraceState>(view, std::move(members), function_.A());
}

}  // namespace posewright
