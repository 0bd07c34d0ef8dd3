#include "posewright/criterion/determinant.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "determinant_nuisance.hpp"
#include "kernels/kernels.hpp"
#include "posewright/blocks/block_array.hpp"
#include "posewright/criterion/inverse_information.hpp"
#include "posewright/support/dense.hpp"
#include "regular.hpp"
#include "swap_gain.hpp"

namespace posewright {
namespace {

// Columns from which on a row is worth keeping; shorter ones are multiplied as quickly as they are read.
constexpr int long_row = 64;
// Terms that are kept aside.
constexpr Eigen::Index most_terms = 64;

/// c_kj = x_k V x_jᵀ of every member k with every candidate j, for blocks of one row, kept while V changes: a scan for
/// the swaps of a member costs a look at n numbers in place of n products of m. A swap adds two terms to every row;
/// they are kept aside and brought to a row when it is asked for, to all of them as one product of matrices when they
/// have become many.
class MemberProducts {
 public:
  explicit MemberProducts(const InverseInformation& inverse) : inverse_(inverse) {}

  /// True if rows are so long, and members so few, that this saves time and takes no more than twice the memory
  /// of the blocks.
  static bool pays(const BlockArray& blocks, std::size_t members) {
    return blocks.rows() == 1 && blocks.columns() >= long_row && members <= std::size_t(2 * blocks.stride());
  }

  /// V is another one, or the members are: all rows are computed anew when one is asked for.
  void forget() { known_ = false; }
  /// n numbers for the member at a position.
  const double* row(const std::vector<int>& members, int position) {
    if (!known_ || whose_.size() != members.size()) compute(members);
    const Eigen::Index first = done_[std::size_t(position)], left = count_ - first;
    if (left > 0) {
      const auto k = Eigen::Index(members[std::size_t(position)]);
      const Eigen::VectorXd share =
          terms_.row(k).segment(first, left).transpose().cwiseProduct(signs_.segment(first, left));
      rows_.row(position).transpose().noalias() -= terms_.middleCols(first, left) * share;
      done_[std::size_t(position)] = count_;
    }
    return rows_.row(position).data();
  }
  /// After inverse.change() has brought `enter` in the place of the member at some position.
  void change(const std::vector<int>& members, const RankChange& made) {
    if (!known_) return;
    const auto changed = std::mismatch(whose_.begin(), whose_.end(), members.begin(), members.end()).first;
    if (whose_.size() != members.size() || changed == whose_.end()) {
      forget();
      return;
    }
    if (count_ + made.terms.cols() > most_terms) bring_to_all();
    const auto position = changed - whose_.begin();
    const int enter = members[std::size_t(position)];
    whose_[std::size_t(position)] = enter;
    terms_.middleCols(count_, made.terms.cols()) = made.terms;
    signs_.segment(count_, made.terms.cols()) = made.signs;
    count_ += made.terms.cols();
    // x_enter V x_jᵀ before the change is among the terms' combinations; what the change takes is another.
    const Eigen::VectorXd share =
        made.entering - made.signs.cwiseProduct(made.terms.row(Eigen::Index(enter)).transpose());
    rows_.row(position).transpose().noalias() = made.terms * share;
    done_[std::size_t(position)] = count_;
  }

 private:
  void compute(const std::vector<int>& members) {
    const BlockArray& blocks = inverse_.blocks();
    const auto n = Eigen::Index(blocks.count()), size = Eigen::Index(members.size());
    BlockArray::RowMatrix own(size, blocks.columns());
    for (Eigen::Index k = 0; k < size; ++k) own.row(k) = blocks.block(std::size_t(members[std::size_t(k)]));
    const BlockArray::RowMatrix projected = own * inverse_.inverse();
    rows_.resize(size, n);
    rows_.noalias() = projected * blocks.all().transpose();
    whose_ = members;
    terms_.resize(n, most_terms);
    signs_.resize(most_terms);
    done_.assign(members.size(), 0);
    count_ = 0;
    known_ = true;
  }

  void bring_to_all() {
    BlockArray::RowMatrix shares = BlockArray::RowMatrix::Zero(rows_.rows(), count_);
    for (Eigen::Index k = 0; k < rows_.rows(); ++k)
      for (Eigen::Index l = done_[std::size_t(k)]; l < count_; ++l)
        shares(k, l) = signs_[l] * terms_(whose_[std::size_t(k)], l);
    rows_.noalias() -= shares * terms_.leftCols(count_).transpose();
    std::fill(done_.begin(), done_.end(), 0);
    count_ = 0;
  }

  const InverseInformation& inverse_;
  bool known_ = false;
  BlockArray::RowMatrix rows_;  // N × n
  std::vector<int> whose_;      // candidate of each row
  Eigen::MatrixXd terms_;       // n × most_terms; each is sign · term termᵀ less in X V Xᵀ
  Eigen::VectorXd signs_;
  std::vector<Eigen::Index> done_;  // terms that a row has
  Eigen::Index count_ = 0;
};

double power(double base, int exponent) {
  double result = 1;
  for (; exponent > 0; exponent >>= 1, base *= base)
    if (exponent & 1) result *= base;
  return result;
}

/// Without nuisance columns: running inverse, cached traces, pruned scans.
class DeterminantState : public DesignState {
 public:
  DeterminantState(const CandidateView& view, std::vector<int> members)
      : DesignState(view, std::move(members)),
        inverse_(*view.blocks, view.blocks->columns(), view.prior),
        gain_(inverse_, view.blocks->rows()),
        products_(inverse_),
        keeps_products_(MemberProducts::pays(*view.blocks, this->members().size())),
        changes_till_refresh_(std::max(changes_till_refresh, view.blocks->columns())),
        has_prior_(view.prior != nullptr) {
    refresh();
  }

