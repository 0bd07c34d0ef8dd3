// The largest value of harmonic functions over a box. Second roads: dense grids, local search, functions whose largest
// value is known, and plans on grids of candidates.

#include "posewright/proof/harmonic_bound.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "posewright/support/random.hpp"
#include "src/proof/box_tensor.hpp"
#include "tests/kit/basis_product.hpp"

namespace posewright {
namespace {

using Function = std::function<double(std::span<const double>)>;

/// ‖J(q) T‖² of a random J whose entries are linear in 1, cos, sin of angles and in lengths.
struct RandomSensitivity {
  std::vector<HarmonicAxis> axes;
  std::vector<Eigen::MatrixXd> parts;  // of all products of 1, cos, sin or 1, x

  RandomSensitivity(std::vector<HarmonicAxis> axes_, double scale, Random& random) : axes(std::move(axes_)) {
    std::size_t count = 1;
    for (const HarmonicAxis& axis : axes) count *= axis.turns ? 3 : 2;
    for (std::size_t i = 0; i < count; ++i) {
      parts.emplace_back(3, 4);
      for (double& x : parts.back().reshaped()) x = scale * random.normal();
    }
  }
  double operator()(std::span<const double> q) const {
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(3, 4);
    for (std::size_t i = 0; i < parts.size(); ++i) J += basis_product(axes, i, q) * parts[i];
    return J.squaredNorm();
  }
};

HarmonicFunction interpolated(const std::vector<HarmonicAxis>& axes, const Function& f) {
  return HarmonicFunction(
      axes, std::vector<int>(axes.size(), 2), [&] { return f; }, 1);
}

std::vector<HarmonicAxis> random_axes(int count, Random& random) {
  std::vector<HarmonicAxis> axes;
  for (int a = 0; a < count; ++a) {
    const double lower = random.uniform(-4, 2), width = random.uniform(0.1, 7);
    axes.push_back({lower, lower + width, random.uniform() < 0.7});
  }
  return axes;
}

TEST(HarmonicFunction, IsTheFunctionItself) {
  Random random(3, 1);
  for (int trial = 0; trial < 20; ++trial) {
    const RandomSensitivity d(random_axes(3, random), 1.0, random);
    const HarmonicFunction f = interpolated(d.axes, d);
    for (int i = 0; i < 20; ++i) {
      std::vector<double> q;
      for (const HarmonicAxis& axis : d.axes) q.push_back(random.uniform(axis.lower, axis.upper));
      EXPECT_NEAR(f.value(q), d(q), 1e-10 * (1 + std::abs(d(q))));
    }
  }
}

TEST(HarmonicFunction, OfAnyDegreeIsTheFunctionItselfAndSoAreProducts) {
  Random random(4, 1);
  for (int trial = 0; trial < 10; ++trial) {
    const std::vector<HarmonicAxis> axes = random_axes(2, random);
    std::vector<int> degrees;
    for (std::size_t a = 0; a < axes.size(); ++a) degrees.push_back(random.index(5));
    // cos and sin of multiples, or powers, up to the degree.
    std::vector<double> weights(64);
    for (double& w : weights) w = random.normal();
    const auto f = [&, axes, degrees](std::span<const double> q) {
      double sum = 0;
      for (int i = 0; i <= degrees[0]; ++i)
        for (int j = 0; j <= degrees[1]; ++j) {
          const auto along = [&](std::size_t a, int n, double w) {
            return axes[a].turns ? std::cos(n * q[a]) + w * std::sin(n * q[a]) : std::pow(q[a], n);
          };
          const double w = weights[std::size_t(8 * i + j)];
          sum += w * along(0, i, w) * along(1, j, 1 - w);
        }
      return sum;
    };
    const HarmonicFunction own(
        axes, degrees, [&] { return f; }, 1);
    const std::vector<int> twice{2 * degrees[0], 2 * degrees[1]}, more{2 * degrees[0] + 1, 2 * degrees[1]};
    const HarmonicFunction square = HarmonicFunction::product(own, own, more);
    for (int i = 0; i < 20; ++i) {
      std::vector<double> q;
      for (const HarmonicAxis& axis : axes) q.push_back(random.uniform(axis.lower, axis.upper));
      const double value = f(q), size = 1e-9 * (1 + value * value) * std::pow(8.0, degrees[0] + degrees[1]);
      EXPECT_NEAR(own.value(q), value, size);
      EXPECT_NEAR(own.lifted(twice).value(q), value, size);
      EXPECT_NEAR(square.value(q), value * value, size);
    }
  }
}

/// Largest gap over the factor, and none below it, for distances and differences all over their ranges.
double gap_over(const HarmonicPart& part, const Multiplier& m, const Range& r, const Range& delta, bool affine) {
  DistanceRanges ranges{r, delta, {1e300, -1e300}};
  // A quotient of two lines has its limits at corners.
  for (const double at : {r.lower, r.upper})
    for (const double off : {delta.lower, delta.upper}) {
      const double ratio = m.value(at + off) / m.value(at);
      ranges.ratio = {std::min(ranges.ratio.lower, ratio), std::max(ranges.ratio.upper, ratio)};
    }
  const FactorBound bound = factor_bound(part, m, ranges, affine);
  double gap = 0;
  for (int i = 0; i <= 50; ++i)
    for (int k = 0; k <= 10; ++k) {
      const double at = r.lower + (r.upper - r.lower) * i / 50,
                   off = delta.lower + (delta.upper - delta.lower) * k / 10;
      const double value = part.factor(at) * m.value(at + off);
      EXPECT_GE(bound.value(at, off), value - 1e-9 * std::abs(value));
      gap = std::max(gap, bound.value(at, off) - value);
    }
  return gap;
}

TEST(FactorBound, IsAboveTheFactorAndConvergesWithTheSquareOfTheRange) {
  Random random(9, 1);
  for (int trial = 0; trial < 300; ++trial) {
    const double along = random.uniform(0.1, 1), across = along + random.uniform(0, 3);
    HarmonicPart part;
    part.distance = 0;
    part.plus = squared(along, random.uniform(0, 0.2), 1);
    part.minus = squared(across, random.uniform(0.2, 2), 1);
    if (trial % 5 == 0) part.minus.weight = 0;
    if (trial % 5 == 1) part.plus = squared(0.0, random.uniform(0.2, 2), 1);
    if (trial % 5 == 1) part.minus.weight = 0;
    part.plus.over_square = part.minus.over_square = trial % 2 == 0;
    const Multiplier m = trial % 3 == 0 ? Multiplier{} : Multiplier{random.uniform(0, 3), 1.0};
    const double lower = random.uniform(0.5, 4), width = random.uniform(0.01, 0.5) * lower;
    const double delta = random.uniform(-0.1, 0.1), off = random.uniform(0, 0.1);
    const double whole = gap_over(part, m, {lower, lower + width}, {delta - off, delta + off}, true);
    const double half = gap_over(part, m, {lower, lower + width / 2}, {delta - off / 2, delta + off / 2}, true);
    EXPECT_LT(half, 0.5 * whole + 1e-9) << "trial " << trial;
    gap_over(part, {}, {lower, lower + width}, {0, 0}, false);
    // Far too wide ranges, as an arm's first boxes have, are bounded all the same.
    EXPECT_TRUE(std::isfinite(gap_over(part, m, {lower, 40 * lower}, {-0.4 * lower, 3 * lower}, true)));
  }
}

TEST(FactorBound, IsANumberWhereNothingIsKnownOfTheRatio) {
  HarmonicPart part;
  part.distance = 0;
  part.plus = squared(0.0, 0.5, 1);
  const FactorBound bound =
      factor_bound(part, {0.0, 1.0}, {{1, 2}, {-0.1, 0.1}, {0, std::numeric_limits<double>::infinity()}}, true);
  for (const double r : {1.0, 1.5, 2.0})
    for (const double delta : {-0.1, 0.1}) EXPECT_GE(bound.value(r, delta), part.factor(r) * (r + delta));
  EXPECT_TRUE(std::isfinite(bound.value(1.5, 0)));
}

TEST(FactorBound, OfAnAngleTimesADistanceIsExactUnderTheMultiplier) {
  // 1/(s r) times r̄ = r is 1/s everywhere.
  HarmonicPart part;
  part.distance = 0;
  part.plus = squared(0.0, 0.5, 1);
  EXPECT_LT(gap_over(part, {0.0, 1.0}, {1, 2}, {0, 0}, true), 1e-5 * part.factor(1));
  EXPECT_GT(gap_over(part, {}, {1, 2}, {0, 0}, true), 0.05 * part.factor(1));
  // So least_bent() chooses it, and none where nothing falls with the distance.
  std::vector<std::vector<double>> squares, distances;
  for (double r = 1; r < 20; r *= 1.3) {
    squares.push_back({1.0});
    distances.push_back({r});
  }
  EXPECT_EQ(least_bent({part}, squares, distances).constant, 0.0);
  EXPECT_EQ(least_bent({part}, squares, distances).slope, 1.0);
  part.plus = squared(0.5, 0.0, 1);
  EXPECT_EQ(least_bent({part}, squares, distances).slope, 0.0);
}

TEST(BoxTensor, TheBestMultipleIsThatOfTryingMany) {
  Random random(8, 1);
  const std::vector<HarmonicAxis> axes{{0, 1, false}, {0, 1, false}};
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<double> d(9), c(9);
    for (double& x : d) x = random.normal();
    for (double& x : c) x = random.normal();
    const auto largest = [&](double times) {
      double most = -1e300;
      for (std::size_t i = 0; i < d.size(); ++i) most = std::max(most, d[i] + times * c[i]);
      return most;
    };
    BoxTensor bound(axes, {2, 2}), limit(axes, {2, 2});
    bound.take(d, {3, 3}, 0.0);
    limit.take(c, {3, 3}, 0.0);
    const double times = bound.best_multiple(limit);
    if (std::isinf(times)) {
      EXPECT_LT(*std::max_element(c.begin(), c.end()), 0.0);
      continue;
    }
    for (double other = 0; other < 20; other += 0.01) EXPECT_LE(largest(times), largest(other) + 1e-4) << trial;
    bound.add(times, limit);
    EXPECT_NEAR(bound.largest(), largest(times), 1e-9);
  }
}

TEST(BoxTensor, NoMultipleIsSoughtOfWhatIsNotFinite) {
  const std::vector<HarmonicAxis> axes{{0, 1, false}};
  BoxTensor bound(axes, {1}), limit(axes, {1});
  limit.take({-1.0, 1.0}, {2}, 0.0);
  for (const double top : {std::numeric_limits<double>::infinity(), std::nan("")}) {
    bound.take({top, 0.0}, {2}, 0.0);
    EXPECT_EQ(bound.best_multiple(limit), 0.0);
  }
  // Nothing to be lowered: any multiple will do, as long as there is one.
  bound.take({0.0, -1.0}, {2}, 0.0);
  EXPECT_GE(bound.best_multiple(limit), 0.0);
}

/// Axes, and one part on them.
class FormOfAxes : public HarmonicForm {
 public:
  explicit FormOfAxes(std::vector<HarmonicAxis> axes) {
    axes_ = std::move(axes);
    parts_.resize(1);
  }
  std::unique_ptr<Evaluator> evaluator() const override { return nullptr; }
  std::vector<double> configuration(std::span<const double>) const override { return {}; }
  std::vector<double> values(std::span<const double>) const override { return {}; }
};

TEST(HarmonicSensitivity, CostsOfAnArmAreCountedBeforeAnythingIsComputed) {
  const HarmonicAxis turn{-std::numbers::pi, std::numbers::pi, true}, slide{0.0, 1.0, false};
  const FormOfAxes form({turn, turn, turn, slide});
  const auto cost = HarmonicSensitivity::cost(form, {{2, 2, 2, 2}});
  // 1, cos, sin, cos 2, sin 2 of each angle, 1, x, x² of the length; for the part and for the tensor of a box.
  EXPECT_EQ(cost.coefficients, 2 * 5 * 5 * 5 * 3);
  EXPECT_EQ(cost.work, 5 * 5 * 5 * 3);
  EXPECT_EQ(cost.boxes, 3 * 3 * 3);

  Random random(5, 1);
  for (int trial = 0; trial < 20; ++trial) {
    const FormOfAxes any(random_axes(4, random));
    const std::vector<int> degrees{2, 0, 1, 2};
    EXPECT_EQ(HarmonicSensitivity::cost(any, {degrees}).boxes, double(parts_of_everything(any.axes(), degrees).size()));
  }
}

TEST(LargestValue, IsNeverExceededAndIsReached) {
  Random random(11, 1);
  for (int trial = 0; trial < 300; ++trial) {
    // Scales of columns are as bad as units make them.
    const double scale = trial % 3 == 0 ? 1.0 : trial % 3 == 1 ? 1e-6 : 1e6;
    const RandomSensitivity d(random_axes(1 + trial % 3, random), scale, random);
    BoxSearchOptions options;
    options.tolerance = 1e-3;
    options.threads = 1;
    const BoxSearchResult most = largest_value(interpolated(d.axes, d), options, Monitor{});
    ASSERT_TRUE(most.complete);
    double found = 0;
    std::vector<double> q(d.axes.size()), best(d.axes.size());
    const auto look_at = [&] {
      const double value = d(q);
      EXPECT_LE(value, most.bound) << "trial " << trial;
      if (value > found) {
        found = value;
        best = q;
      }
    };
    for (int i = 0; i < 3000; ++i) {
      for (std::size_t a = 0; a < q.size(); ++a) {
        q[a] = random.uniform(d.axes[a].lower, d.axes[a].upper);
        if (const double edge = random.uniform(); edge < 0.2) q[a] = edge < 0.1 ? d.axes[a].lower : d.axes[a].upper;
      }
      look_at();
    }
    // From the best of them, ever smaller steps.
    for (double step = 0.5; step > 1e-6; step *= 0.7)
      for (int i = 0; i < 20; ++i) {
        for (std::size_t a = 0; a < q.size(); ++a)
          q[a] = std::clamp(best[a] + step * random.normal(), d.axes[a].lower, d.axes[a].upper);
        look_at();
      }
    EXPECT_NEAR(d(most.found.where) / most.largest, 1, 1e-6);
    EXPECT_LE(most.bound, std::max(found, most.largest) * (1 + 2e-3)) << "trial " << trial;
  }
}

TEST(LargestValue, OfAKnownFunctionIsItsOwn) {
  // (2 + cos q)² (1 + x)² over a turn and [0, 2]: 9 · 9 at q = 0, x = 2.
  const Function f = [](std::span<const double> q) { return std::pow(2 + std::cos(q[0]), 2) * std::pow(1 + q[1], 2); };
  const std::vector<HarmonicAxis> axes{{-std::numbers::pi, std::numbers::pi, true}, {0, 2, false}};
  BoxSearchOptions options;
  options.tolerance = 1e-9;
  const BoxSearchResult most = largest_value(interpolated(axes, f), options, Monitor{});
  EXPECT_NEAR(most.bound, 81, 1e-6);
  EXPECT_GE(most.bound, 81);
}

TEST(LargestValue, OfSeveralTurnsIsThatOfOne) {
  const Function f = [](std::span<const double> q) { return 1 + std::sin(q[0]); };
  BoxSearchOptions options;
  const BoxSearchResult most = largest_value(interpolated({{-7, 12, true}}, f), options, Monitor{});
  EXPECT_GE(most.bound, 2);
  EXPECT_LE(most.bound, 2.003);
}

TEST(LargestValue, WithoutTheTimeItNeedsIsABoundAllTheSame) {
  Random random(5, 2);
  const RandomSensitivity d({{-3, 3, true}, {-3, 3, true}, {-3, 3, true}}, 1.0, random);
  BoxSearchOptions few, many;
  few.most_boxes = 1;
  const HarmonicFunction f = interpolated(d.axes, d);
  const BoxSearchResult rough = largest_value(f, few, Monitor{}), fine = largest_value(f, many, Monitor{});
  EXPECT_FALSE(rough.complete);
  EXPECT_TRUE(fine.complete);
  EXPECT_GE(rough.bound, fine.bound);
  EXPECT_GE(fine.bound, fine.largest);
}

TEST(LargestValue, IsNotBoundedByWhatIsNoNumber) {
  // 1 everywhere, but for a part of the box about which its judge knows nothing.
  class Judge : public BoxJudge {
    void judge(SearchBox& box, double, LargestFound& found) override {
      box.bound = box.lower[0] <= 0.3 && box.upper[0] >= 0.3 ? std::nan("") : 1.0;
      found.value = 1.0;
      found.where = {1.0};
    }
  };
  SearchBox whole;
  whole.lower = {0.0};
  whole.upper = {1.0};
  BoxSearchOptions options;
  options.most_boxes = 50;
  const BoxSearchResult most = largest_value(
      {whole}, [] { return std::make_unique<Judge>(); }, options, Monitor{});
  EXPECT_FALSE(most.complete);
  EXPECT_EQ(most.bound, std::numeric_limits<double>::infinity());
}

TEST(LargestValue, DoesNotDependOnThreads) {
  Random random(6, 2);
  const RandomSensitivity d({{-3, 3, true}, {-2, 3, true}, {-1, 3, true}}, 1.0, random);
  const HarmonicFunction f = interpolated(d.axes, d);
  BoxSearchOptions one, three;
  one.threads = 1;
  three.threads = 3;
  const BoxSearchResult a = largest_value(f, one, Monitor{}), b = largest_value(f, three, Monitor{});
  EXPECT_EQ(a.bound, b.bound);
  EXPECT_EQ(a.boxes, b.boxes);
  EXPECT_EQ(a.found.where, b.found.where);
}

}  // namespace
}  // namespace posewright
