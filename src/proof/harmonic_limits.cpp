#include "harmonic_limits.hpp"

#include <algorithm>
#include <cmath>

#include "bernstein.hpp"
#include "interpolation_error.hpp"
#include "part_squares.hpp"
#include "posewright/support/random.hpp"

namespace posewright {
namespace {

constexpr std::uint64_t limits_stream = 0x11417;
constexpr int limits_compared = 100;
// What changes by less along an axis, as a share of itself or of a metre, does not.
constexpr double unmoved = 1e-12;
// Limits added to the bound of one box.
constexpr int most_added = 4;
// Lines of roots are computed from a few numbers.
constexpr double line_rounding = 1e-12;

}  // namespace

HarmonicLimits::HarmonicLimits(const HarmonicForm& form, std::uint64_t seed, int threads)
    : form_(form), degrees_(form.axes().size(), 0) {
  const auto count = std::size_t(form.limits().values);
  if (form.limits().of_points.empty()) return;
  Random random(seed, limits_stream);
  const auto evaluator = form.evaluator();
  std::vector<std::vector<double>> places, direct(count);
  std::vector<double> own(count);
  for (int i = 0; i < limits_compared; ++i) {
    places.push_back(random_values(form.axes(), random));
    evaluator->limit_values(places.back(), own);
    for (std::size_t k = 0; k < count; ++k) direct[k].push_back(own[k]);
    // Heights do not turn with an upright axis: what does not change along an axis has degree 0 there.
    const std::vector<double> place = places.back();
    for (std::size_t a = 0; a < degrees_.size(); ++a) {
      std::vector<double> moved = place, values(count);
      moved[a] = random.uniform(form.axes()[a].lower, form.axes()[a].upper);
      evaluator->limit_values(moved, values);
      for (std::size_t k = 0; k < count; ++k)
        if (std::abs(values[k] - own[k]) > unmoved * (std::abs(own[k]) + 1)) degrees_[a] = form.limit_degrees()[a];
    }
  }
  take(places, direct, threads);
}

/// Interpolates the values; if one is no polynomial of these degrees, its limits are left out.
void HarmonicLimits::take(const std::vector<std::vector<double>>& places,
                          const std::vector<std::vector<double>>& direct, int threads) {
  const std::vector<HarmonicFunction> functions = HarmonicFunction::of_several(
      form_.axes(), degrees_, direct.size(),
      [&] {
        return [evaluator = std::shared_ptr<HarmonicForm::Evaluator>(form_.evaluator())](
                   std::span<const double> values, std::span<double> out) { evaluator->limit_values(values, out); };
      },
      threads);
  std::vector<char> known;
  for (std::size_t k = 0; k < functions.size(); ++k) {
    const auto error = interpolation_error(functions[k], places, direct[k]);
    known.push_back(error.has_value());
    values_.push_back({functions[k], error.value_or(0.0), largest_size(functions[k].coefficients())});
  }
  for (const NecessaryLimits::OfPoints& limit : form_.limits().of_points)
    if (known[std::size_t(limit.value)] && (limit.square < 0 || known[std::size_t(limit.square)]))
      of_points_.push_back(limit);
}

BoxLimits::BoxLimits(const HarmonicLimits& limits, const std::vector<int>& degrees)
    : limits_(limits),
      square_(limits.form_.axes(), limits.degrees_),
      full_(limits.form_.axes(), degrees, limits.degrees_) {
  for (std::size_t i = 0; i < limits.of_points_.size(); ++i) kept_.push_back({{}, 0.0, square_, false});
}

bool BoxLimits::cut(SearchBox& box) const {
  for (const NecessaryLimits::OfCoordinates& limit : limits_.form_.limits().of_coordinates) {
    const auto most_of = [&](std::size_t a) {
      return std::max(limit.factors[a] * box.lower[a], limit.factors[a] * box.upper[a]);
    };
    double most = limit.constant, sizes = std::abs(limit.constant);
    for (std::size_t a = 0; a < limit.factors.size(); ++a) {
      most += most_of(a);
      sizes += std::abs(limit.factors[a]) * std::max(std::abs(box.lower[a]), std::abs(box.upper[a]));
    }
    most += line_rounding * sizes;
    if (most < 0) return false;
    for (std::size_t a = 0; a < limit.factors.size(); ++a) {
      if (limit.factors[a] == 0) continue;
      // What the others leave: factor · x ≥ −rest.
      const double end = -(most - most_of(a)) / limit.factors[a];
      double& side = limit.factors[a] > 0 ? box.lower[a] : box.upper[a];
      side = limit.factors[a] > 0 ? std::max(side, end) : std::min(side, end);
    }
  }
  return true;
}

std::pair<double, double> BoxLimits::line_above(const NecessaryLimits::OfPoints& limit, const SearchBox& box) {
  const HarmonicLimits::Value& square = limits_.values_[std::size_t(limit.square)];
  square_.coefficients() = square.function.coefficients();
  square_.put(box, square.most);
  const double least = std::sqrt(std::max(0.0, square_.smallest() - square.error));
  const double most = std::sqrt(std::max(0.0, square_.largest() + square.error));
  if (!(most > 0)) return {0.0, 0.0};
  // The chord is below the root, the tangent in the middle above it.
  const double slope = 1 / (limit.root < 0 ? least + most : std::max(least + most, line_rounding));
  const double at = limit.root < 0 ? least * most * slope : 0.25 * (least + most);
  return {limit.root * at + line_rounding * std::abs(limit.root) * most, limit.root * slope};
}

/// constant + factor v + root √s with a line for the root.
void BoxLimits::put_together(const NecessaryLimits::OfPoints& limit, const SearchBox& box, KeptLimit& kept) {
  const HarmonicLimits::Value& value = limits_.values_[std::size_t(limit.value)];
  const std::vector<double>& v = value.function.coefficients();
  kept.coefficients.resize(v.size());
  for (std::size_t i = 0; i < v.size(); ++i) kept.coefficients[i] = limit.factor * v[i];
  double constant = limit.constant + std::abs(limit.factor) * value.error;
  kept.most = std::abs(limit.factor) * value.most + std::abs(limit.constant);
  if (limit.square >= 0) {
    const HarmonicLimits::Value& square = limits_.values_[std::size_t(limit.square)];
    const auto [at_zero, slope] = line_above(limit, box);
    const std::vector<double>& s = square.function.coefficients();
    for (std::size_t i = 0; i < s.size(); ++i) kept.coefficients[i] += slope * s[i];
    constant += at_zero + std::abs(slope) * square.error;
    kept.most += std::abs(slope) * square.most + std::abs(at_zero);
  }
  kept.coefficients.front() += constant;
}

bool BoxLimits::leave(const SearchBox& box) {
  count_ = 0;
  for (const NecessaryLimits::OfPoints& limit : limits_.of_points_) {
    KeptLimit& kept = kept_[count_];
    put_together(limit, box, kept);
    kept.used = false;
    kept.on_box.coefficients() = kept.coefficients;
    kept.on_box.put(box, kept.most);
    if (kept.on_box.largest() < 0) return false;
    if (kept.on_box.smallest() < 0) ++count_;
  }
  return true;
}

BoxLimits::KeptLimit* BoxLimits::lowest_at_top(const BoxTensor& bound) {
  const std::size_t top = bound.top();
  KeptLimit* lowest = nullptr;
  double least = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    KeptLimit& kept = kept_[i];
    if (kept.used) continue;
    const double share = kept.on_box.near(top, bound) / (kept.on_box.largest() - kept.on_box.smallest());
    if (!(share < least)) continue;
    least = share;
    lowest = &kept;
  }
  return lowest;
}

