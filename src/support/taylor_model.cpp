#include "posewright/support/taylor_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <utility>

#include "posewright/support/instruction_set.hpp"
#include "taylor/taylor_kernels.hpp"

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

using Values = TaylorModel::Values;
using Norms = std::array<Values, Monomials::most_degree + 1>;
constexpr std::size_t boxes = TaylorModel::boxes;
static_assert(boxes == taylor_lanes);

const TaylorKernels& kernels() {
#if defined(__x86_64__)
  if (instruction_set() == InstructionSet::avx512) return taylor_kernels_avx512;
  if (instruction_set() == InstructionSet::avx2) return taylor_kernels_avx2;
#endif
  return taylor_kernels_sse2;
}

Values all(double value) {
  Values result;
  result.fill(value);
  return result;
}

Values each(const auto& of) {
  Values result;
  for (std::size_t k = 0; k < boxes; ++k) result[k] = of(k);
  return result;
}

/// Σ |coefficients| of each degree, rounded down at worst by what `up` makes good.
Norms norms_of(const TaylorModel& f) {
  Norms norms{};
  std::size_t first = 0;
  for (std::size_t d = 0; first < f.terms(); ++d) {
    const std::size_t end = f.monomials() == nullptr ? 1 : std::min(f.terms(), f.monomials()->count_to(int(d)));
    kernels().sum_sizes(f.coefficients() + boxes * first, end - first, norms[d].data());
    first = end;
  }
  return norms;
}

bool is_zero(const double* values) {
  return std::all_of(values, values + boxes, [](double x) { return x == 0; });
}

/// Coefficients up to degree 2 that are not zero: nearly all that a factor has to multiply.
std::size_t large_terms(const TaylorModel& f) {
  const std::size_t leading = std::min(f.terms(), f.monomials()->count_to(std::min(2, f.monomials()->degree())));
  std::size_t count = 0;
  for (std::size_t i = 0; i < leading; ++i) count += std::size_t(!is_zero(f.coefficients() + boxes * i));
  return count;
}

