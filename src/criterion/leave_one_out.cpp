#include "posewright/criterion/leave_one_out.hpp"

#include <cmath>
#include <limits>

#include "kernels/bounds.hpp"
#include "posewright/criterion/summed_information.hpp"
#include "posewright/support/dense.hpp"
#include "regular.hpp"

namespace posewright {
namespace {

// Ridge where a member is indispensable; in whitened coordinates an average pose adds the identity.
constexpr double ridge = 1e-6;
// Pivots of I − D_k below which what is left is told from a change of rank r too roughly for a bound.
constexpr double nearly_indispensable = 1e-4;
// What rounding may take off a bound, relatively and of the size of one pose's information.
constexpr double rounding = 1e-9;

int round16(int x) { return (x + 15) / 16 * 16; }

}  // namespace

LeaveOneOut::LeaveOneOut(const BlockArray& blocks, int nuisance, const Eigen::MatrixXd* prior)
    : blocks_(blocks), prior_(prior), nuisance_(nuisance), padded_nuisance_(round16(nuisance)) {
  const int m = blocks.columns(), interest_tiles = round16(m - nuisance) / 16;
  tiles_ = padded_nuisance_ / 16 + interest_tiles;
  t_.assign(std::size_t(m * 16 * tiles_), 0.0);
  scratch_.resize(std::size_t(blocks.rows() * (16 * tiles_ + 2 * blocks.rows())));
  single_scratch_.resize(std::size_t(3 * blocks.stride()));
  for (std::size_t j = 0; j < blocks.count(); ++j) size_.push_back(blocks.block(j).norm());
  for (int i = 0; i < padded_nuisance_ / 16; ++i) tile_rows_.push_back(std::min(nuisance, 16 * (i + 1)));
  for (int i = 0; i < interest_tiles; ++i) tile_rows_.push_back(std::min(m, nuisance + 16 * (i + 1)));
}

bool LeaveOneOut::set_members(const std::vector<int>& members) {
  information_ = summed_information(blocks_, prior_, members);
  factorise();
  return std::isfinite(value_);
}

void LeaveOneOut::exchange(int leave, int enter) {
  information_ = swapped(leave, enter);
  factorise();
}

Eigen::MatrixXd LeaveOneOut::swapped(int leave, int enter) const {
  Eigen::MatrixXd changed = information_;
  if (enter >= 0) changed += block_information(blocks_, enter);
  if (leave >= 0) changed -= block_information(blocks_, leave);
  return changed;
}

void LeaveOneOut::factorise() {
  const Eigen::Index m = information_.cols();
  Eigen::LLT<Eigen::MatrixXd> factor(information_);
  value_ = is_regular(factor) ? log_det_of_last(factor, factor.rows() - nuisance_) : -infinity;
  if (!std::isfinite(value_)) factor.compute(information_ + ridge * Eigen::MatrixXd::Identity(m, m));
  reference_ = log_det_of_last(factor, factor.rows() - nuisance_);
  inverse_factor_ = factor.matrixL().solve(Eigen::MatrixXd::Identity(m, m));
  d_is_of_now_ = false;
}

void LeaveOneOut::SingleCopy::set(const Eigen::MatrixXd& matrix) {
  rows = int(matrix.rows());
  columns = int(matrix.cols());
  data.assign(std::size_t(rows * round16(columns)), 0.0F);
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) data[std::size_t(i * round16(columns) + j)] = float(matrix(i, j));
  // A sum of n products is wrong by no more than γ_n of the sum of their sizes (Higham 2002, section 3.1); both factors
  // were rounded before.
  error = (rows + 8) * 0x1p-24 * matrix.norm();
}

SingleMatrix LeaveOneOut::SingleCopy::view(int leading) const {
  return {data.data(), rows, columns, round16(columns), leading, error};
}

double LeaveOneOut::sensitivity(int j) const {
  const Eigen::MatrixXd Z =
      inverse_factor_.bottomRows(inverse_factor_.rows() - nuisance_) * blocks_.block(std::size_t(j)).transpose();
  return Z.squaredNorm();
}

const std::vector<double>& LeaveOneOut::sensitivity_bounds() const {
  // Of several changes in a row, as a perturbation makes them, nobody asks in between.
  if (d_is_of_now_) return d_;
  SingleCopy T;
  T.set(inverse_factor_.bottomRows(inverse_factor_.rows() - nuisance_).transpose());
  d_.resize(blocks_.count());
  bound_kernels().traces(blocks_.data(), blocks_.count(), blocks_.rows(), blocks_.stride(), size_.data(),
                         T.view(nuisance_), single_scratch_.data(), d_.data());
  d_is_of_now_ = true;
  return d_;
}