bool BoxLimits::lower(const SearchBox& box, const BoxTensor& divisor, double enough, BoxTensor& bound) {
  for (int added = 0; added < most_added && bound.largest() > enough; ++added) {
    KeptLimit* limit = lowest_at_top(bound);
    if (limit == nullptr) break;
    limit->used = true;
    full_.coefficients() = limit->coefficients;
    full_.put_weighted(box, limit->most);
    if (!full_.divide_by(divisor)) break;
    const double times = bound.best_multiple(full_);
    if (std::isinf(times)) {
      if (full_.largest() < 0) return false;
      continue;
    }
    if (times > 0) bound.add(times, full_);
  }
  return true;
}

int BoxLimits::most_varied() const {
  const KeptLimit* lowest = nullptr;
  double least = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    const KeptLimit& kept = kept_[i];
    const double share = kept.on_box.smallest() / (kept.on_box.largest() - kept.on_box.smallest());
    if (lowest != nullptr && !(share < least)) continue;
    least = share;
    lowest = &kept;
  }
  return lowest == nullptr ? -1 : lowest->on_box.most_varied();
}

void BoxLimits::take_turn(SearchBox& box) const {
  const int other = most_varied();
  if (other < 0) return;
  const auto width = [&](int a) {
    const HarmonicAxis& axis = limits_.form_.axes()[std::size_t(a)];
    return (box.upper[std::size_t(a)] - box.lower[std::size_t(a)]) / (axis.upper - axis.lower);
  };
  if (width(other) > width(box.longest)) box.longest = other;
}

bool BoxLimits::allow(std::span<const double> values, HarmonicForm::Evaluator& evaluator) {
  const NecessaryLimits& limits = limits_.form_.limits();
  for (const NecessaryLimits::OfCoordinates& limit : limits.of_coordinates) {
    double sum = limit.constant;
    for (std::size_t a = 0; a < limit.factors.size(); ++a) sum += limit.factors[a] * values[a];
    if (sum < 0) return false;
  }
  if (limits.values == 0) return true;
  values_.resize(std::size_t(limits.values));
  evaluator.limit_values(values, values_);
  return std::all_of(limits.of_points.begin(), limits.of_points.end(), [&](const NecessaryLimits::OfPoints& limit) {
    const double root =
        limit.square < 0 ? 0.0 : limit.root * std::sqrt(std::max(0.0, values_[std::size_t(limit.square)]));
    return limit.constant + limit.factor * values_[std::size_t(limit.value)] + root >= 0;
  });
}

}  // namespace posewright
