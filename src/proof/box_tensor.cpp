#include "box_tensor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "bernstein.hpp"
#include "posewright/support/dense.hpp"

namespace posewright {
namespace {

// Widest box to begin with: u = tan(w/4) stays well below 1, where the weights' coefficients would vanish.
constexpr double widest = 2 * std::numbers::pi / 3;
// The weights are sums of few positive numbers: they are right to this.
constexpr double weight_error = 1e-12;
// A multiple that brings the largest coefficient this near to its smallest is good enough; and it takes no more steps.
constexpr double near_enough = 1e-5;
constexpr int most_steps = 30;
constexpr double most_times = 1e100;

}  // namespace

BoxTensor::BoxTensor(const std::vector<HarmonicAxis>& axes, std::vector<int> degrees)
    : axes_(axes), degrees_(std::move(degrees)), of_function_(degrees_) {}

BoxTensor::BoxTensor(const std::vector<HarmonicAxis>& axes, std::vector<int> degrees, std::vector<int> of_function)
    : axes_(axes), degrees_(std::move(degrees)), of_function_(std::move(of_function)) {}

void BoxTensor::put_weighted(const SearchBox& box, double most) {
  terms_.clear();
  matrices_.clear();
  for (std::size_t a = 0; a < axes_.size(); ++a) terms_.push_back(harmonic_terms(axes_[a], of_function_[a]));
  double growth = 1;
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    matrices_.push_back(bernstein_on(axes_[a], degrees_[a], lower_of(axes_, box, a), upper_of(axes_, box, a)));
    // Coefficients of a lower degree come first.
    const Eigen::MatrixXd M = matrices_.back().leftCols(terms_[a]);
    apply_along(now_, scratch_, terms_, a, M);
    growth *= M.cwiseAbs().rowwise().sum().maxCoeff();
  }
  // Every coefficient is a sum of products: its rounding is that of all terms' sizes, a dozen operations an axis.
  rounding_ = 16.0 * double(axes_.size()) * epsilon * growth * most;
}

void BoxTensor::put(const SearchBox& box, double most) {
  put_weighted(box, most);
  // The weight alone is what the function 1 becomes.
  weight_.assign(1, 1.0);
  for (const Eigen::MatrixXd& M : matrices_) {
    next_weight_.clear();
    for (const double before : weight_)
      for (Eigen::Index k = 0; k < M.rows(); ++k) next_weight_.push_back(before * M(k, 0));
    weight_.swap(next_weight_);
  }
  // Of a box as wide as half a turn weights vanish: then nothing is known.
  const double least = *std::min_element(weight_.begin(), weight_.end());
  rounding_ = least > 0 ? rounding_ / least : std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < now_.size(); ++i) now_[i] /= weight_[i];
}

void BoxTensor::take(const std::vector<double>& quotients, const std::vector<int>& terms, double rounding) {
  now_ = quotients;
  terms_ = terms;
  rounding_ = rounding;
}

bool BoxTensor::divide_by(const BoxTensor& other) {
  const double least = *std::min_element(other.now_.begin(), other.now_.end()) - other.rounding_;
  if (!(least > 0)) return false;
  double largest = 0;
  for (std::size_t i = 0; i < now_.size(); ++i) {
    now_[i] /= other.now_[i];
    largest = std::max(largest, std::abs(now_[i]));
  }
  rounding_ = (rounding_ + largest * other.rounding_) / least;
  return true;
}

void BoxTensor::add(double times, const BoxTensor& other) {
  double sizes = 0;
  for (std::size_t i = 0; i < now_.size(); ++i) {
    sizes = std::max(sizes, std::abs(now_[i]) + times * std::abs(other.now_[i]));
    now_[i] += times * other.now_[i];
  }
  // Both have quotients of weights in them, and their sum may be small.
  rounding_ += times * other.rounding_ + weight_error * sizes;
}

std::size_t BoxTensor::top_with(double times, const BoxTensor& other) const {
  std::size_t top = 0;
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < now_.size(); ++i)
    if (const double value = now_[i] + times * other.now_[i]; value > most) {
      most = value;
      top = i;
    }
  return top;
}

double BoxTensor::best_multiple(const BoxTensor& other) const {
  // Each coefficient is a line in the multiple; the largest of all is convex.
  const auto line = [&](std::size_t i) { return std::pair(now_[i], other.now_[i]); };
  auto falling = line(top_with(0.0, other));
  if (!(falling.second < 0)) return 0.0;
  if (*std::max_element(other.now_.begin(), other.now_.end()) < 0) return std::numeric_limits<double>::infinity();
  double times = falling.first == 0 ? 1.0 : std::abs(falling.first / falling.second);
  auto rising = falling;
  for (; times < most_times; times *= 4) {
    rising = line(top_with(times, other));
    if (!(rising.second < 0)) break;
    falling = rising;
  }
  // Of what is not finite, or falls with every multiple, no multiple is known to be better than none.
  if (!(rising.second >= 0)) return 0.0;
  for (int step = 0; step < most_steps && rising.second > 0; ++step) {
    times = (falling.first - rising.first) / (rising.second - falling.second);
    const auto now = line(top_with(times, other));
    const double value = falling.first + times * falling.second;
    if (!(now.first + times * now.second > value + near_enough * std::abs(value))) break;
    (now.second < 0 ? falling : rising) = now;
  }
  return std::max(0.0, times);
}