  double value() const override { return singular_ ? -infinity : inverse_.log_det(); }

  double loss(int position) const override {
    const int k = members()[std::size_t(position)];
    if (!bounds_only_) return inverse_.trace(k);
    std::vector<double> y;
    Eigen::MatrixXd d(blocks().rows(), blocks().rows());
    inverse_.own(k, y, d);
    return d.trace();
  }

  Swap best_addition() override {
    Swap best{-1, -infinity};
    const int n = static_cast<int>(blocks().count()), r = blocks().rows();
    double ratio = 0;
    const auto may_be_best = [&](int j) { return power(1 + inverse_.trace(j) / r, r) > ratio; };
    for (int j = 0; j < n; ++j) {
      if (blocked()[std::size_t(j)] != 0 || !may_be_best(j)) continue;
      if (bounds_only_) {
        inverse_.measure(j);
        if (!may_be_best(j)) continue;
      }
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
    // Nothing has run since: an exchange asks once more after a pass without a swap.
    if (since_refresh_ == 0) return !singular_;
    since_refresh_ = 0;
    bounds_only_ = false;
    gain_.forget();
    products_.forget();
    singular_ = !inverse_.refresh(members(), 0.0);
    if (singular_) inverse_.refresh(members(), start_ridge);
    return !singular_;
  }

 private:
  Swap do_best_swap(int position, double min_gain) override {
    if (bounds_only_) refresh();
    const int k = members()[std::size_t(position)];
    return blocks().rows() == 1 ? best_row(position, k, min_gain) : best_block(k, min_gain);
  }

  void do_change(int leave, int enter) override {
    gain_.forget();
    // A ridge is for starts; every change may be the one that makes it needless, once there are rows enough.
    const bool enough = has_prior_ || long(members().size()) * blocks().rows() >= blocks().columns();
    ++since_refresh_;
    if ((singular_ && enough) || !change(leave, enter) || since_refresh_ >= changes_till_refresh_) refresh();
  }

  bool change(int leave, int enter) {
    // A design that grows asks for the best addition alone, and few candidates come near it (Minoux 1978).
    if (leave < 0) return bounds_only_ = inverse_.add(enter);
    if (bounds_only_) return false;
    if (!keeps_products_) return inverse_.change(leave, enter);
    if (!inverse_.change(leave, enter, &made_)) return false;
    products_.change(members(), made_);
    return true;
  }

  Swap best_row(int position, int k, double min_gain) {
    if (keeps_products_) return best_of_products(position, k, min_gain);
    inverse_.project(k, y_);
    double best = std::expm1(min_gain);
    const long j = kernels().scan_rows(blocks().data(), blocks().count(), blocks().stride(), y_.data(),
                                       inverse_.traces().data(), inverse_.trace(k), blocked().data(), &best);
    return j < 0 ? Swap{} : Swap{static_cast<int>(j), std::log1p(best)};
  }

  /// Variant with known x_j V x_kᵀ.
  Swap best_of_products(int position, int k, double min_gain) {
    const double* c = products_.row(members(), position);
    const std::vector<double>& d = inverse_.traces();
    const double left = 1 - d[std::size_t(k)];
    double best = std::expm1(min_gain);
    int enter = -1;
    for (std::size_t j = 0; j < d.size(); ++j) {
      const double gain = (1 + d[j]) * left + c[j] * c[j] - 1;
      if (gain <= best || blocked()[j] != 0) continue;
      best = gain;
      enter = int(j);
    }
    return enter < 0 ? Swap{} : Swap{enter, std::log1p(best)};
  }

  Swap best_block(int k, double min_gain) {
    gain_.leave(k);
    Swap best{-1, min_gain};
    const std::size_t n = blocks().count();
    for (std::size_t j = gain_.next(0, n, min_gain, blocked()); j < n; j = gain_.next(j + 1, n, best.gain, blocked())) {
      const double gain = gain_.exact(int(j));
      if (gain > best.gain) best = {int(j), gain};
    }
    return best.enter < 0 ? Swap{} : best;
  }

  InverseInformation inverse_;
  SwapGain gain_;
  MemberProducts products_;
  RankChange made_;
  bool keeps_products_ = false;
  // A fresh factor costs as much as some m changes.
  int changes_till_refresh_;
  std::vector<double> y_;
  int since_refresh_ = 1;
  bool has_prior_ = false, singular_ = false;
  bool bounds_only_ = false;  ///< since the last refresh a member was added: d of the candidates are bounds
};

}  // namespace

std::unique_ptr<DesignState> DeterminantCriterion::start(const CandidateView& view, std::vector<int> members) const {
  if (view.nuisance > 0) return start_with_nuisance(view, std::move(members));
  return std::make_unique<DeterminantState>(view, std::move(members));
}

}  // namespace posewright
