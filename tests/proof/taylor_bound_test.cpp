// The largest sensitivity of spaces that enclose it in Taylor models, cut by limits. Second roads: dense sampling with
// local search, functions whose largest value is known.

#include "posewright/proof/taylor_bound.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "posewright/support/random.hpp"

namespace posewright {
namespace {

/// d and its limits by formulas of their own, for numbers and models alike.
struct Formulas {
  std::function<TaylorModel(std::span<const TaylorModel>)> d;
  std::vector<std::function<TaylorModel(std::span<const TaylorModel>)>> limits;
};

class FormulaSpace : public BoundedSpace {
 public:
  FormulaSpace(std::vector<Axis> axes, Formulas formulas) : axes_(std::move(axes)), formulas_(std::move(formulas)) {}
  const std::vector<Axis>& axes() const override { return axes_; }
  bool is_box() const override { return formulas_.limits.empty(); }
  const Spacing& spacing() const override { return spacing_; }
  std::span<const double> candidate(int) const override { return {}; }
  std::unique_ptr<Probe> probe() const override { return nullptr; }
  HarmonicForms harmonic_forms(const WeightedConfigurations&) const override { return {}; }
  std::unique_ptr<Enclosure> enclosure(const Eigen::MatrixXd&) const override {
    return std::make_unique<Enclosed>(formulas_);
  }

  /// Value at a place; NaN where it is not allowed.
  double at(const std::vector<double>& q) const {
    const std::vector<TaylorModel> place(q.begin(), q.end());
    for (const auto& limit : formulas_.limits)
      if (limit(place).constant() < 0) return std::nan("");
    return formulas_.d(place).constant();
  }

 private:
  class Enclosed : public Enclosure {
   public:
    explicit Enclosed(const Formulas& formulas) : formulas_(formulas) {}
    bool allowed(std::span<const TaylorModel> q, std::vector<TaylorModel>& limits) override {
      for (const auto& limit : formulas_.limits) limits.push_back(limit(q));
      return true;
    }
    bool sensitivity(std::span<const TaylorModel> q, TaylorModel& d) override {
      d = formulas_.d(q);
      return true;
    }

   private:
    const Formulas& formulas_;
  };

