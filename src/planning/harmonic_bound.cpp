#include "posewright/planning/harmonic_bound.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>

#include "posewright/support/parallel.hpp"

namespace posewright {
namespace {

using Matrix = Eigen::Matrix<double, 5, 5, Eigen::RowMajor>;

// Widest box to begin with: u = tan(w/4) stays well below 1, where the weights' coefficients would vanish.
constexpr double widest = 2 * std::numbers::pi / 3;
// Boxes of one round; more threads than this would have nothing to do.
constexpr std::size_t boxes_a_round = 16;
constexpr double epsilon = std::numeric_limits<double>::epsilon();

double binomial(int n, int k) {
  double result = 1;
  for (int i = 0; i < k; ++i) result = result * (n - i) / (i + 1);
  return result;
}

double basis(bool turns, int k, double x) {
  if (!turns) return k == 0 ? 1 : k == 1 ? x : x * x;
  switch (k) {
    case 0:
      return 1;
    case 1:
      return std::cos(x);
    case 2:
      return std::sin(x);
    case 3:
      return std::cos(2 * x);
    default:
      return std::sin(2 * x);
  }
}

/// Coefficients in powers of v on [0, 1] to Bernstein coefficients of the same degree.
Matrix bernstein(int degree) {
  Matrix B = Matrix::Zero();
  for (int i = 0; i <= degree; ++i)
    for (int k = 0; k <= i; ++k) B(i, k) = binomial(i, k) / binomial(degree, k);
  return B;
}

/// Powers of x = shift + scale v as powers of v.
Matrix substituted(int degree, double shift, double scale) {
  Matrix S = Matrix::Zero();
  for (int p = 0; p <= degree; ++p)
    for (int k = 0; k <= p; ++k) S(k, p) = binomial(p, k) * std::pow(scale, k) * std::pow(shift, p - k);
  return S;
}

/// From (1, cos q, …, sin 2q) to Bernstein coefficients of f (1 + u²)² on [lower, upper].
Matrix of_angle(double lower, double upper) {
  const double c = 0.5 * (lower + upper), t = std::tan(0.25 * (upper - lower));
  Matrix R = Matrix::Zero();  // about c
  R(0, 0) = 1;
  for (int n = 1; n <= 2; ++n) {
    const int k = 2 * n - 1;
    R(k, k) = R(k + 1, k + 1) = std::cos(n * c);
    R(k, k + 1) = std::sin(n * c);
    R(k + 1, k) = -std::sin(n * c);
  }
  Matrix W = Matrix::Zero();  // powers of u by 1, cos, sin, cos 2, sin 2, times (1 + u²)²
  W(0, 0) = 1, W(2, 0) = 2, W(4, 0) = 1;
  W(0, 1) = 1, W(4, 1) = -1;
  W(1, 2) = 2, W(3, 2) = 2;
  W(0, 3) = 1, W(2, 3) = -6, W(4, 3) = 1;
  W(1, 4) = 4, W(3, 4) = -4;
  return bernstein(4) * substituted(4, -t, 2 * t) * W * R;
}

Matrix of_axis(const HarmonicAxis& axis, double lower, double upper) {
  return axis.turns ? of_angle(lower, upper) : Matrix(bernstein(2) * substituted(2, lower, upper - lower));
}

/// Bernstein coefficients of the weight (1 + u²)² alone.
Eigen::Matrix<double, 5, 1> weight_of(const HarmonicAxis& axis, const Matrix& M) {
  if (axis.turns) return M.col(0);
  return Eigen::Matrix<double, 5, 1>::Ones();
}

/// out = M along one axis of a row-major tensor.
void apply(const std::vector<double>& in, std::vector<double>& out, const Matrix& M, int terms, std::size_t stride) {
  const std::size_t outer = in.size() / (std::size_t(terms) * stride);
  for (std::size_t o = 0; o < outer; ++o) {
    const double* from = in.data() + o * std::size_t(terms) * stride;
    double* to = out.data() + o * std::size_t(terms) * stride;
    for (int i = 0; i < terms; ++i) {
      double* row = to + std::size_t(i) * stride;
      for (std::size_t x = 0; x < stride; ++x) row[x] = M(i, 0) * from[x];
      for (int k = 1; k < terms; ++k) {
        const double m = M(i, k);
        if (m == 0) continue;
        const double* other = from + std::size_t(k) * stride;
        for (std::size_t x = 0; x < stride; ++x) row[x] += m * other[x];
      }
    }
  }
}

std::vector<std::size_t> strides_of(const std::vector<HarmonicAxis>& axes) {
  std::vector<std::size_t> strides(axes.size(), 1);
  for (std::size_t a = axes.size(); a-- > 1;)
    strides[a - 1] = strides[a] * std::size_t(HarmonicFunction::terms(axes[a]));
  return strides;
}

std::size_t size_of(const std::vector<HarmonicAxis>& axes) {
  std::size_t size = 1;
  for (const HarmonicAxis& axis : axes) size *= std::size_t(HarmonicFunction::terms(axis));
  return size;
}

/// Where the function is interpolated along an axis.
double node(const HarmonicAxis& axis, int k) {
  return axis.turns ? axis.lower + 2 * std::numbers::pi * k / 5 : axis.lower + (axis.upper - axis.lower) * k / 2;
}

struct Box {
  std::vector<double> lower, upper;
  double bound = std::numeric_limits<double>::infinity();
  int longest = 0;  ///< axis along which the coefficients vary most
  bool operator<(const Box& other) const { return bound < other.bound; }
};

/// What one box tells.
class BoxBound {
 public:
  explicit BoxBound(const HarmonicFunction& function)
      : function_(function),
        strides_(strides_of(function.axes())),
        now_(function.coefficients().size()),
        next_(now_.size()),
        weight_(now_.size()) {
    for (const double c : function.coefficients()) most_ = std::max(most_, std::abs(c));
  }