void LeaveOneOut::leave(int k) {
  const Eigen::Index m = information_.cols();
  const Eigen::MatrixXd rest = swapped(k, -1);
  Eigen::LLT<Eigen::MatrixXd> factor(rest);
  const bool regular = std::isfinite(value_) && is_regular(factor);
  if (!regular) factor.compute(rest + ridge * Eigen::MatrixXd::Identity(m, m));
  without_ = log_det_of_last(factor, factor.rows() - nuisance_);
  rest_factor_ = factor.matrixL().solve(Eigen::MatrixXd::Identity(m, m));
  tile();
  prepare_bound(k, regular);
}

void LeaveOneOut::prepare_bound(int k, bool regular) {
  leaving_sensitivity_ = k < 0 ? 0 : sensitivity(k);
  has_bound_ = false;
  if (k < 0 || !regular) return;
  const auto r = Eigen::Index(blocks_.rows());
  const Eigen::MatrixXd W = inverse_factor_.triangularView<Eigen::Lower>() * blocks_.block(std::size_t(k)).transpose();
  // Of all columns, then of the nuisance ones alone: their factor is the leading part of the whole one.
  for (const Eigen::Index columns : {W.rows(), Eigen::Index(nuisance_)}) {
    if (columns == 0) continue;
    const auto own = W.topRows(columns);
    const Eigen::LLT<Eigen::MatrixXd> rest(Eigen::MatrixXd(Eigen::MatrixXd::Identity(r, r) - own.transpose() * own));
    if (rest.info() != Eigen::Success || !(rest.matrixLLT().diagonal().minCoeff() > nearly_indispensable)) return;
    (columns == W.rows() ? half_ : nuisance_half_)
        .set(inverse_factor_.topLeftCorner(columns, columns).triangularView<Eigen::Lower>().transpose() *
             Eigen::MatrixXd(rest.matrixL().solve(own.transpose()).transpose()));
  }
  has_bound_ = true;
}

std::size_t LeaveOneOut::next(std::size_t first, double wanted, const std::vector<unsigned char>& blocked) const {
  const std::vector<double>& d = sensitivity_bounds();
  const int r = blocks_.rows();
  double least = leaving_sensitivity_ + wanted;
  if (std::isfinite(value_)) least = std::max(least, (1 - rounding) * r * std::expm1(wanted / r) - rounding);
  if (!has_bound_) {
    for (std::size_t j = first; j < blocks_.count(); ++j)
      if (d[j] > least && blocked[j] == 0) return j;
    return blocks_.count();
  }
  const double least_sum = (1 - rounding) * r * std::expm1((wanted + reference_ - without_) / r) - rounding;
  return bound_kernels().next_between(blocks_.data(), first, blocks_.count(), r, blocks_.stride(), size_.data(),
                                      half_.view(half_.rows), nuisance_half_.view(nuisance_half_.rows), d.data(),
                                      blocked.data(), least, least_sum, single_scratch_.data());
}

void LeaveOneOut::tile() {
  const int stride = 16 * tiles_;
  for (int k = 0; k < int(rest_factor_.rows()); ++k)
    for (int i = k; i < int(rest_factor_.rows()); ++i)
      t_[std::size_t(k * stride + (i < nuisance_ ? i : padded_nuisance_ + i - nuisance_))] = rest_factor_(i, k);
}

double LeaveOneOut::gain_bound(int j) const {
  const double ratio =
      bound_kernels().determinant_ratio(blocks_.row(std::size_t(j), 0), blocks_.rows(), blocks_.stride(), t_.data(),
                                        16 * tiles_, tile_rows_.data(), tiles_, padded_nuisance_, scratch_.data());
  const double gain = without_ + std::log(ratio) - reference_;
  return gain + rounding * (1 + std::abs(gain));
}

double LeaveOneOut::gain(int j) const {
  const Eigen::MatrixXd Z = rest_factor_.triangularView<Eigen::Lower>() * blocks_.block(std::size_t(j)).transpose();
  return log_det_with_block(without_, Z, nuisance_) - reference_;
}

double LeaveOneOut::exact(int k, int j) const {
  const Eigen::LLT<Eigen::MatrixXd> factor(swapped(k, j));
  return is_regular(factor) ? log_det_of_last(factor, factor.rows() - nuisance_) : -infinity;
}

}  // namespace posewright