bool known_everywhere(const TaylorModel& f) {
  for (std::size_t k = 0; k < boxes; ++k)
    if (!f.known(k)) return false;
  return true;
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

TaylorModel::TaylorModel(double constant) : coefficients_(boxes, constant) {}

TaylorModel TaylorModel::constants(const Values& constants) {
  TaylorModel f;
  std::copy(constants.begin(), constants.end(), f.coefficients_.begin());
  return f;
}

TaylorModel TaylorModel::variable(const Monomials& monomials, int k, const Values& lower, const Values& upper) {
  TaylorModel x;
  x.monomials_ = &monomials;
  x.coefficients_.resize(boxes * monomials.count_to(1), 0.0);
  for (std::size_t box = 0; box < boxes; ++box) {
    const double middle = 0.5 * lower[box] + 0.5 * upper[box];
    const double half = std::max(upper[box] - middle, middle - lower[box]) * (1 + 2 * epsilon);
    x.coefficients_[box] = middle;
    // Exponents of degree 1 are in the order of the variables.
    x.coefficients_[boxes * std::size_t(1 + k) + box] = half;
    x.radius_[box] = epsilon * std::abs(middle) + 4 * epsilon * half;
  }
  return x;
}

TaylorModel TaylorModel::variable(const Monomials& monomials, int k, double lower, double upper) {
  return variable(monomials, k, all(lower), all(upper));
}

bool TaylorModel::is_zero() const {
  return monomials_ == nullptr && posewright::is_zero(coefficients_.data()) && posewright::is_zero(radius_.data());
}

void TaylorModel::put_constant(std::size_t box, double constant) {
  for (std::size_t i = 0; i < terms(); ++i) coefficients_[boxes * i + box] = 0.0;
  coefficients_[box] = constant;
}

void TaylorModel::put_between(std::size_t box, double lower, double upper) {
  const double middle = 0.5 * lower + 0.5 * upper;
  put_constant(box, middle);
  radius_[box] = clean(std::max(upper - middle, middle - lower) * (1 + 4 * epsilon) + underflow);
}

void TaylorModel::put_unknown(std::size_t box) {
  put_constant(box, 0.0);
  radius_[box] = infinity;
}

void TaylorModel::clear_unknown() {
  for (std::size_t box = 0; box < boxes; ++box)
    if (!known(box)) put_constant(box, 0.0);
}

void TaylorModel::take_box(std::size_t box, const TaylorModel& other) {
  take_monomials(other);
  for (std::size_t i = 0; i < terms(); ++i)
    coefficients_[boxes * i + box] = i < other.terms() ? other.coefficient(i, box) : 0.0;
  radius_[box] = other.radius_[box];
}

bool TaylorModel::known(std::size_t box) const { return radius_[box] < infinity; }

Values TaylorModel::variations() const {
  Values sizes;
  kernels().sum_sizes(coefficients_.data() + boxes, terms() - 1, sizes.data());
  for (double& size : sizes) size *= up;
  return sizes;
}

Values TaylorModel::lowers() const {
  const Values variation = variations();
  return each([&](std::size_t k) {
    const double reach = (variation[k] + radius_[k]) * up;
    return constant(k) - reach - epsilon * (std::abs(constant(k)) + reach);
  });
}

Values TaylorModel::uppers() const {
  const Values variation = variations();
  return each([&](std::size_t k) {
    const double reach = (variation[k] + radius_[k]) * up;
    return constant(k) + reach + epsilon * (std::abs(constant(k)) + reach);
  });
}

Values TaylorModel::farthest() const {
  const Values variation = variations();
  return each([&](std::size_t k) {
    const double reach = (variation[k] + radius_[k]) * up;
    return std::abs(constant(k)) + reach + epsilon * (std::abs(constant(k)) + reach);
  });
}

TaylorModel TaylorModel::widened(const Values& by) const {
  TaylorModel f = *this;
  for (std::size_t k = 0; k < boxes; ++k) f.radius_[k] = clean((f.radius_[k] + by[k]) * up);
  return f;
}

TaylorModel TaylorModel::with_radius(double radius) const {
  TaylorModel f = *this;
  f.radius_.fill(radius);
  return f;
}

void TaylorModel::take_monomials(const TaylorModel& other) {
  if (monomials_ == nullptr) monomials_ = other.monomials_;
  const std::size_t size = coefficients_.size();
  if (size >= other.coefficients_.size()) return;
  coefficients_.resize(other.coefficients_.size());
  std::fill(coefficients_.begin() + std::ptrdiff_t(size), coefficients_.end(), 0.0);
}

void TaylorModel::add(double factor, const TaylorModel& other) { add(all(factor), other); }

void TaylorModel::add(const Values& factor, const TaylorModel& other) {
  take_monomials(other);
  std::array<Values, 2> sizes;
  kernels().add_multiple(coefficients_.data(), factor.data(), other.coefficients_.data(), other.terms(),
                         sizes.front().data());
  for (std::size_t k = 0; k < boxes; ++k) {
    if (factor[k] == 0) continue;
    const double size = std::abs(factor[k]) * sizes[0][k] * up + sizes[1][k];
    radius_[k] = clean((radius_[k] + std::abs(factor[k]) * other.radius_[k] + epsilon * size + underflow) * up);
  }
}

TaylorModel& TaylorModel::add_multiple(double sign, const TaylorModel& other) {
  take_monomials(other);
  std::array<Values, 2> sizes;
  kernels().add_multiple(coefficients_.data(), all(sign).data(), other.coefficients_.data(), other.terms(),
                         sizes.front().data());
  for (std::size_t k = 0; k < boxes; ++k)
    radius_[k] = clean((radius_[k] + other.radius_[k] + epsilon * sizes[1][k]) * up);
  return *this;
}

TaylorModel operator-(const TaylorModel& a) {
  TaylorModel f = a;
  for (double& c : f.coefficients_) c = -c;
  return f;
}

/// Product with numbers, each known to lie within its radius of the factor.
TaylorModel scaled(const Values& factor, const Values& radius, const TaylorModel& f) {
  TaylorModel product;
  product.monomials_ = f.monomials_;
  product.coefficients_.resize(f.coefficients_.size());
  Values sizes, f_sizes{};
  kernels().take_multiple(product.coefficients_.data(), factor.data(), f.coefficients_.data(), f.terms(), sizes.data());
  if (!is_zero(radius.data())) kernels().sum_sizes(f.coefficients_.data(), f.terms(), f_sizes.data());
  for (std::size_t k = 0; k < boxes; ++k) {
    const double of_radius = radius[k] > 0 ? radius[k] * ((f_sizes[k] + f.radius_[k]) * up) : 0.0;
    product.radius_[k] = clean((std::abs(factor[k]) * f.radius_[k] + of_radius + epsilon * sizes[k] + underflow) * up);
  }
  return product;
}

TaylorModel operator*(const TaylorModel& a, const TaylorModel& b) {
  if (a.terms() > b.terms()) return b * a;
  if (a.terms() == 1) {
    // Matrices that move few coordinates are full of zeros.
    if (a.is_zero() && known_everywhere(b)) return {};
    Values factor;
    std::copy_n(a.coefficients_.begin(), boxes, factor.begin());
    return scaled(factor, a.radius_, b);
  }
  // A rotation's entries are functions of three variables: most of their coefficients are zero.
  if (a.terms() == b.terms() && large_terms(b) < large_terms(a)) return b * a;
  const Monomials& m = *a.monomials_;
  const int degree_a = m.degree_of(a.terms() - 1), degree_b = m.degree_of(b.terms() - 1);
  TaylorModel product;
  product.monomials_ = &m;
  product.coefficients_.resize(boxes * m.count_to(std::min(m.degree(), degree_a + degree_b)));
  // Products with the constants stand side by side.
  double* out = product.coefficients_.data();
  std::array<Values, 2> sizes;
  kernels().take_multiple(out, a.coefficients_.data(), b.coefficients_.data(), b.terms(), sizes.front().data());
  std::fill(product.coefficients_.begin() + std::ptrdiff_t(b.coefficients_.size()), product.coefficients_.end(), 0.0);
  kernels().add_multiple(out + boxes, b.coefficients_.data(), a.coefficients_.data() + boxes, a.terms() - 1,
                         sizes.front().data());
  const ProductTable table{m.products(0), m.first_products().data(), m.counts().data(), m.degree()};
  kernels().add_products(out, a.coefficients_.data(), a.terms(), b.coefficients_.data(), b.terms(), table);
  const Norms norms_a = norms_of(a), norms_b = norms_of(b);
  // A coefficient is the sum of 2^degree products at most: that many exponents divide a monomial.
  const double products = epsilon * double(std::size_t(2) << m.degree());
  for (std::size_t k = 0; k < boxes; ++k) {
    double size_a = 0, size_b = 0, cut = 0;
    for (int i = 0; i <= degree_a; ++i) {
      size_a += norms_a[std::size_t(i)][k];
      for (int j = std::max(0, m.degree() - i + 1); j <= degree_b; ++j)
        cut += norms_a[std::size_t(i)][k] * norms_b[std::size_t(j)][k];
    }
    for (int j = 0; j <= degree_b; ++j) size_b += norms_b[std::size_t(j)][k];
    product.radius_[k] = clean((cut + products * size_a * size_b + a.radius_[k] * (size_b + b.radius_[k]) +
                                b.radius_[k] * size_a + underflow) *
                               up);
  }
  return product;
}

TaylorModel composed(const TaylorModel& t, std::span<const Values> series) {
  TaylorModel sum = TaylorModel::constants(series.back());
  for (std::size_t k = series.size() - 1; k-- > 0;) {
    sum = sum * t;
    sum += TaylorModel::constants(series[k]);
  }
  return sum;
}

namespace {

using Series = std::array<Values, Monomials::most_degree + 1>;

int degree_of_series(const TaylorModel& f) { return f.monomials() == nullptr ? 1 : f.monomials()->degree(); }

/// f = (1 + t) / scale on each box, |t| ≤ tau.
struct AboutOne {
  Values scale, tau;
  TaylorModel t;

  explicit AboutOne(const TaylorModel& f)
      : scale(each([&](std::size_t k) { return 1 / f.constant(k); })), t(f * TaylorModel::constants(scale)) {
    t -= TaylorModel(1.0);
    const Values variation = t.variations();
    tau = each([&](std::size_t k) { return (std::abs(t.constant(k)) + variation[k] + t.radius(k)) * up; });
  }
};

}  // namespace

TaylorModel inverse(const TaylorModel& f) {
  const Values lower = f.lowers(), upper = f.uppers();
  const AboutOne about(f);
  const int degree = degree_of_series(f);
  Series series{};
  for (int k = 0; k <= degree; ++k) series[std::size_t(k)] = all(k % 2 == 0 ? 1 : -1);
  const Values rest = each([&](std::size_t k) { return std::pow(about.tau[k], degree + 1) / (1 - about.tau[k]) * up; });
  TaylorModel result = composed(about.t, std::span(series).first(std::size_t(degree + 1))).widened(rest) *
                       TaylorModel::constants(about.scale);
  for (std::size_t k = 0; k < boxes; ++k) {
    if (!f.known(k) || !std::isfinite(about.scale[k]) || !(lower[k] > 0 || upper[k] < 0)) result.put_unknown(k);
    else if (!(about.tau[k] < widest))
      result.put_between(k, 1 / upper[k] * (1 - 2 * epsilon), 1 / lower[k] * (1 + 2 * epsilon));
  }
  return result;
}

TaylorModel sqrt(const TaylorModel& f) {
  const Values lower = f.lowers(), upper = f.uppers();
  const AboutOne about(f);
  const int degree = degree_of_series(f);
  // Binomial coefficients of 1/2 are whole numbers over powers of 2: exact.
  Series series{};
  double next = 1;
  for (int k = 0; k <= degree; ++k) {
    series[std::size_t(k)] = all(next);
    next *= (0.5 - k) / (k + 1);
  }
  const Values rest = each([&](std::size_t k) {
    return std::abs(next) * std::pow(about.tau[k], degree + 1) * std::pow(1 - about.tau[k], -0.5 - degree);
  });
  const Values factor = each([&](std::size_t k) { return std::sqrt(f.constant(k)); });
  const TaylorModel root =
      composed(about.t, std::span(series).first(std::size_t(degree + 1))).widened(each([&](std::size_t k) {
        return rest[k] * up;
      }));
  // √f = √(1 + t) / √scale, and the factor is that to a few roundings.
  TaylorModel result = (root * TaylorModel::constants(factor)).widened(each([&](std::size_t k) {
    return 4 * epsilon * factor[k] * (std::sqrt(1 + about.tau[k]) + rest[k]);
  }));
  for (std::size_t k = 0; k < boxes; ++k) {
    const double least = std::max(0.0, lower[k]), scale = about.scale[k];
    if (!f.known(k) || !(upper[k] >= 0)) result.put_unknown(k);
    else if (!(least > 0) || !std::isfinite(scale) || !(scale > 0) || !(about.tau[k] < widest))
      result.put_between(k, std::sqrt(least) * (1 - 2 * epsilon), std::sqrt(upper[k]) * (1 + 2 * epsilon));
  }
  return result;
}

namespace {

/// sin (shift 0) or cos (shift 1) about the middle of f, t the rest of f.
TaylorModel wave(const TaylorModel& f, const TaylorModel& t, int shift) {
  const Values sine = each([&](std::size_t k) { return std::sin(f.constant(k)); }),
               cosine = each([&](std::size_t k) { return std::cos(f.constant(k)); });
  const int degree = degree_of_series(f);
  Series series{};
  double factorial = 1;
  for (int k = 0; k <= degree; ++k) {
    const int turn = (k + shift) % 4;
    const Values& value = turn % 2 == 0 ? sine : cosine;
    series[std::size_t(k)] = each([&](std::size_t box) { return (turn < 2 ? value[box] : -value[box]) / factorial; });
    factorial *= k + 1;
  }
  const Values variation = t.variations();
  // Series and rest; its coefficients are rounded by a few units, and tau is an angle of any size.
  TaylorModel result = composed(t, std::span(series).first(std::size_t(degree + 1))).widened(each([&](std::size_t k) {
    const double tau = (variation[k] + t.radius(k)) * up;
    return std::pow(tau, degree + 1) / factorial * up + 8 * epsilon * std::exp(std::min(tau, 700.0));
  }));
  for (std::size_t k = 0; k < boxes; ++k)
    if (!f.known(k)) result.put_unknown(k);
  return result;
}

}  // namespace

TaylorModel TaylorModel::without_constant() const {
  TaylorModel t = *this;
  std::fill_n(t.coefficients_.begin(), boxes, 0.0);
  return t;
}

TaylorModel sin(const TaylorModel& f) { return wave(f, f.without_constant(), 0); }

TaylorModel cos(const TaylorModel& f) { return wave(f, f.without_constant(), 1); }

}  // namespace posewright
