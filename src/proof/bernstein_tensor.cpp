#include "bernstein_tensor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "bernstein.hpp"

namespace posewright {
namespace {

/// Coefficient i of degree m of x^k on [−1, 1]: Σ_j C(i, j) C(m − i, k − j) (−1)^{k − j} / C(m, k), a whole number over
/// another, at most 1.
double of_power(int m, int i, int k) {
  double sum = 0;
  for (int j = std::max(0, k - (m - i)); j <= std::min(i, k); ++j)
    sum += ((k - j) % 2 == 0 ? 1 : -1) * binomial(i, j) * binomial(m - i, k - j);
  return sum / binomial(m, k);
}

constexpr std::size_t most = Monomials::most_degree + 1;

/// of_power() of each degree, coefficient and power.
const auto& powers() {
  static const auto made = [] {
    std::array<std::array<std::array<double, most>, most>, most> w{};
    for (std::size_t m = 0; m < most; ++m)
      for (std::size_t i = 0; i <= m; ++i)
        for (std::size_t k = 0; k <= m; ++k) w[m][i][k] = of_power(int(m), int(i), int(k));
    return w;
  }();
  return made;
}

}  // namespace

void BernsteinTensor::choose_degrees(const TaylorModel& f, std::size_t box, double small) {
  const Monomials& m = *f.monomials();
  const auto n = std::size_t(m.variables());
  // Sizes of the monomials by their degree in each variable.
  std::vector<std::array<double, Monomials::most_degree + 1>> sizes(n);
  for (std::size_t i = 0; i < f.terms(); ++i)
    for (std::size_t a = 0; a < n; ++a) sizes[a][m.exponents(i)[a]] += std::abs(f.coefficient(i, box));
  degrees_.assign(n, 0);
  for (std::size_t a = 0; a < n; ++a) {
    double left = small / double(n);
    int degree = m.degree_of(f.terms() - 1);
    while (degree > 1 && sizes[a][std::size_t(degree)] <= left) left -= sizes[a][std::size_t(degree--)];
    degrees_[a] = degree;
  }
}

void BernsteinTensor::take(const TaylorModel& f, std::size_t box, double small) {
  if (f.monomials() == nullptr) {
    degrees_.clear();
    now_.assign(1, f.constant(box));
    beyond_ = f.radius(box);
    return;
  }
  choose_degrees(f, box, small);
  const Monomials& m = *f.monomials();
  const std::size_t n = degrees_.size();
  std::vector<std::size_t> strides(n);
  std::size_t size = 1;
  for (std::size_t a = n; a-- > 0;) {
    strides[a] = size;
    size *= std::size_t(degrees_[a] + 1);
  }
  now_.assign(size, 0.0);
  next_.resize(size);
  double all = 0, left_out = 0;
  for (std::size_t i = 0; i < f.terms(); ++i) {
    const double c = f.coefficient(i, box);
    std::size_t at = 0;
    bool inside = true;
    for (std::size_t a = 0; a < n; ++a) {
      inside = inside && m.exponents(i)[a] <= degrees_[a];
      at += m.exponents(i)[a] * strides[a];
    }
    (inside ? all : left_out) += std::abs(c);
    if (inside) now_[at] = c;
  }
  // Where the last axes are done first, many slices of the others are still zero.
  for (std::size_t a = n; a-- > 0;) {
    const int degree = degrees_[a];
    const auto terms = std::size_t(degree + 1);
    // Slices along this axis that are zero.
    empty_.resize(size / strides[a]);
    for (std::size_t r = 0; r < empty_.size(); ++r) {
      const double* from = now_.data() + r * strides[a];
      empty_[r] = std::all_of(from, from + strides[a], [](double x) { return x == 0; });
    }
    for (std::size_t o = 0; o < size / (terms * strides[a]); ++o)
      for (std::size_t i = 0; i < terms; ++i) {
        double* to = next_.data() + (o * terms + i) * strides[a];
        std::fill_n(to, strides[a], 0.0);
        for (std::size_t k = 0; k < terms; ++k) {
          const double w = powers()[std::size_t(degree)][i][k];
          const double* from = now_.data() + (o * terms + k) * strides[a];
          // Monomials of a high degree in several variables have none.
          if (empty_[o * terms + k]) continue;
          for (std::size_t x = 0; x < strides[a]; ++x) to[x] += w * from[x];
        }
      }
    now_.swap(next_);
  }
  // Each coefficient is a sum of all with factors of 1 at most, a dozen operations an axis.
  beyond_ = (f.radius(box) + left_out + 16.0 * double(n) * epsilon * all) * (1 + 1e-12);
}

double BernsteinTensor::largest() const {
  const double top = *std::max_element(now_.begin(), now_.end());
  return top + beyond_ + epsilon * (std::abs(top) + beyond_);
}

std::array<int, 2> BernsteinTensor::most_varied() const {
  std::array<int, 2> most{0, -1};
  std::array<double, 2> largest{-1, -1};
  std::size_t stride = 1;
  for (std::size_t a = degrees_.size(); a-- > 0;) {
    const auto terms = std::size_t(degrees_[a] + 1);
    double variation = 0;
    for (std::size_t o = 0; o < now_.size() / (terms * stride); ++o)
      for (std::size_t x = 0; x < stride; ++x) {
        const double* first = now_.data() + o * terms * stride + x;
        double sum = 0;
        for (std::size_t k = 0; k + 1 < terms; ++k) sum += std::abs(first[(k + 1) * stride] - first[k * stride]);
        variation = std::max(variation, sum);
      }
    stride *= terms;
    if (variation > largest[0]) {
      if (largest[0] >= 0) most[1] = most[0];
      largest = {variation, largest[0]};
      most[0] = int(a);
    } else if (variation > largest[1]) {
      largest[1] = variation;
      most[1] = int(a);
    }
  }
  return most;
}

}  // namespace posewright
