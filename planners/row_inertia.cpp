#include "row_inertia.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "posewright/support/dense.hpp"

namespace posewright {
namespace {

constexpr double unit_roundoff = std::numeric_limits<double>::epsilon();
constexpr std::size_t word = 64;
// Of the Cholesky factor of rows that exclude each other, whose entries are near 1.
constexpr double smallest_pivot = 1e-6;

}  // namespace

/// The rows in eigenvectors of M0, and (t I − M0)⁻¹ of each with itself.
void RowInertia::project(const Eigen::MatrixXd& known, const RowMatrix& rows, double threshold) {
  const Eigen::Index m = known.rows(), f = rows.rows();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(known);
  const double largest = std::max(std::abs(eigen.eigenvalues()[0]), std::abs(eigen.eigenvalues()[m - 1]));
  // M0 of the eigenvectors found is off by its rounding: what reaches t with one reaches this with the other.
  const double t = threshold - 100 * double(m) * unit_roundoff * largest;
  Eigen::VectorXd inverse = (t - eigen.eigenvalues().array()).inverse();
  slack_ = -int((eigen.eigenvalues().array() < t).count());
  projected_.noalias() = rows * eigen.eigenvectors();
  weighted_.noalias() = projected_ * inverse.asDiagonal();
  own_.resize(f);
  shortfall_.resize(f);
  rounding_.resize(f);
  const double spread = 8 * double(m) * unit_roundoff * inverse.cwiseAbs().sum();
  for (Eigen::Index i = 0; i < f; ++i) {
    own_[i] = projected_.row(i).dot(weighted_.row(i));
    rounding_[i] = spread * rows.row(i).squaredNorm();
    double positive = 0.0;
    for (Eigen::Index k = 0; k < m; ++k) positive += std::max(0.0, projected_(i, k) * weighted_(i, k));
    shortfall_[i] = std::max(0.0, 1 - positive - rounding_[i]);
  }
}

bool RowInertia::look(const Eigen::MatrixXd& known, const RowMatrix& rows, const Eigen::VectorXd& room, int left,
                      double threshold) {
  project(known, rows, threshold);
  slack_ += left;
  possible_.assign(std::size_t(rows.rows()), 1);
  if (slack_ < 0 || !own_.allFinite() || !rounding_.allFinite()) return slack_ >= 0;
  if (slack_ > 1) return true;
  products_.noalias() = projected_ * weighted_.transpose();
  return slack_ == 0 ? settle_pairs(room, left) : settle_partners(room, left);
}

/// s = 0: G ⪰ 0, so that every principal minor is at least 0. Rows for themselves, pairs of them, and as many partners
/// for each as are still to be chosen.
bool RowInertia::settle_pairs(const Eigen::VectorXd& room, int left) {
  const Eigen::Index f = own_.size();
  words_ = (std::size_t(f) + word - 1) / word;
  compatible_.assign(words_ * std::size_t(f), 0);
  for (Eigen::Index i = 0; i < f; ++i) possible_[std::size_t(i)] = own_[i] + rounding_[i] >= 1 && room[i] > 0;
  for (Eigen::Index i = 0; i < f; ++i) {
    if (!possible(i)) continue;
    for (Eigen::Index j = 0; j < i; ++j) {
      if (!possible(j)) continue;
      const double off = std::max(rounding_[i], rounding_[j]);
      const double product = std::max(0.0, std::abs(products_(i, j)) - off);
      if ((own_[i] + off - 1) * (own_[j] + off - 1) < product * product) continue;
      compatible_[std::size_t(i) * words_ + std::size_t(j) / word] |= std::uint64_t(1) << (std::size_t(j) % word);
      compatible_[std::size_t(j) * words_ + std::size_t(i) / word] |= std::uint64_t(1) << (std::size_t(i) % word);
    }
  }
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t i = 0; i < std::size_t(f); ++i) {
      if (possible_[i] == 0) continue;
      int partners = 0;
      for (std::size_t w = 0; w < words_; ++w) partners += std::popcount(compatible_[i * words_ + w]);
      if (partners >= left - 1) continue;
      possible_[i] = 0;
      changed = true;
      for (std::size_t j = 0; j < std::size_t(f); ++j)
        compatible_[j * words_ + i / word] &= ~(std::uint64_t(1) << (i % word));
    }
  }
  return std::count(possible_.begin(), possible_.end(), 1) >= left && enough_classes(left);
}