  std::vector<Axis> axes_;
  Formulas formulas_;
  Spacing spacing_;
};

BoxSearchResult bound_of(const FormulaSpace& space, double tolerance = 1e-3, int threads = 1, long most_boxes = 20000) {
  BoxSearchOptions options;
  options.tolerance = tolerance;
  options.threads = threads;
  options.most_boxes = most_boxes;
  return largest_enclosed(space, {}, options, Monitor{});
}

/// ‖J(q)‖² of a random J, quadratic in q with a root and a quotient in it, in random half-spaces and a ball.
FormulaSpace random_space(Random& random, double scale) {
  const int n = 1 + random.index(3);
  std::vector<ConfigurationSpace::Axis> axes;
  for (int a = 0; a < n; ++a) {
    const double middle = random.uniform(-1, 1), half = random.uniform(0.01, 0.7);
    axes.push_back({middle - half, middle + half, true, false});
  }
  Eigen::MatrixXd A(3, 2 * n + 2);
  for (double& x : A.reshaped()) x = scale * random.normal();
  Formulas f;
  f.d = [A, n](std::span<const TaylorModel> q) {
    TaylorModel sum, square(4.0);
    for (int a = 0; a < n; ++a) square += q[std::size_t(a)] * q[std::size_t(a)];
    for (Eigen::Index i = 0; i < A.rows(); ++i) {
      TaylorModel row = TaylorModel(A(i, 2 * n)) * sqrt(square) + TaylorModel(A(i, 2 * n + 1)) * inverse(square);
      for (int a = 0; a < n; ++a) {
        row.add(A(i, 2 * a), q[std::size_t(a)]);
        row.add(A(i, 2 * a + 1), sin(q[std::size_t(a)]) * q[std::size_t((a + 1) % n)]);
      }
      sum += row * row;
    }
    return sum;
  };
  for (int k = random.index(4); k > 0; --k) {
    std::vector<double> slope;
    double offset = random.uniform(0, 0.3);
    for (const ConfigurationSpace::Axis& axis : axes) {
      slope.push_back(random.normal());
      offset -= slope.back() * 0.5 * (axis.lower + axis.upper);
    }
    const double bend = random.uniform(-0.5, 0.5);
    f.limits.push_back([=](std::span<const TaylorModel> q) {
      TaylorModel c(offset);
      for (std::size_t a = 0; a < q.size(); ++a) c.add(slope[a], q[a]);
      c.add(bend, q[0] * q[0] - TaylorModel(0.25 * (axes[0].lower + axes[0].upper) * (axes[0].lower + axes[0].upper)));
      return c;
    });
  }
  return {axes, f};
}

TEST(LargestEnclosed, IsNeverExceededAndIsReached) {
  int wide = 0, judged = 0;
  for (int trial = 0; trial < 45; ++trial) {
    Random random(17, std::uint64_t(trial));
    const double scale = trial % 3 == 0 ? 1.0 : trial % 3 == 1 ? 1e-6 : 1e6;
    const FormulaSpace space = random_space(random, scale);
    const BoxSearchResult most = bound_of(space);
    double largest = -1;
    std::vector<double> best, q;
    for (int sample = 0; sample < 1500; ++sample) {
      if (sample >= 700 && best.empty()) break;
      q.clear();
      for (std::size_t a = 0; a < space.axes().size(); ++a) {
        const ConfigurationSpace::Axis& axis = space.axes()[a];
        const double width = axis.upper - axis.lower, reach = std::pow(0.98, sample - 700);
        const double at = sample < 700 ? random.uniform(axis.lower - 0.1 * width, axis.upper + 0.1 * width)
                                       : best[a] + reach * width * random.normal();
        q.push_back(std::clamp(at, axis.lower, axis.upper));
      }
      if (const double value = space.at(q); value > largest) largest = value, best = q;
    }
    if (best.empty()) continue;
    ++judged;
    ASSERT_TRUE(most.complete) << "trial " << trial;
    EXPECT_LE(largest, most.bound * (1 + 1e-12)) << "trial " << trial;
    wide += int(most.bound > 1.005 * largest);
  }
  EXPECT_GT(judged, 40);
  // Random steps along two limits at once do not always arrive.
  EXPECT_LE(wide, judged / 10);
}

TEST(LargestEnclosed, OnALimitIsThatOfItsCorner) {
  // x² + y² where x + y ≤ 1 in [0, 1]²: 1, and 1/2 between; the square alone has 2.
  Formulas f;
  f.d = [](std::span<const TaylorModel> q) { return q[0] * q[0] + q[1] * q[1]; };
  f.limits = {[](std::span<const TaylorModel> q) { return TaylorModel(1.0) - q[0] - q[1]; }};
  const FormulaSpace space({{0, 1, true, false}, {0, 1, true, false}}, f);
  const BoxSearchResult most = bound_of(space, 1e-6);
  EXPECT_TRUE(most.complete);
  EXPECT_GE(most.bound, 1);
  EXPECT_LE(most.bound, 1 + 3e-6);
}

TEST(LargestEnclosed, NeedsFewBoxesWhereALimitHoldsItBack) {
  // 1 + x + y + z² below a plane across the whole box: without multipliers the boxes along it would be thousands.
  Formulas f;
  f.d = [](std::span<const TaylorModel> q) { return TaylorModel(1.0) + q[0] + q[1] + q[2] * q[2]; };
  f.limits = {[](std::span<const TaylorModel> q) { return TaylorModel(0.3) - q[0] - q[1]; }};
  const FormulaSpace space({{-1, 1, true, false}, {-1, 1, true, false}, {-1, 1, true, false}}, f);
  const BoxSearchResult most = bound_of(space, 1e-3);
  EXPECT_LT(most.bound, 2.3 * 1.002);
  EXPECT_GE(most.bound, 2.3);
  EXPECT_LT(most.boxes, 1500);
}

TEST(LargestEnclosed, StoppedAtAnyTimeIsABound) {
  Random random(3, 3);
  const FormulaSpace space = random_space(random, 1.0);
  double before = std::numeric_limits<double>::infinity();
  const double fine = bound_of(space, 1e-6).bound;
  for (const long boxes : {1L, 30L, 100L}) {
    const BoxSearchResult rough = bound_of(space, 1e-6, 1, boxes);
    EXPECT_GE(rough.bound, fine);
    EXPECT_LE(rough.bound, before);
    before = rough.bound;
  }
  // Interrupted before the first box, nothing is known.
  Monitor over;
  over.deadline = Monitor::Clock::now();
  EXPECT_FALSE(std::isfinite(largest_enclosed(space, {}, {}, over).bound));
}

TEST(LargestEnclosed, OfNothingFeasibleIsLessThanAnything) {
  Formulas f;
  f.d = [](std::span<const TaylorModel> q) { return q[0]; };
  f.limits = {[](std::span<const TaylorModel> q) { return q[0] * q[0] - TaylorModel(2.0); }};
  EXPECT_LT(bound_of(FormulaSpace({{-1, 1, true, false}}, f)).bound, -1e300);
}

TEST(LargestEnclosed, DoesNotDependOnThreads) {
  for (int trial = 0; trial < 5; ++trial) {
    Random random(8, std::uint64_t(trial));
    const FormulaSpace space = random_space(random, 1.0);
    const BoxSearchResult a = bound_of(space, 1e-5, 1), b = bound_of(space, 1e-5, 3);
    EXPECT_EQ(a.bound, b.bound);
    EXPECT_EQ(a.boxes, b.boxes);
    EXPECT_EQ(a.found.where, b.found.where);
  }
}

}  // namespace
}  // namespace posewright
