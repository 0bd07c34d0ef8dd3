#include "posewright/proof/factor_bound.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "part_squares.hpp"

namespace posewright {
namespace {

// A range of distances in so many pieces of equal ratio, on each of which derivatives are bounded by those at the ends.
constexpr int pieces = 32;
// Factors are sums of few positive numbers: right to this share of the largest.
constexpr double factor_rounding = 1e-13;
// Lines that rise or fall by less than this share of their value over a range are level.
constexpr double no_slope = 1e-9;
// Distances at which m is twice its value at 0, as shares of the mean: multipliers to choose from, beside 1.
constexpr std::array shares{0.0, 0.1, 0.3, 1.0, 3.0, 10.0};
// What is bent less by a multiplier than this share of what it is without is worth it.
constexpr double worth = 0.9;

/// Value and derivatives of plus and minus at one r: all fall in size with r.
struct Bends {
  double plus, minus, plus_slope, minus_slope, plus_bend, minus_bend;
};

Bends bends_at(const HarmonicPart& part, double r) {
  return {part.plus.value(r),
          part.minus.value(r),
          part.plus.derivative(r),
          part.minus.derivative(r),
          part.plus.second_derivative(r),
          part.minus.second_derivative(r)};
}

double least_product(const Range& a, const Range& b) {
  return std::min({a.lower * b.lower, a.lower * b.upper, a.upper * b.lower, a.upper * b.upper});
}

/// The factor s = plus − minus over a range, piece by piece.
class FactorOverRange {
 public:
  FactorOverRange(const HarmonicPart& part, const Range& r) {
    const double step = std::pow(r.upper / r.lower, 1.0 / pieces);
    for (std::size_t i = 0; i <= pieces; ++i) {
      r_[i] = i == 0 ? r.lower : i == pieces ? r.upper : r_[i - 1] * step;
      at_[i] = bends_at(part, r_[i]);
    }
  }

  Range values() const {
    Range s{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (std::size_t i = 0; i < pieces; ++i) {
      s.lower = std::min(s.lower, at_[i + 1].plus - at_[i].minus);
      s.upper = std::max(s.upper, at_[i].plus - at_[i + 1].minus);
    }
    return s;
  }

  /// Line above s(r) (a + b r): parallel to the chord, above the ends of all pieces by as much as is bent downwards
  /// between them.
  FactorBound line_above(double a, double b) const {
    const auto value = [&](std::size_t i) { return (at_[i].plus - at_[i].minus) * (a + b * r_[i]); };
    FactorBound line;
    const double width = r_[pieces] - r_[0], rise = value(pieces) - value(0);
    // Of what hardly changes the slope would be rounding, and the product with the distance costs time.
    const bool level = std::abs(rise) <= no_slope * std::abs(value(0));
    if (!level && width > no_slope * r_[0]) line.distance = rise / width;
    line.constant = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < pieces; ++i) {
      const Range m{a + b * r_[i], a + b * r_[i + 1]};
      const Range bend{at_[i + 1].plus_bend - at_[i].minus_bend, at_[i].plus_bend - at_[i + 1].minus_bend};
      const double least = least_product(bend, m) + 2 * b * (at_[i].plus_slope - at_[i + 1].minus_slope);
      const double between = 0.125 * std::pow(r_[i + 1] - r_[i], 2) * std::max(0.0, -least);
      for (const std::size_t end : {i, i + 1})
        line.constant = std::max(line.constant, value(end) + between - line.distance * r_[end]);
    }
    return line;
  }

