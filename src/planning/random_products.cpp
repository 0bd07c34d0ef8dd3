#include "random_products.hpp"

#include <algorithm>
#include <limits>

namespace posewright {

void RandomProducts::products(std::span<const double> values, std::span<double> products, std::span<double> sizes) {
  if (!evaluator_->with_random(values, B_, Z_)) {
    std::fill(products.begin(), products.end(), std::numeric_limits<double>::quiet_NaN());
    return;
  }
  turned_.noalias() = B_ * T_;
  ZB_.noalias() = Z_.transpose() * B_;
  ZZ_.noalias() = Z_.transpose() * Z_;
  std::size_t at = 0;
  const auto put = [&](double product, double size) {
    products[at] = product;
    if (!sizes.empty()) sizes[at] = size;
    ++at;
  };
  put(turned_.squaredNorm(), turned_.squaredNorm());
  for (Eigen::Index j = 0; j < random_; ++j)
    for (Eigen::Index c = 0; c < B_.cols(); ++c)
      put(ZB_(j, c), sizes.empty() ? 0.0 : Z_.col(j).norm() * B_.col(c).norm());
  for (Eigen::Index j = 0; j < random_; ++j)
    for (Eigen::Index i = 0; i <= j; ++i) put(ZZ_(j, i), sizes.empty() ? 0.0 : Z_.col(j).norm() * Z_.col(i).norm());
}

void RandomProducts::quadratic(std::span<const double> values, Quadratic& at) {
  at.smallest = std::numeric_limits<double>::quiet_NaN();
  if (!evaluator_->with_random(values, B_, Z_)) return;
  turned_.noalias() = B_ * T_;
  at.plain = turned_.squaredNorm();
  at.R.noalias() = Z_.transpose() * turned_;
  at.A.noalias() = Z_.transpose() * Z_;
  at.A.diagonal().array() += 1;
  U_ = at.A.llt().solve(at.R);
  // In place of a difference of what may be far larger.
  turned_.noalias() -= Z_ * U_;
  at.smallest = turned_.squaredNorm() + U_.squaredNorm();
}

}  // namespace posewright
