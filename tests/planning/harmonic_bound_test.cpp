// The largest value of harmonic functions over a box. Second roads: dense grids, local search, functions whose largest
// value is known, and plans on grids of candidates.

#include "posewright/planning/harmonic_bound.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "posewright/support/random.hpp"

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
    for (std::size_t i = 0; i < parts.size(); ++i) {
      double product = 1;
      std::size_t rest = i;
      for (std::size_t a = 0; a < axes.size(); ++a) {
        const std::size_t terms = axes[a].turns ? 3 : 2, k = rest % terms;
        rest /= terms;
        product *= k == 0 ? 1 : !axes[a].turns ? q[a] : k == 1 ? std::cos(q[a]) : std::sin(q[a]);
      }
      J += product * parts[i];
    }
    return J.squaredNorm();
  }
};

HarmonicFunction interpolated(const std::vector<HarmonicAxis>& axes, const Function& f) {
  return HarmonicFunction(
      axes, [&] { return f; }, 1);
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

TEST(LargestValue, IsNeverExceededAndIsReached) {
  Random random(11, 1);
  for (int trial = 0; trial < 300; ++trial) {
    // Scales of columns are as bad as units make them.
    const double scale = trial % 3 == 0 ? 1.0 : trial % 3 == 1 ? 1e-6 : 1e6;
    const RandomSensitivity d(random_axes(1 + trial % 3, random), scale, random);
    HarmonicBoundOptions options;
    options.tolerance = 1e-3;
    options.threads = 1;
    const HarmonicBound most = largest_value(interpolated(d.axes, d), options, Monitor{});
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
    EXPECT_NEAR(d(most.where) / most.largest, 1, 1e-6);
    EXPECT_LE(most.bound, std::max(found, most.largest) * (1 + 2e-3)) << "trial " << trial;
  }
}

TEST(LargestValue, OfAKnownFunctionIsItsOwn) {
  // (2 + cos q)² (1 + x)² over a turn and [0, 2]: 9 · 9 at q = 0, x = 2.
  const Function f = [](std::span<const double> q) { return std::pow(2 + std::cos(q[0]), 2) * std::pow(1 + q[1], 2); };
  const std::vector<HarmonicAxis> axes{{-std::numbers::pi, std::numbers::pi, true}, {0, 2, false}};
  HarmonicBoundOptions options;
  options.tolerance = 1e-9;
  const HarmonicBound most = largest_value(interpolated(axes, f), options, Monitor{});
  EXPECT_NEAR(most.bound, 81, 1e-6);
  EXPECT_GE(most.bound, 81);
}

TEST(LargestValue, OfSeveralTurnsIsThatOfOne) {
  const Function f = [](std::span<const double> q) { return 1 + std::sin(q[0]); };
  HarmonicBoundOptions options;
  const HarmonicBound most = largest_value(interpolated({{-7, 12, true}}, f), options, Monitor{});
  EXPECT_GE(most.bound, 2);
  EXPECT_LE(most.bound, 2.003);
}

TEST(LargestValue, WithoutTheTimeItNeedsIsABoundAllTheSame) {
  Random random(5, 2);
  const RandomSensitivity d({{-3, 3, true}, {-3, 3, true}, {-3, 3, true}}, 1.0, random);
  HarmonicBoundOptions few, many;
  few.most_boxes = 1;
  const HarmonicFunction f = interpolated(d.axes, d);
  const HarmonicBound rough = largest_value(f, few, Monitor{}), fine = largest_value(f, many, Monitor{});
  EXPECT_FALSE(rough.complete);
  EXPECT_TRUE(fine.complete);
  EXPECT_GE(rough.bound, fine.bound);
  EXPECT_GE(fine.bound, fine.largest);
}

TEST(LargestValue, DoesNotDependOnThreads) {
  Random random(6, 2);
  const RandomSensitivity d({{-3, 3, true}, {-2, 3, true}, {-1, 3, true}}, 1.0, random);
  const HarmonicFunction f = interpolated(d.axes, d);
  HarmonicBoundOptions one, three;
  one.threads = 1;
  three.threads = 3;
  const HarmonicBound a = largest_value(f, one, Monitor{}), b = largest_value(f, three, Monitor{});
  EXPECT_EQ(a.bound, b.bound);
  EXPECT_EQ(a.boxes, b.boxes);
  EXPECT_EQ(a.where, b.where);
}

}  // namespace
}  // namespace posewright