 private:
  std::array<double, pieces + 1> r_{};
  std::array<Bends, pieces + 1> at_{};
};

double bend_of(const HarmonicPart& part, const Multiplier& m, double r) {
  const Bends at = bends_at(part, r);
  return (at.plus_bend - at.minus_bend) * m.value(r) + 2 * m.slope * (at.plus_slope - at.minus_slope);
}

/// s(r) m = s(r) m(r) times the ratio, as large as that may be: good where r varies much.
FactorBound by_ratio(const FactorOverRange& factor, const Multiplier& m, const DistanceRanges& in) {
  FactorBound line = factor.line_above(m.constant, m.slope);
  const double low = line.value(in.r.lower, 0), high = line.value(in.r.upper, 0);
  if (std::min(low, high) < 0 && std::max(low, high) > 0) line = {std::max(low, high), 0, 0, 0};
  const double ratio = std::max(low, high) > 0 ? in.ratio.upper : in.ratio.lower;
  if (!std::isfinite(ratio)) return {ratio, 0, 0, 0};
  line.gap = line.value(in.r.middle(), 0) * (ratio - in.ratio.middle());
  line.constant *= ratio;
  line.distance *= ratio;
  return line;
}

/// s(r) m = s(r) (a + b r) + b s(r) (δ − δ₀), of the second s in the middle of its range and the rest as it is at
/// worst: good where r varies little.
FactorBound by_difference(const FactorOverRange& factor, const Multiplier& m, const DistanceRanges& in) {
  const double b = m.slope, a = m.constant + b * in.delta.middle();
  const Range s = factor.values();
  FactorBound line = factor.line_above(a, b);
  line.difference = b * s.middle();
  line.gap = b * s.half() * in.delta.half();
  line.constant += line.gap - line.difference * in.delta.middle();
  return line;
}

}  // namespace

void cut_by_spread(DistanceRanges& ranges, const Multiplier& multiplier, const DistanceSpread& spread) {
  const Range& r = ranges.r;
  const auto most = [&](double to) { return (spread.slope * std::sqrt(to) + spread.constant) * (1 + factor_rounding); };
  const double step = std::pow(r.upper / r.lower, 1.0 / pieces);
  double share = 0, from = r.lower;
  for (int i = 0; i < pieces; ++i, from *= step)
    share = std::max(share, multiplier.slope * most(from * step) / multiplier.value(from));
  ranges.delta = {std::max(ranges.delta.lower, -most(r.upper)), std::min(ranges.delta.upper, most(r.upper))};
  ranges.ratio = {std::max(ranges.ratio.lower, 1 - share), std::min(ranges.ratio.upper, 1 + share)};
}

FactorBound factor_bound(const HarmonicPart& part, const Multiplier& multiplier, const DistanceRanges& ranges,
                         bool affine) {
  const double r = ranges.r.middle(), delta = ranges.delta.middle(), size = part.plus.value(ranges.r.lower);
  if (!affine) {
    const double constant = size - part.minus.value(ranges.r.upper);
    return {constant, 0, 0, constant - part.factor(r)};
  }
  const FactorOverRange factor(part, ranges.r);
  FactorBound bound = by_ratio(factor, multiplier, ranges);
  if (multiplier.slope > 0)
    if (const FactorBound other = by_difference(factor, multiplier, ranges);
        other.value(r, delta) < bound.value(r, delta))
      bound = other;
  bound.constant += factor_rounding * size * multiplier.value(ranges.r.upper + std::abs(delta) + ranges.delta.half());
  const double from_delta = bound.gap;
  bound.gap = bound.value(r, delta) - part.factor(r) * multiplier.value(r + delta);
  bound.by_delta = from_delta > 0.5 * bound.gap;
  return bound;
}

Multiplier least_bent(const std::vector<HarmonicPart>& parts, std::span<const std::vector<double>> squares,
                      std::span<const std::vector<double>> distances) {
  if (distances.empty() || distances.front().empty()) return {};
  const std::size_t count = distances.front().size();
  double mean = 0, spread = 0;
  std::vector<double> means, differences(count, 0.0), off(count, 0.0);
  for (const auto& r : distances) {
    means.push_back(mean_of(r));
    mean += means.back() / double(distances.size());
    for (std::size_t t = 0; t < count; ++t) differences[t] += (means.back() - r[t]) / double(distances.size());
  }
  for (std::size_t i = 0; i < means.size(); ++i) {
    spread += std::pow(means[i] - mean, 2);
    for (std::size_t t = 0; t < count; ++t) off[t] += std::pow(means[i] - distances[i][t] - differences[t], 2);
  }
  if (!(spread > 0)) return {};
  // Where the distance changes by some step, its difference to the mean changes by this share of it.
  for (double& o : off) o = std::sqrt(o / spread);
  const auto bent = [&](const Multiplier& m) {
    double sum = 0;
    for (std::size_t i = 0; i < means.size(); ++i) {
      double bend = 0, value = 0;
      for (std::size_t k = 0; k < parts.size(); ++k) {
        const int t = parts[k].distance;
        const double r = t < 0 ? means[i] : distances[i][std::size_t(t)];
        value += squares[i][k] * parts[k].factor(r) * m.value(means[i]);
        if (t < 0) continue;
        const double slope = std::abs(parts[k].plus.derivative(r) - parts[k].minus.derivative(r));
        bend += squares[i][k] * (std::abs(bend_of(parts[k], m, r)) / 8 + m.slope * slope * off[std::size_t(t)] / 4);
      }
      if (value > 0) sum += bend / value;
    }
    return sum;
  };
  Multiplier best;
  double least = worth * bent(best);
  for (const double share : shares) {
    const Multiplier m{share * mean, 1.0};
    if (const double b = bent(m); b < least) {
      least = b;
      best = m;
    }
  }
  return best;
}

}  // namespace posewright