  /// Fills the box's bound; values at its corners that exceed `largest` take its place.
  void judge(Box& box, double& largest, std::vector<double>& where) {
    const auto& axes = function_.axes();
    now_ = function_.coefficients();
    weight_.assign(1, 1.0);
    double growth = 1;
    for (std::size_t a = 0; a < axes.size(); ++a) {
      const Matrix M = of_axis(axes[a], box.lower[a], box.upper[a]);
      const int terms = HarmonicFunction::terms(axes[a]);
      apply(now_, next_, M, terms, strides_[a]);
      now_.swap(next_);
      growth *= M.topLeftCorner(terms, terms).cwiseAbs().rowwise().sum().maxCoeff();
      const auto w = weight_of(axes[a], M);
      next_weight_.clear();
      for (const double before : weight_)
        for (int k = 0; k < terms; ++k) next_weight_.push_back(before * w[k]);
      weight_.swap(next_weight_);
    }
    // Every coefficient is a sum of products: its rounding is that of all terms' sizes, a dozen operations an axis.
    const double rounding = 16.0 * double(axes.size()) * epsilon * growth * most_;
    box.bound = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < now_.size(); ++i) {
      const double w = weight_[i] * (1 - 1e-12);
      const double quotient = (now_[i] + rounding) / (now_[i] + rounding > 0 ? w : weight_[i] * (1 + 1e-12));
      box.bound = std::max(box.bound, quotient);
    }
    for (std::size_t i = 0; i < now_.size(); ++i) now_[i] /= weight_[i];
    corners(box, largest, where);
    box.longest = most_varied(axes);
  }

 private:
  void corners(const Box& box, double& largest, std::vector<double>& where) const {
    const auto& axes = function_.axes();
    for (std::size_t corner = 0; corner < (std::size_t(1) << axes.size()); ++corner) {
      std::size_t at = 0;
      for (std::size_t a = 0; a < axes.size(); ++a)
        if ((corner >> a & 1) != 0) at += std::size_t(HarmonicFunction::terms(axes[a]) - 1) * strides_[a];
      const double value = now_[at];
      if (!(value > largest)) continue;
      largest = value;
      where.resize(axes.size());
      for (std::size_t a = 0; a < axes.size(); ++a) where[a] = (corner >> a & 1) != 0 ? box.upper[a] : box.lower[a];
    }
  }

  int most_varied(const std::vector<HarmonicAxis>& axes) const {
    int most = 0;
    double largest = -1;
    for (std::size_t a = 0; a < axes.size(); ++a) {
      const int terms = HarmonicFunction::terms(axes[a]);
      const std::size_t stride = strides_[a], outer = now_.size() / (std::size_t(terms) * stride);
      double variation = 0;
      for (std::size_t o = 0; o < outer; ++o)
        for (std::size_t x = 0; x < stride; ++x) {
          const std::size_t first = o * std::size_t(terms) * stride + x;
          double sum = 0;
          for (int k = 0; k + 1 < terms; ++k) {
            const std::size_t i = first + std::size_t(k) * stride;
            sum += std::abs(now_[i + stride] - now_[i]);
          }
          variation = std::max(variation, sum);
        }
      if (variation > largest) {
        largest = variation;
        most = int(a);
      }
    }
    return most;
  }