/// True if rows that exclude each other leave room for as many as are still to be chosen: a greedy colouring.
bool RowInertia::enough_classes(int left) const {
  std::vector<std::uint64_t> open(words_, 0), same(words_);
  for (std::size_t i = 0; i < possible_.size(); ++i)
    if (possible_[i] != 0) open[i / word] |= std::uint64_t(1) << (i % word);
  for (int classes = 0; classes < left; ++classes) {
    same = open;
    bool any = false;
    for (std::size_t w = 0; w < words_; ++w) {
      while (same[w] != 0) {
        const auto bit = std::size_t(std::countr_zero(same[w]));
        any = true;
        open[w] &= ~(std::uint64_t(1) << bit);
        same[w] &= ~(std::uint64_t(1) << bit);
        const std::uint64_t* row = &compatible_[(w * word + bit) * words_];
        for (std::size_t v = w; v < words_; ++v) same[v] &= ~row[v];
      }
    }
    if (!any) return false;
  }
  return true;
}

/// s = 1, and row i is taken, which lifts no eigenvalue to t: how many others then do.
int RowInertia::partners_after(Eigen::Index i, const Eigen::VectorXd& room) const {
  int partners = 0;
  for (Eigen::Index j = 0; j < own_.size(); ++j) {
    if (!possible(j) || room[j] < (i == j ? 2 : 1)) continue;
    const double off = std::max(rounding_[i], rounding_[j]), product = std::abs(products_(i, j)) + off;
    if (own_[j] + off + product * product / (1 - own_[i] - off) >= 1) ++partners;
  }
  return partners;
}

/// s = 1: rows that lift no eigenvalue to t are possible if enough others do beside them.
bool RowInertia::settle_partners(const Eigen::VectorXd& room, int left) {
  for (Eigen::Index i = 0; i < own_.size(); ++i) {
    if (own_[i] + 2 * rounding_.maxCoeff() >= 1) continue;
    if (partners_after(i, room) < left - 1) possible_[std::size_t(i)] = 0;
  }
  return std::accumulate(possible_.begin(), possible_.end(), 0.0) > 0;
}

/// G of both is negative definite.
bool RowInertia::excludes(Eigen::Index i, Eigen::Index j) const {
  const double off = std::max(rounding_[i], rounding_[j]), product = std::abs(products_(i, j)) + off;
  return own_[i] + off < 1 && own_[j] + off < 1 && (1 - own_[i] - off) * (1 - own_[j] - off) > product * product;
}

/// The next row of the Cholesky factor of I − V (t I − M0)⁻¹ Vᵀ of the exclusive rows; false if that is not positive
/// definite by more than its rounding.
bool RowInertia::extends_factor(int row) {
  const auto k = Eigen::Index(exclusive_.size());
  double pivot = 1 - own_[row] - 10 * double(k + 1) * rounding_.maxCoeff();
  for (Eigen::Index a = 0; a < k; ++a) {
    double value = -projected_.row(row).dot(weighted_.row(exclusive_[std::size_t(a)]));
    for (Eigen::Index c = 0; c < a; ++c) value -= factor_(a, c) * factor_(k, c);
    factor_(k, a) = value / factor_(a, a);
    pivot -= factor_(k, a) * factor_(k, a);
  }
  if (!(pivot > smallest_pivot)) return false;
  factor_(k, k) = std::sqrt(pivot);
  return true;
}

const std::vector<int>& RowInertia::exclusive(const Eigen::VectorXd& weight, const Eigen::VectorXd& room) {
  order_.clear();
  exclusive_.clear();
  if (slack_ < 1) return exclusive_;
  for (Eigen::Index i = 0; i < own_.size(); ++i)
    if (possible(i) && room[i] == 1 && own_[i] + rounding_[i] < 1) order_.push_back(int(i));
  std::stable_sort(order_.begin(), order_.end(), [&](int a, int b) { return weight[a] > weight[b]; });
  const auto size = Eigen::Index(order_.size());
  if (factor_.rows() < size) factor_.resize(size, size);
  for (const int i : order_) {
    // Where s = 1 it is enough that any two exclude each other.
    const bool joins = slack_ == 1
                           ? std::all_of(exclusive_.begin(), exclusive_.end(), [&](int j) { return excludes(i, j); })
                           : extends_factor(i);
    if (joins) exclusive_.push_back(i);
  }
  return exclusive_;
}

}  // namespace posewright
