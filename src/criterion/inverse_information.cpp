#include "posewright/criterion/inverse_information.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/kernels.hpp"
#include "posewright/criterion/sensitivity.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/parallel.hpp"
#include "regular.hpp"

namespace posewright {
namespace {

// An eigenvalue λ of the 2r × 2r swap matrix amplifies the rounding of V by 1/λ; below this a fresh factorisation is
// due.
constexpr double singular_swap = 1e-4;

}  // namespace

InverseInformation::InverseInformation(const BlockArray& blocks, int columns, const Eigen::MatrixXd* prior, int threads)
    : blocks_(blocks),
      prior_(prior),
      columns_(columns),
      stride_(blocks.stride()),
      rows_(blocks.rows()),
      threads_(threads),
      v_(std::size_t(columns) * std::size_t(stride_)),
      d_(blocks.count()),
      y_(std::size_t(2 * rows_ * stride_)),
      scratch_(std::size_t(2 * rows_ * stride_)),
      own_(rows_, rows_) {}

bool InverseInformation::refresh(const std::vector<int>& members, double ridge) {
  Eigen::MatrixXd m = ridge * Eigen::MatrixXd::Identity(columns_, columns_);
  if (prior_ != nullptr) m += *prior_;
  BlockArray::RowMatrix rows(Eigen::Index(members.size()) * rows_, columns_);
  for (std::size_t i = 0; i < members.size(); ++i)
    rows.middleRows(Eigen::Index(i) * rows_, rows_) = blocks_.block(std::size_t(members[i])).leftCols(columns_);
  if (rows.rows() > 0) m.selfadjointView<Eigen::Lower>().rankUpdate(rows.transpose());
  const Eigen::LLT<Eigen::MatrixXd> factor(m);
  if (!is_regular(factor)) return false;

  log_det_ = 2 * factor.matrixLLT().diagonal().array().log().sum();
  const Eigen::MatrixXd inverse_factor = factor.matrixL().solve(Eigen::MatrixXd::Identity(columns_, columns_));
  Eigen::Map<BlockArray::RowMatrix, 0, Eigen::OuterStride<>> v(v_.data(), columns_, columns_,
                                                               Eigen::OuterStride<>(stride_));
  v.noalias() = inverse_factor.transpose() * inverse_factor;

  information_traces(blocks_, inverse_factor, columns_, d_, threads_);
  return true;
}

void InverseInformation::project(int candidate, std::vector<double>& y) const {
  y.resize(std::size_t(rows_ * stride_));
  for (int i = 0; i < rows_; ++i) {
    kernels().cross(v_.data(), columns_, stride_, blocks_.row(std::size_t(candidate), i), 1, y.data() + i * stride_);
    std::fill(y.begin() + i * stride_ + columns_, y.begin() + (i + 1) * stride_, 0.0);
  }
}

void InverseInformation::cross(int candidate, const std::vector<double>& y, Eigen::MatrixXd& c) const {
  // The kernel writes rows; a column-major r × r matrix read as its transpose is put right below.
  kernels().cross(blocks_.row(std::size_t(candidate), 0), rows_, stride_, y.data(), rows_, c.data());
  c.transposeInPlace();
}

void InverseInformation::own(int candidate, std::vector<double>& y, Eigen::MatrixXd& d) const {
  project(candidate, y);
  cross(candidate, y, d);
}

void InverseInformation::measure(int candidate) {
  own(candidate, scratch_, own_);
  d_[std::size_t(candidate)] = own_.trace();
}

bool InverseInformation::change(int leave, int enter, RankChange* made) {
  if (!update(leave, enter)) return false;
  if (made == nullptr) {
    take_from_traces();
  } else {
    made->signs = sign_;
    made->entering = entering_;
    take_from_traces(*made);
  }
  return true;
}

bool InverseInformation::add(int candidate) { return update(-1, candidate); }

bool InverseInformation::update(int leave, int enter) {
  // M' = M + Uᵀ S U with U = [J_enter; J_leave], S = diag(I, −I): V' = V − V Uᵀ K⁻¹ U V, K = S + U V Uᵀ.
  int size = 0;
  const int of[2] = {enter, leave};
  for (const int i : of) {
    if (i < 0) continue;
    project(i, scratch_);
    std::copy_n(scratch_.begin(), rows_ * stride_, y_.begin() + size * stride_);
    size += rows_;
  }
  BlockArray::RowMatrix k(size, size);
  for (int i = 0, first = 0; i < 2; ++i) {
    if (of[i] < 0) continue;
    kernels().cross(blocks_.row(std::size_t(of[i]), 0), rows_, stride_, y_.data(), size, k.data() + first * size);
    k.diagonal().segment(first, rows_).array() += i == 0 ? 1.0 : -1.0;
    first += rows_;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(0.5 * (k + k.transpose()));
  const Eigen::VectorXd& lambda = eigen.eigenvalues();
  if (!(lambda.cwiseAbs().minCoeff() > singular_swap)) return false;

  log_det_ += lambda.cwiseAbs().array().log().sum();
  const Eigen::MatrixXd scale = eigen.eigenvectors() * lambda.cwiseAbs().cwiseSqrt().cwiseInverse().asDiagonal();
  Eigen::Map<const BlockArray::RowMatrix> y(y_.data(), size, stride_);
  directions_ = scale.transpose() * y;
  sign_ = lambda.array().sign();
  entering_ = eigen.eigenvectors().row(0).transpose().cwiseProduct(lambda.cwiseAbs().cwiseSqrt());
  Eigen::Map<BlockArray::RowMatrix> v(v_.data(), columns_, stride_);
  v.noalias() -= directions_.leftCols(columns_).transpose() * sign_.asDiagonal() * directions_;
  return true;
}

void InverseInformation::take_from_traces() {
  constexpr std::size_t chunk = 8192;
  parallel_for((blocks_.count() + chunk - 1) / chunk, threads_, [&](std::size_t c, int) {
    const std::size_t first = c * chunk, count = std::min(chunk, blocks_.count() - first);
    kernels().subtract_squares(blocks_.row(first, 0), count, rows_, stride_, directions_.data(), sign_.data(),
                               int(sign_.size()), d_.data() + first);
  });
}

void InverseInformation::take_from_traces(RankChange& made) {
  const auto n = Eigen::Index(blocks_.count());
  products_.resize(n, directions_.rows());
  kernels().cross(blocks_.data(), int(n), stride_, directions_.data(), int(directions_.rows()), products_.data());
  made.terms = products_;
  for (Eigen::Index l = 0; l < products_.cols(); ++l)
    for (Eigen::Index j = 0; j < n; ++j) d_[std::size_t(j)] -= made.signs[l] * made.terms(j, l) * made.terms(j, l);
}

}  // namespace posewright
