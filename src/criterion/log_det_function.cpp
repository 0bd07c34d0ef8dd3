#include <cmath>
#include <limits>

#include "gram.hpp"
#include "posewright/criterion/determinant.hpp"
#include "posewright/support/dense.hpp"
#include "regular.hpp"

namespace posewright {
namespace {

class LogDetExpansion : public Expansion {
 public:
  LogDetExpansion(const Eigen::LLT<Eigen::MatrixXd>& llt, int nuisance) : nuisance_(nuisance) {
    const Eigen::Index m = llt.rows();
    value = log_det_of_last(llt, m - nuisance);
    inverse_ = llt.matrixL().solve(Eigen::MatrixXd::Identity(m, m)).transpose();
    factor = inverse_;
    // The leading columns of L⁻ᵀ are the nuisance block's own inverse.
    factor.leftCols(nuisance).setZero();
  }

  /// ‖Z_i Z_jᵀ‖²_F, Z = J L⁻ᵀ, less the same of the nuisance columns.
  void curvature(const BlockArray::RowMatrix& rows, int r, Eigen::MatrixXd& H) const override {
    const BlockArray::RowMatrix Z = rows * inverse_;
    if (r == 1) {
      gram_of(Z, H);
      H = H.cwiseAbs2();
      if (nuisance_ == 0) return;
      Eigen::MatrixXd part;
      gram_of(Z.leftCols(nuisance_), part);
      H -= part.cwiseAbs2();
      return;
    }
    gram(symmetric_products(Z, r), H);
  }

  BlockArray::RowMatrix curvature_factor(const BlockArray::RowMatrix& rows, int r, Eigen::Index most) const override {
    if (pairs() > most) return {};
    return symmetric_products(rows * inverse_, r);
  }

 private:
  Eigen::Index pairs() const {
    const Eigen::Index m = inverse_.cols(), k = nuisance_;
    return m * (m + 1) / 2 - k * (k + 1) / 2;
  }

  /// ‖Z_i Z_jᵀ‖² = ⟨Z_iᵀZ_i, Z_jᵀZ_j⟩: a row for each block's symmetric product, without what is nuisance on both
  /// sides.
  BlockArray::RowMatrix symmetric_products(const BlockArray::RowMatrix& Z, int r) const {
    const Eigen::Index m = Z.cols(), s = Z.rows() / r;
    BlockArray::RowMatrix products = padded_rows(s, pairs());
    Eigen::MatrixXd square(m, m);
    for (Eigen::Index i = 0; i < s; ++i) {
      const auto zi = Z.middleRows(i * r, r);
      square.noalias() = zi.transpose() * zi;
      Eigen::Index k = 0;
      for (Eigen::Index b = nuisance_; b < m; ++b) {
        for (Eigen::Index a = 0; a < b; ++a) products(i, k++) = std::sqrt(2.0) * square(a, b);
        products(i, k++) = square(b, b);
      }
    }
    return products;
  }

  int nuisance_;
  Eigen::MatrixXd inverse_;  // L⁻ᵀ
};

/// Φ of M₀ = L Lᵀ, and what a block adds to it.
class LogDetWithBlock : public BlockFunction {
 public:
  LogDetWithBlock(const Eigen::LLT<Eigen::MatrixXd>& factor, int nuisance)
      : inverse_(factor.matrixL().solve(Eigen::MatrixXd::Identity(factor.rows(), factor.rows()))),
        nuisance_(nuisance),
        value_(log_det_of_last(factor, factor.rows() - nuisance)) {}
  double value(const BlockArray::ConstMap& J) override {
    Z_.noalias() = inverse_ * J.transpose();
    return log_det_with_block(value_, Z_, nuisance_);
  }

 private:
  Eigen::MatrixXd inverse_;
  Eigen::Index nuisance_;
  double value_;
  Eigen::MatrixXd Z_;
};

}  // namespace

double LogDetFunction::value(const Eigen::MatrixXd& information) const {
  const Eigen::LLT<Eigen::MatrixXd> factor(information);
  if (!is_regular(factor)) return -std::numeric_limits<double>::infinity();
  return log_det_of_last(factor, interest_);
}

std::unique_ptr<BlockFunction> LogDetFunction::with_block(const Eigen::MatrixXd& information) const {
  const Eigen::LLT<Eigen::MatrixXd> factor(information);
  if (!is_regular(factor)) return InformationFunction::with_block(information);
  return std::make_unique<LogDetWithBlock>(factor, nuisance_);
}

Eigen::MatrixXd LogDetFunction::gradient(const Eigen::MatrixXd& information) const {
  const Eigen::Index m = information.rows();
  const Eigen::LLT<Eigen::MatrixXd> factor(information);
  const Eigen::MatrixXd inverse = factor.matrixL().solve(Eigen::MatrixXd::Identity(m, m));
  return inverse.bottomRows(interest_).transpose() * inverse.bottomRows(interest_);
}

std::unique_ptr<Expansion> LogDetFunction::expand(const Eigen::MatrixXd& information) const {
  const Eigen::LLT<Eigen::MatrixXd> factor(information);
  if (!is_regular(factor)) return nullptr;
  return std::make_unique<LogDetExpansion>(factor, nuisance_);
}

}  // namespace posewright
