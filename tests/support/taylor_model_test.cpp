// Taylor models. Second road: the same expressions at many places in long double.

#include "posewright/support/taylor_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "posewright/support/random.hpp"
#include "tests/kit/taylor_value.hpp"

namespace posewright {
namespace {

constexpr int places = 40;

/// A function as a model and, at some places of the box, as numbers.
struct Pair {
  TaylorModel model;
  std::vector<long double> values;
};

/// Expressions grow from variables by all that a model can do.
class Expressions {
 public:
  Expressions(int variables, int degree, double width, Random& random) : random_(random) {
    const Monomials& monomials = Monomials::of(variables, degree);
    for (int i = 0; i < places; ++i) {
      places_.emplace_back();
      for (int k = 0; k < variables; ++k)
        places_.back().push_back(i % 4 == 0 ? (random.uniform() < 0.5 ? -1 : 1) : random.uniform(-1, 1));
    }
    for (int k = 0; k < variables; ++k) {
      const double lower = random.uniform(-2, 2), upper = lower + width * random.uniform();
      Pair x{TaylorModel::variable(monomials, k, lower, upper), {}};
      for (const auto& place : places_)
        x.values.push_back((lower + (static_cast<long double>(upper))) / 2 +
                           (static_cast<long double>(upper) - lower) / 2 * place[std::size_t(k)]);
      all.push_back(std::move(x));
    }
  }

  void grow() {
    const Pair &a = any(), &b = any();
    Pair f;
    const int what = random_.index(9);
    const double factor = std::pow(10.0, random_.uniform(-3, 3));
    const auto each = [&](const auto& of) {
      for (std::size_t i = 0; i < places; ++i) f.values.push_back(of(a.values[i], b.values[i]));
    };
    if (what == 0) f.model = a.model + b.model, each([](auto x, auto y) { return x + y; });
    else if (what == 1) f.model = a.model - b.model, each([](auto x, auto y) { return x - y; });
    else if (what < 4) f.model = a.model * b.model, each([](auto x, auto y) { return x * y; });
    else if (what == 4) f.model = inverse(a.model), each([](auto x, auto) { return 1 / x; });
    else if (what == 5) f.model = sqrt(a.model), each([](auto x, auto) { return std::sqrt(x); });
    else if (what == 6) f.model = sin(a.model), each([](auto x, auto) { return std::sin(x); });
    else if (what == 7) f.model = cos(a.model), each([](auto x, auto) { return std::cos(x); });
    else {
      f.model = a.model;
      f.model.add(factor, b.model);
      each([&](auto x, auto y) { return x + factor * y; });
    }
    all.push_back(std::move(f));
  }

  const Pair& any() { return all[std::size_t(random_.index(int(all.size())))]; }
  const std::vector<std::vector<double>>& where() const { return places_; }
  std::vector<Pair> all;

 private:
  Random& random_;
  std::vector<std::vector<double>> places_;
};

TEST(TaylorModel, HoldsEveryValueOfRandomExpressions) {
  int known = 0, judged = 0;
  for (int trial = 0; trial < 60; ++trial) {
    Random random(5, std::uint64_t(trial));
    const int variables = 1 + random.index(6);
    Expressions e(variables, 1 + random.index(variables < 4 ? 7 : 4), std::pow(10.0, random.uniform(-6, 0.5)), random);
    for (int step = 0; step < 12; ++step) e.grow();
    for (const Pair& f : e.all) {
      known += int(f.model.known());
      if (!f.model.known()) continue;
      for (std::size_t i = 0; i < places; ++i) {
        const long double value = f.values[i];
        // Where a root or a quotient is not defined nothing is stated.
        if (!std::isfinite(double(value)) || std::abs(value) > 1e100L) continue;
        ++judged;
        ASSERT_LE(std::abs(value - taylor_value(f.model, e.where()[i])), f.model.radius()) << "trial " << trial;
        ASSERT_LE(value, f.model.upper());
        ASSERT_GE(value, f.model.lower());
      }
    }
  }
  EXPECT_GT(known, 450);
  EXPECT_GT(judged, 15000);
}

TEST(TaylorModel, IsAsNearAsItsDegree) {
  // Halving the box makes the rest of a series of degree D smaller by 2^(D + 1).
  for (int degree = 2; degree <= 4; ++degree) {
    const Monomials& m = Monomials::of(2, degree);
    const auto radius = [&](double half) {
      const TaylorModel x = TaylorModel::variable(m, 0, 1 - half, 1 + half),
                        y = TaylorModel::variable(m, 1, -half, half);
      return (sqrt(x + y) / (x * x + cos(y))).radius();
    };
    const double ratio = radius(0.01) / radius(0.005);
    EXPECT_NEAR(std::log2(ratio), degree + 1, 0.3) << degree;
  }
}

TEST(TaylorModel, OfPolynomialsIsExactUpToRounding) {
  const Monomials& m = Monomials::of(3, 4);
  const TaylorModel x = TaylorModel::variable(m, 0, -2, 3), y = TaylorModel::variable(m, 1, 1, 2),
                    z = TaylorModel::variable(m, 2, -1, 1);
  EXPECT_LT((x * y * z * x - y * y + z).radius(), 1e-11);
  // One degree more is cut off.
  EXPECT_GT((x * y * z * x * z).radius(), 1);
}

TEST(TaylorModel, SaysWhereNothingIsKnown) {
  const Monomials& m = Monomials::of(1, 4);
  const TaylorModel x = TaylorModel::variable(m, 0, -1, 1);
  EXPECT_FALSE(inverse(x).known());
  EXPECT_FALSE(sqrt(x - TaylorModel(2.0)).known());
  EXPECT_FALSE((inverse(x) * TaylorModel(0.0) + x).known());
  // Near zero a root has no series, but a range.
  EXPECT_TRUE(sqrt(x + TaylorModel(1.0)).known());
  EXPECT_GE(sqrt(x + TaylorModel(1.0)).upper(), std::sqrt(2.0));
}

}  // namespace
}  // namespace posewright