  const HarmonicFunction& function_;
  std::vector<std::size_t> strides_;
  std::vector<double> now_, next_;  // the coefficients; at last their quotients with the weights
  std::vector<double> weight_, next_weight_;
  double most_ = 0;
};

/// The box of all axes in parts that are narrow enough.
std::vector<Box> first_boxes(const std::vector<HarmonicAxis>& axes) {
  std::vector<Box> boxes(1);
  for (const HarmonicAxis& axis : axes) {
    // A turn and more is one turn.
    const double width = axis.turns ? std::min(axis.upper - axis.lower, 2 * std::numbers::pi) : axis.upper - axis.lower;
    const int parts = axis.turns ? std::max(1, int(std::ceil(width / widest - 1e-9))) : 1;
    std::vector<Box> finer;
    for (const Box& box : boxes)
      for (int k = 0; k < parts; ++k) {
        Box part = box;
        part.lower.push_back(axis.lower + width * k / parts);
        part.upper.push_back(axis.lower + width * (k + 1) / parts);
        finer.push_back(std::move(part));
      }
    boxes = std::move(finer);
  }
  return boxes;
}

}  // namespace

HarmonicFunction::HarmonicFunction(std::vector<HarmonicAxis> axes,
                                   const std::function<std::function<double(std::span<const double>)>()>& make,
                                   int threads)
    : axes_(std::move(axes)), coefficients_(size_of(axes_)) {
  const std::vector<std::size_t> strides = strides_of(axes_);
  constexpr std::size_t chunk = 256;
  parallel_for((coefficients_.size() + chunk - 1) / chunk, thread_count(threads), [&](std::size_t c, int) {
    const auto f = make();
    std::vector<double> q(axes_.size());
    for (std::size_t i = c * chunk; i < std::min(coefficients_.size(), (c + 1) * chunk); ++i) {
      for (std::size_t a = 0; a < axes_.size(); ++a) q[a] = node(axes_[a], int(i / strides[a]) % terms(axes_[a]));
      coefficients_[i] = f(q);
    }
  });
  for (const double value : coefficients_) defined_ = defined_ && std::isfinite(value);
  std::vector<double> next(coefficients_.size());
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    const int n = terms(axes_[a]);
    Eigen::MatrixXd V(n, n);
    for (int i = 0; i < n; ++i)
      for (int k = 0; k < n; ++k) V(i, k) = basis(axes_[a].turns, k, node(axes_[a], i));
    Matrix inverse = Matrix::Zero();
    inverse.topLeftCorner(n, n) = V.inverse();
    apply(coefficients_, next, inverse, n, strides[a]);
    coefficients_.swap(next);
  }
}

double HarmonicFunction::value(std::span<const double> q) const {
  std::vector<double> sum = coefficients_;
  std::size_t size = sum.size();
  for (std::size_t a = axes_.size(); a-- > 0;) {
    const int n = terms(axes_[a]);
    size /= std::size_t(n);
    for (std::size_t i = 0; i < size; ++i) {
      double total = 0;
      for (int k = 0; k < n; ++k) total += basis(axes_[a].turns, k, q[a]) * sum[i * std::size_t(n) + std::size_t(k)];
      sum[i] = total;
    }
  }
  return sum[0];
}

HarmonicBound largest_value(const HarmonicFunction& function, const HarmonicBoundOptions& options,
                            const Monitor& monitor) {
  HarmonicBound result;
  result.largest = -std::numeric_limits<double>::infinity();
  std::priority_queue<Box> open;
  std::vector<Box> round = first_boxes(function.axes());
  const int threads = thread_count(options.threads);
  std::vector<BoxBound> bounds;
  bounds.reserve(std::size_t(threads));
  for (int i = 0; i < threads; ++i) bounds.emplace_back(function);
  while (true) {
    std::vector<double> largest(round.size(), result.largest);
    std::vector<std::vector<double>> where(round.size());
    parallel_for(round.size(), threads, [&](std::size_t i, int thread) {
      // Boxes that are not judged keep an infinite bound.
      if (monitor.should_stop()) return;
      bounds[std::size_t(thread)].judge(round[i], largest[i], where[i]);
    });
    result.boxes += long(round.size());
    for (std::size_t i = 0; i < round.size(); ++i)
      if (largest[i] > result.largest) {
        result.largest = largest[i];
        result.where = where[i];
      }
    for (Box& box : round) open.push(std::move(box));
    round.clear();
    const double enough =
        std::max(result.largest + options.tolerance * std::abs(result.largest), options.enough - options.slack);
    result.complete = open.top().bound <= enough;
    if (result.complete || monitor.should_stop() || result.boxes >= options.most_boxes) break;
    for (std::size_t i = 0; i < boxes_a_round && !open.empty() && open.top().bound > enough; ++i) {
      const Box box = open.top();
      open.pop();
      const auto a = std::size_t(box.longest);
      const double middle = 0.5 * (box.lower[a] + box.upper[a]);
      round.push_back(box);
      round.back().upper[a] = middle;
      round.push_back(box);
      round.back().lower[a] = middle;
    }
  }
  result.bound = open.top().bound + options.slack;
  return result;
}

}  // namespace posewright