double BoxTensor::near(std::size_t index, const BoxTensor& of) const {
  std::size_t stride = of.now_.size(), own = 0;
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    const auto terms = std::size_t(terms_[a]), others = std::size_t(of.terms_[a]);
    stride /= others;
    const std::size_t at = index / stride % others;
    own = own * terms + (others > 1 ? (at * (terms - 1) + (others - 1) / 2) / (others - 1) : 0);
  }
  return now_[own];
}

double BoxTensor::largest() const {
  const double top = *std::max_element(now_.begin(), now_.end()) + rounding_;
  return top + weight_error * std::abs(top);
}

double BoxTensor::smallest() const {
  const double bottom = *std::min_element(now_.begin(), now_.end()) - rounding_;
  return bottom - weight_error * std::abs(bottom);
}

std::size_t BoxTensor::highest_corner(double& value) const {
  std::size_t best = 0;
  value = -std::numeric_limits<double>::infinity();
  for (std::size_t corner = 0; corner < (std::size_t(1) << axes_.size()); ++corner) {
    std::size_t at = 0;
    for (std::size_t a = 0; a < axes_.size(); ++a)
      at = at * std::size_t(terms_[a]) + ((corner >> a & 1) != 0 ? std::size_t(terms_[a] - 1) : 0);
    if (now_[at] > value) {
      value = now_[at];
      best = corner;
    }
  }
  return best;
}

std::size_t BoxTensor::top() const {
  // In this order it takes a tenth of the time of max_element.
  const double value = Eigen::Map<const Eigen::VectorXd>(now_.data(), Eigen::Index(now_.size())).maxCoeff();
  const auto found = std::find(now_.begin(), now_.end(), value);
  return found == now_.end() ? std::size_t{0} : std::size_t(found - now_.begin());
}

int BoxTensor::most_bent() const {
  const std::size_t top = this->top();
  int most = 0;
  double largest = -1;
  std::size_t stride = now_.size();
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    const auto terms = std::size_t(terms_[a]);
    stride /= terms;
    const double* first = now_.data() + top / (stride * terms) * (stride * terms) + top % stride;
    double bent = 0;
    for (std::size_t k = 0; k + 2 < terms; ++k)
      bent += std::abs(first[(k + 2) * stride] - 2 * first[(k + 1) * stride] + first[k * stride]);
    if (bent > largest) {
      largest = bent;
      most = axes_[a].follows < 0 ? int(a) : axes_[a].follows;
    }
  }
  return most;
}

int BoxTensor::most_varied() const {
  int most = 0;
  double largest = -1;
  std::size_t stride = now_.size(), outer = 1;
  for (std::size_t a = 0; a < axes_.size(); ++a) {
    const auto terms = std::size_t(terms_[a]);
    stride /= terms;
    double variation = 0;
    for (std::size_t o = 0; o < outer; ++o)
      for (std::size_t x = 0; x < stride; ++x) {
        const double* first = now_.data() + o * terms * stride + x;
        double sum = 0;
        for (std::size_t k = 0; k + 1 < terms; ++k) sum += std::abs(first[(k + 1) * stride] - first[k * stride]);
        variation = std::max(variation, sum);
      }
    outer *= terms;
    if (variation > largest) {
      largest = variation;
      most = axes_[a].follows < 0 ? int(a) : axes_[a].follows;
    }
  }
  return most;
}

namespace {

/// A turn and more is one turn.
double width_to_part(const HarmonicAxis& axis) {
  const double width = axis.upper - axis.lower;
  return axis.turns && !axis.counts_turns ? std::min(width, 2 * std::numbers::pi) : width;
}

}  // namespace

int parts_of_axis(const HarmonicAxis& axis, int degree) {
  return axis.turns && degree > 0 ? std::max(1, int(std::ceil(width_to_part(axis) / widest - 1e-9))) : 1;
}

std::vector<SearchBox> parts_of_everything(const std::vector<HarmonicAxis>& axes, const std::vector<int>& degrees) {
  std::vector<SearchBox> boxes(1);
  for (std::size_t a = 0; a < axes.size(); ++a) {
    const HarmonicAxis& axis = axes[a];
    const double width = width_to_part(axis);
    const int parts = parts_of_axis(axis, degrees[a]);
    std::vector<SearchBox> finer;
    for (const SearchBox& box : boxes)
      for (int k = 0; k < parts; ++k) {
        SearchBox part = box;
        part.lower.push_back(axis.lower + width * k / parts);
        part.upper.push_back(axis.lower + width * (k + 1) / parts);
        finer.push_back(std::move(part));
      }
    boxes = std::move(finer);
  }
  return boxes;
}

}  // namespace posewright
