#include "member_products.hpp"

#include <algorithm>

#include "posewright/support/dense.hpp"

namespace posewright {
namespace {

// Columns from which on a row is worth keeping; shorter ones are multiplied as quickly as they are read.
constexpr int long_row = 64;
// Terms that are kept aside.
constexpr Eigen::Index most_terms = 64;

}  // namespace

bool MemberProducts::pays(const BlockArray& blocks, std::size_t members) {
  return blocks.rows() == 1 && blocks.columns() >= long_row && members <= std::size_t(2 * blocks.stride());
}

void MemberProducts::compute(const std::vector<int>& members) {
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

const double* MemberProducts::row(const std::vector<int>& members, int position) {
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

void MemberProducts::change(const std::vector<int>& members, const RankChange& made) {
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

void MemberProducts::bring_to_all() {
  BlockArray::RowMatrix shares = BlockArray::RowMatrix::Zero(rows_.rows(), count_);
  for (Eigen::Index k = 0; k < rows_.rows(); ++k)
    for (Eigen::Index l = done_[std::size_t(k)]; l < count_; ++l)
      shares(k, l) = signs_[l] * terms_(whose_[std::size_t(k)], l);
  rows_.noalias() -= shares * terms_.leftCols(count_).transpose();
  std::fill(done_.begin(), done_.end(), 0);
  count_ = 0;
}

}  // namespace posewright
