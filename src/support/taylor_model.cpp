#include "posewright/support/taylor_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <utility>

namespace posewright {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
// Twice the unit roundoff: one operation's relative error with room for that of the bounds themselves.
constexpr double epsilon = std::numeric_limits<double>::epsilon();
// Sums of a few hundred non-negative numbers are rounded by less than this.
constexpr double up = 1 + 1e-12;
// What products lose that are too small for a double.
constexpr double underflow = 1e-290;
// Functions whose argument varies by more than this share of its middle are enclosed by their range alone.
constexpr double widest = 0.95;

void append_exponents(int variables, int variable, int left, Monomials::Exponents& now,
                      std::vector<Monomials::Exponents>& all) {
  const auto k = std::size_t(variable);
  if (variable == variables - 1) {
    now[k] = std::uint8_t(left);
    all.push_back(now);
    return;
  }
  for (int e = left; e >= 0; --e) {
    now[k] = std::uint8_t(e);
    append_exponents(variables, variable + 1, left - e, now, all);
  }
}

using Coefficients = Eigen::Map<Eigen::ArrayXd>;
using ConstCoefficients = Eigen::Map<const Eigen::ArrayXd>;

Coefficients array(std::vector<double>& c) { return {c.data(), Eigen::Index(c.size())}; }
ConstCoefficients array(std::span<const double> c) { return {c.data(), Eigen::Index(c.size())}; }

using Norms = std::array<double, Monomials::most_degree + 1>;

/// Four sums side by side, in this order on every processor.
double sum_of_sizes(std::span<const double> c) {
  std::array<double, 4> sums{};
  std::size_t i = 0;
  for (; i + 4 <= c.size(); i += 4)
    for (std::size_t k = 0; k < 4; ++k) sums[k] += std::abs(c[i + k]);
  for (std::size_t k = 0; i < c.size(); ++i, ++k) sums[k] += std::abs(c[i]);
  return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

/// Σ |coefficients| of each degree, rounded down at worst by what `up` makes good.
Norms norms_of(const TaylorModel& f) {
  Norms norms{};
  const std::span<const double> c = f.coefficients();
  if (f.monomials() == nullptr) return {std::abs(c[0])};
  std::size_t first = 0;
  for (int d = 0; first < c.size(); ++d) {
    const std::size_t end = std::min(c.size(), f.monomials()->count_to(d));
    norms[std::size_t(d)] = sum_of_sizes(c.subspan(first, end - first));
    first = end;
  }
  return norms;
}

/// Coefficients up to degree 2 that are not zero: nearly all that a factor has to multiply.
std::size_t large_terms(const TaylorModel& f) {
  const std::span<const double> c = f.coefficients();
  const auto leading = c.first(std::min(c.size(), f.monomials()->count_to(std::min(2, f.monomials()->degree()))));
  return std::size_t(std::count_if(leading.begin(), leading.end(), [](double x) { return x != 0; }));
}

double clean(double radius) { return radius < infinity ? radius : infinity; }

}  // namespace

Monomials::Monomials(int variables, int degree) : variables_(variables), degree_(degree) {
  for (int d = 0; d <= degree; ++d) {
    Exponents now{};
    append_exponents(variables, 0, d, now, exponents_);
    count_to_.push_back(exponents_.size());
    degrees_.resize(exponents_.size(), d);
  }
  std::map<Exponents, std::uint32_t> index;
  for (std::size_t i = 0; i < exponents_.size(); ++i) index[exponents_[i]] = std::uint32_t(i);
  for (std::size_t i = 0; i < exponents_.size(); ++i) {
    first_product_.push_back(products_.size());
    for (std::size_t j = 0; j < count_to(degree - degrees_[i]); ++j) {
      Exponents sum = exponents_[i];
      for (std::size_t k = 0; k < sum.size(); ++k) sum[k] = std::uint8_t(sum[k] + exponents_[j][k]);
      products_.push_back(index.at(sum));
    }
  }
}

const Monomials& Monomials::of(int variables, int degree) {
  static std::mutex mutex;
  static std::array<std::array<std::unique_ptr<Monomials>, most_degree + 1>, most_variables> made;
  const std::scoped_lock lock(mutex);
  auto& place = made.at(std::size_t(variables - 1)).at(std::size_t(degree));
  if (place == nullptr) place = std::make_unique<Monomials>(variables, degree);
  return *place;
}

TaylorModel TaylorModel::unknown() {
  TaylorModel f;
  f.radius_ = infinity;
  return f;
}

TaylorModel TaylorModel::variable(const Monomials& monomials, int k, double lower, double upper) {
  const double middle = 0.5 * lower + 0.5 * upper;
  TaylorModel x(middle);
  x.monomials_ = &monomials;
  x.coefficients_.resize(monomials.count_to(1), 0.0);
  // Exponents of degree 1 are in the order of the variables.
  const double half = std::max(upper - middle, middle - lower) * (1 + 2 * epsilon);
  x.coefficients_[std::size_t(1 + k)] = half;
  x.radius_ = epsilon * std::abs(middle) + 4 * epsilon * half;
  return x;
}

TaylorModel TaylorModel::between(double lower, double upper) {
  TaylorModel f(0.5 * lower + 0.5 * upper);
  f.radius_ = clean(std::max(upper - f.constant(), f.constant() - lower) * (1 + 4 * epsilon) + underflow);
  return f;
}

bool TaylorModel::known() const { return radius_ < infinity; }

double TaylorModel::variation() const { return array(coefficients().subspan(1)).abs().sum() * up; }

double TaylorModel::lower() const {
  const double reach = (variation() + radius_) * up;
  return constant() - reach - epsilon * (std::abs(constant()) + reach);
}

double TaylorModel::upper() const {
  const double reach = (variation() + radius_) * up;
  return constant() + reach + epsilon * (std::abs(constant()) + reach);
}

TaylorModel TaylorModel::widened(double by) const {
  TaylorModel f = *this;
  f.radius_ = clean((f.radius_ + by) * up);
  return f;
}

TaylorModel TaylorModel::with_radius(double radius) const {
  TaylorModel f = *this;
  f.radius_ = radius;
  return f;
}

void TaylorModel::take_monomials(const TaylorModel& other) {
  if (monomials_ == nullptr) monomials_ = other.monomials_;
  if (coefficients_.size() < other.coefficients_.size()) coefficients_.resize(other.coefficients_.size(), 0.0);
}

void TaylorModel::add(double factor, const TaylorModel& other) {
  take_monomials(other);
  const auto from = array(other.coefficients());
  auto to = array(coefficients_).head(from.size());
  to += factor * from;
  const double size = std::abs(factor) * from.abs().sum() * up + to.abs().sum();
  radius_ = clean((radius_ + std::abs(factor) * other.radius_ + epsilon * size + underflow) * up);
}

TaylorModel& TaylorModel::operator+=(const TaylorModel& other) {
  take_monomials(other);
  const auto from = array(other.coefficients());
  auto to = array(coefficients_).head(from.size());
  to += from;
  const double size = to.abs().sum();
  radius_ = clean((radius_ + other.radius_ + epsilon * size) * up);
  return *this;
}

TaylorModel& TaylorModel::operator-=(const TaylorModel& other) {
  take_monomials(other);
  const auto from = array(other.coefficients());
  auto to = array(coefficients_).head(from.size());
  to -= from;
  const double size = to.abs().sum();
  radius_ = clean((radius_ + other.radius_ + epsilon * size) * up);
  return *this;
}

TaylorModel operator-(TaylorModel a) {
  for (double& c : a.coefficients_) c = -c;
  return a;
}

TaylorModel operator*(const TaylorModel& a, const TaylorModel& b) {
  if (a.coefficients_.size() > b.coefficients_.size()) return b * a;
  if (a.coefficients_.size() == 1) {
    // A factor that is known to lie within a radius of a number.
    TaylorModel product = b;
    array(product.coefficients_) *= a.coefficients_[0];
    const double size = array(product.coefficients_).abs().sum();
    const double b_size = a.radius_ > 0 ? (b.variation() + std::abs(b.constant()) + b.radius_) * up : 0.0;
    product.radius_ =
        clean((std::abs(a.coefficients_[0]) * b.radius_ + a.radius_ * b_size + epsilon * size + underflow) * up);
    return product;
  }
  // A rotation's entries are functions of three variables: most of their coefficients are zero.
  if (a.coefficients_.size() == b.coefficients_.size() && large_terms(b) < large_terms(a)) return b * a;
  const Monomials& m = *a.monomials_;
  const Norms norms_a = norms_of(a), norms_b = norms_of(b);
  int degree_a = m.degree_of(a.coefficients_.size() - 1), degree_b = m.degree_of(b.coefficients_.size() - 1);
  TaylorModel product;
  product.monomials_ = &m;
  product.coefficients_.assign(m.count_to(std::min(m.degree(), degree_a + degree_b)), 0.0);
  // Products with the constants stand side by side.
  array(product.coefficients_).head(Eigen::Index(b.coefficients_.size())) = a.constant() * array(b.coefficients());
  array(product.coefficients_).segment(1, Eigen::Index(a.coefficients_.size()) - 1) +=
      b.constant() * array(a.coefficients().subspan(1));
  double* __restrict out = product.coefficients_.data();
  const double* __restrict from = b.coefficients_.data();
  for (std::size_t i = 1; i < std::min(a.coefficients_.size(), m.count_to(m.degree() - 1)); ++i) {
    const double x = a.coefficients_[i];
    if (x == 0) continue;
    const std::size_t terms = std::min(b.coefficients_.size(), m.count_to(m.degree() - m.degree_of(i)));
    const std::uint32_t* __restrict to = m.products(i);
    for (std::size_t j = 1; j < terms; ++j) out[to[j]] += x * from[j];
  }
  double size_a = 0, size_b = 0, cut = 0;
  for (int i = 0; i <= degree_a; ++i) {
    size_a += norms_a[std::size_t(i)];
    for (int j = std::max(0, m.degree() - i + 1); j <= degree_b; ++j)
      cut += norms_a[std::size_t(i)] * norms_b[std::size_t(j)];
  }
  for (int j = 0; j <= degree_b; ++j) size_b += norms_b[std::size_t(j)];
  // A coefficient is the sum of 2^degree products at most: that many exponents divide a monomial.
  const double rounding = epsilon * double(std::size_t(2) << m.degree()) * size_a * size_b;
  product.radius_ = clean((cut + rounding + a.radius_ * (size_b + b.radius_) + b.radius_ * size_a + underflow) * up);
  return product;
}

TaylorModel composed(const TaylorModel& t, std::span<const double> series) {
  TaylorModel sum(series.back());
  for (std::size_t k = series.size() - 1; k-- > 0;) {
    sum = sum * t;
    sum += TaylorModel(series[k]);
  }
  return sum;
}

TaylorModel inverse(const TaylorModel& f) {
  const double scale = 1 / f.constant(), lower = f.lower(), upper = f.upper();
  if (!f.known() || !std::isfinite(scale) || !(lower > 0 || upper < 0)) return TaylorModel::unknown();
  TaylorModel t = f * TaylorModel(scale);
  t -= TaylorModel(1.0);
  const double tau = (std::abs(t.constant()) + t.variation() + t.radius()) * up;
  if (!(tau < widest)) return TaylorModel::between(1 / upper * (1 - 2 * epsilon), 1 / lower * (1 + 2 * epsilon));
  const int degree = f.monomials_ == nullptr ? 1 : f.monomials_->degree();
  std::array<double, Monomials::most_degree + 1> series{};
  for (int k = 0; k <= degree; ++k) series[std::size_t(k)] = k % 2 == 0 ? 1 : -1;
  const double rest = std::pow(tau, degree + 1) / (1 - tau);
  return composed(t, std::span(series).first(std::size_t(degree + 1))).widened(rest * up) * TaylorModel(scale);
}

TaylorModel sqrt(const TaylorModel& f) {
  const double upper = f.upper(), lower = std::max(0.0, f.lower());
  if (!f.known() || !(upper >= 0)) return TaylorModel::unknown();
  const auto by_range = [&] {
    return TaylorModel::between(std::sqrt(lower) * (1 - 2 * epsilon), std::sqrt(upper) * (1 + 2 * epsilon));
  };
  const double scale = 1 / f.constant();
  if (!(lower > 0) || !std::isfinite(scale) || !(scale > 0)) return by_range();
  TaylorModel t = f * TaylorModel(scale);
  t -= TaylorModel(1.0);
  const double tau = (std::abs(t.constant()) + t.variation() + t.radius()) * up;
  if (!(tau < widest)) return by_range();
  const int degree = f.monomials_ == nullptr ? 1 : f.monomials_->degree();
  // Binomial coefficients of 1/2 are whole numbers over powers of 2: exact.
  std::array<double, Monomials::most_degree + 1> series{};
  double next = 1;
  for (int k = 0; k <= degree; ++k) {
    series[std::size_t(k)] = next;
    next *= (0.5 - k) / (k + 1);
  }
  const double rest = std::abs(next) * std::pow(tau, degree + 1) * std::pow(1 - tau, -0.5 - degree);
  const TaylorModel root = composed(t, std::span(series).first(std::size_t(degree + 1))).widened(rest * up);
  const double factor = std::sqrt(f.constant());
  // √f = √(1 + t) / √scale, and the factor is that to a few roundings.
  return (root * TaylorModel(factor)).widened(4 * epsilon * factor * (std::sqrt(1 + tau) + rest));
}

namespace {

/// sin (shift 0) or cos (shift 1) about the middle of f.
TaylorModel wave(const TaylorModel& f, const TaylorModel& t, int shift) {
  const double c = f.constant();
  const double values[4] = {std::sin(c), std::cos(c), -std::sin(c), -std::cos(c)};
  const int degree = f.monomials() == nullptr ? 1 : f.monomials()->degree();
  std::array<double, Monomials::most_degree + 1> series{};
  double factorial = 1;
  for (int k = 0; k <= degree; ++k) {
    series[std::size_t(k)] = values[(k + shift) % 4] / factorial;
    factorial *= k + 1;
  }
  const double tau = (t.variation() + t.radius()) * up;
  // Series and rest; its coefficients are rounded by a few units, and tau is an angle of any size.
  const double rest = std::pow(tau, degree + 1) / factorial * up + 8 * epsilon * std::exp(std::min(tau, 700.0));
  return composed(t, std::span(series).first(std::size_t(degree + 1))).widened(rest);
}

}  // namespace

TaylorModel TaylorModel::without_constant() const {
  TaylorModel t = *this;
  t.coefficients_[0] = 0;
  return t;
}

TaylorModel sin(const TaylorModel& f) { return f.known() ? wave(f, f.without_constant(), 0) : TaylorModel::unknown(); }

TaylorModel cos(const TaylorModel& f) { return f.known() ? wave(f, f.without_constant(), 1) : TaylorModel::unknown(); }

}  // namespace posewright
