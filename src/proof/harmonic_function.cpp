#include "posewright/proof/harmonic_function.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "bernstein.hpp"
#include "posewright/criterion/combine_rows.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/parallel.hpp"

namespace posewright {
namespace {

// Samples that one thread takes at a time.
constexpr std::size_t chunk = 256;

double width_of(const HarmonicAxis& axis) { return axis.upper > axis.lower ? axis.upper - axis.lower : 1.0; }

double basis(const HarmonicAxis& axis, int k, double x) {
  if (!axis.turns) return std::pow((x - axis.lower) / width_of(axis), k);
  if (k == 0) return 1;
  const int n = (k + 1) / 2;
  return k % 2 == 1 ? std::cos(n * x) : std::sin(n * x);
}

/// Nodes of interpolation for a function of this degree along an axis.
double node(const HarmonicAxis& axis, int degree, int k) {
  if (axis.turns) return axis.lower + 2 * std::numbers::pi * k / (2 * degree + 1);
  return degree == 0 ? axis.lower : axis.lower + width_of(axis) * k / degree;
}

/// Values at the nodes of `at` from coefficients of `degree`.
Eigen::MatrixXd values_at_nodes(const HarmonicAxis& axis, int degree, int at) {
  Eigen::MatrixXd V(harmonic_terms(axis, at), harmonic_terms(axis, degree));
  for (Eigen::Index i = 0; i < V.rows(); ++i)
    for (Eigen::Index k = 0; k < V.cols(); ++k) V(i, k) = basis(axis, int(k), node(axis, at, int(i)));
  return V;
}

/// Coefficients in powers of v on [0, 1] to Bernstein coefficients of the same degree.
Eigen::MatrixXd bernstein(int degree) {
  Eigen::MatrixXd B = Eigen::MatrixXd::Zero(degree + 1, degree + 1);
  for (int i = 0; i <= degree; ++i)
    for (int k = 0; k <= i; ++k) B(i, k) = binomial(i, k) / binomial(degree, k);
  return B;
}

/// Powers of x = shift + scale v as powers of v.
Eigen::MatrixXd substituted(int degree, double shift, double scale) {
  Eigen::MatrixXd S = Eigen::MatrixXd::Zero(degree + 1, degree + 1);
  for (int p = 0; p <= degree; ++p)
    for (int k = 0; k <= p; ++k) S(k, p) = binomial(p, k) * std::pow(scale, k) * std::pow(shift, p - k);
  return S;
}

/// Powers of u by 1, cos, sin, …, cos D, sin D of an angle whose half has the tangent u, times (1 + u²)^D: (1 + iu)²ⁿ
/// is (1 + u²)ⁿ (cos n + i sin n).
Eigen::MatrixXd rational(int degree) {
  Eigen::MatrixXd W = Eigen::MatrixXd::Zero(2 * degree + 1, 2 * degree + 1);
  for (int n = 0; n <= degree; ++n)
    for (int p = 0; p <= 2 * n; ++p) {
      // (iu)^p: real, imaginary, −real, −imaginary.
      const double size = binomial(2 * n, p) * (p % 4 < 2 ? 1 : -1);
      for (int r = 0; r <= degree - n; ++r) {
        const double term = size * binomial(degree - n, r);
        if (n == 0) W(2 * r, 0) += term;
        else W(p + 2 * r, p % 2 == 0 ? 2 * n - 1 : 2 * n) += term;
      }
    }
  return W;
}

/// Coefficients about c from those about zero.
Eigen::MatrixXd turned_to(int degree, double c) {
  Eigen::MatrixXd R = Eigen::MatrixXd::Zero(2 * degree + 1, 2 * degree + 1);
  R(0, 0) = 1;
  for (int n = 1; n <= degree; ++n) {
    const int k = 2 * n - 1;
    R(k, k) = R(k + 1, k + 1) = std::cos(n * c);
    R(k, k + 1) = std::sin(n * c);
    R(k + 1, k) = -std::sin(n * c);
  }
  return R;
}

std::vector<int> terms_of(const std::vector<HarmonicAxis>& axes, const std::vector<int>& degrees) {
  std::vector<int> terms;
  for (std::size_t a = 0; a < axes.size(); ++a) terms.push_back(harmonic_terms(axes[a], degrees[a]));
  return terms;
}

}  // namespace

std::size_t harmonic_size(const std::vector<HarmonicAxis>& axes, const std::vector<int>& degrees) {
  std::size_t size = 1;
  for (const int terms : terms_of(axes, degrees)) size *= std::size_t(terms);
  return size;
}

void apply_along(std::vector<double>& tensor, std::vector<double>& scratch, std::vector<int>& terms, std::size_t axis,
                 const Eigen::MatrixXd& M) {
  std::size_t outer = 1, stride = 1;
  for (std::size_t a = 0; a < terms.size(); ++a) (a < axis ? outer : stride) *= a == axis ? 1 : std::size_t(terms[a]);
  scratch.resize(outer * std::size_t(M.rows()) * stride);
  combine_rows(tensor.data(), scratch.data(), outer, stride, M);
  tensor.swap(scratch);
  terms[axis] = int(M.rows());
}

Eigen::MatrixXd bernstein_on(const HarmonicAxis& axis, int degree, double lower, double upper) {
  if (!axis.turns) {
    const double width = width_of(axis);
    return bernstein(degree) * substituted(degree, (lower - axis.lower) / width, (upper - lower) / width);
  }
  const double c = 0.5 * (lower + upper), t = std::tan(0.25 * (upper - lower));
  return bernstein(2 * degree) * substituted(2 * degree, -t, 2 * t) * rational(degree) * turned_to(degree, c);
}

HarmonicFunction::HarmonicFunction(std::vector<HarmonicAxis> axes, std::vector<int> degrees,
                                   const std::function<Function()>& make, int threads)
    : HarmonicFunction(std::move(
          of_several(
              axes, degrees, 1,
              [&] { return [f = make()](std::span<const double> q, std::span<double> values) { values[0] = f(q); }; },
              threads)
              .front())) {}

std::vector<HarmonicFunction> HarmonicFunction::of_several(
    const std::vector<HarmonicAxis>& axes, const std::vector<int>& degrees, std::size_t count,
    const std::function<std::function<void(std::span<const double>, std::span<double>)>()>& make, int threads) {
  const std::size_t size = harmonic_size(axes, degrees);
  std::vector<HarmonicFunction> functions(count, HarmonicFunction(axes, degrees));
  for (HarmonicFunction& f : functions) f.coefficients_.resize(size);
  const std::vector<int> terms = terms_of(axes, degrees);
  parallel_for((size + chunk - 1) / chunk, thread_count(threads), [&](std::size_t c, int) {
    const auto sample = make();
    std::vector<double> q(axes.size()), values(count);
    for (std::size_t i = c * chunk; i < std::min(size, (c + 1) * chunk); ++i) {
      std::size_t rest = i;
      for (std::size_t a = axes.size(); a-- > 0;) {
        q[a] = node(axes[a], degrees[a], int(rest % std::size_t(terms[a])));
        rest /= std::size_t(terms[a]);
      }
      sample(q, values);
      for (std::size_t f = 0; f < count; ++f) functions[f].coefficients_[i] = values[f];
    }
  });
  for (HarmonicFunction& f : functions) f.from_values();
  return functions;
}

void HarmonicFunction::from_values() {
  for (const double value : coefficients_) defined_ = defined_ && std::isfinite(value);
  std::vector<double> scratch;
  std::vector<int> terms = terms_of(axes_, degrees_);
  for (std::size_t a = 0; a < axes_.size(); ++a)
    apply_along(coefficients_, scratch, terms, a, values_at_nodes(axes_[a], degrees_[a], degrees_[a]).inverse());
}

double HarmonicFunction::value(std::span<const double> q) const {
  std::vector<double> sum = coefficients_;
  std::size_t size = sum.size();
  for (std::size_t a = axes_.size(); a-- > 0;) {
    const auto n = std::size_t(harmonic_terms(axes_[a], degrees_[a]));
    size /= n;
    for (std::size_t i = 0; i < size; ++i) {
      double total = 0;
      for (std::size_t k = 0; k < n; ++k) total += basis(axes_[a], int(k), q[a]) * sum[i * n + k];
      sum[i] = total;
    }
  }
  return sum[0];
}

HarmonicFunction HarmonicFunction::lifted(const std::vector<int>& degrees) const {
  HarmonicFunction result(axes_, degrees);
  result.coefficients_ = coefficients_;
  result.defined_ = defined_;
  std::vector<double> scratch;
  std::vector<int> terms = terms_of(axes_, degrees_);
  for (std::size_t a = 0; a < axes_.size(); ++a)
    if (degrees[a] != degrees_[a])
      apply_along(result.coefficients_, scratch, terms, a,
                  Eigen::MatrixXd::Identity(harmonic_terms(axes_[a], degrees[a]), terms[a]));
  return result;
}

HarmonicFunction HarmonicFunction::negated() const {
  HarmonicFunction result = *this;
  for (double& c : result.coefficients_) c = -c;
  return result;
}

HarmonicFunction HarmonicFunction::raised(double by) const {
  HarmonicFunction result = *this;
  // 1 is the first of the basis along every axis.
  result.coefficients_.front() += by;
  return result;
}

HarmonicFunction HarmonicFunction::product(const HarmonicFunction& a, const HarmonicFunction& b,
                                           const std::vector<int>& degrees) {
  HarmonicFunction result(a.axes_, degrees);
  const auto sampled = [&](const HarmonicFunction& f) {
    std::vector<double> values = f.coefficients_, scratch;
    std::vector<int> terms = terms_of(f.axes_, f.degrees_);
    for (std::size_t k = 0; k < f.axes_.size(); ++k)
      apply_along(values, scratch, terms, k, values_at_nodes(f.axes_[k], f.degrees_[k], degrees[k]));
    return values;
  };
  result.coefficients_ = sampled(a);
  const std::vector<double> factor = sampled(b);
  for (std::size_t i = 0; i < factor.size(); ++i) result.coefficients_[i] *= factor[i];
  result.from_values();
  return result;
}

}  // namespace posewright
