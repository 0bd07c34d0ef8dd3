// Taylor models. Second road: the same expressions at many places in long double.

#include "posewright/support/taylor_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "posewright/support/random.hpp"
#include "src/support/taylor/taylor_kernels.hpp"
#include "tests/kit/taylor_value.hpp"

namespace posewright {
namespace {

constexpr std::size_t places = 40, boxes = TaylorModel::boxes;

/// A function as a model and, at some places of each box, as numbers: box after box.
struct Pair {
  TaylorModel model;
  std::vector<long double> values;
};

/// Expressions grow from variables by all that a model can do.
class Expressions {
 public:
  Expressions(int variables, int degree, double width, Random& random) : random_(random) {
    const Monomials& monomials = Monomials::of(variables, degree);
    for (std::size_t i = 0; i < places; ++i) {
      places_.emplace_back();
      for (int k = 0; k < variables; ++k)
        places_.back().push_back(i % 4 == 0 ? (random.uniform() < 0.5 ? -1 : 1) : random.uniform(-1, 1));
    }
    // Boxes of all widths side by side, in any order.
    const std::size_t widest = std::size_t(random.index(int(boxes)));
    for (int k = 0; k < variables; ++k) {
      TaylorModel::Values lower, upper;
      for (std::size_t box = 0; box < boxes; ++box) {
        lower[box] = random.uniform(-2, 2);
        upper[box] = lower[box] + width * std::pow(10.0, -0.5 * double((box + widest) % boxes)) * random.uniform();
      }
      Pair x{TaylorModel::variable(monomials, k, lower, upper), {}};
      for (std::size_t box = 0; box < boxes; ++box)
        for (const auto& place : places_)
          x.values.push_back((lower[box] + (static_cast<long double>(upper[box]))) / 2 +
                             (static_cast<long double>(upper[box]) - lower[box]) / 2 * place[std::size_t(k)]);
      all.push_back(std::move(x));
    }
    // A number that is not known exactly.
    Pair between;
    for (std::size_t box = 0; box < boxes; ++box) {
      const double lower = random.uniform(-2, 2), upper = lower + width * random.uniform();
      between.model.put_between(box, lower, upper);
      for (std::size_t i = 0; i < places; ++i) between.values.push_back(random.uniform(lower, upper));
    }
    all.push_back(std::move(between));
  }

  void grow() {
    const Pair &a = any(), &b = any();
    Pair f;
    const int what = random_.index(9);
    TaylorModel::Values factor;
    for (double& x : factor) x = random_.uniform() < 0.2 ? 0.0 : std::pow(10.0, random_.uniform(-3, 3));
    const auto each = [&](const auto& of) {
      for (std::size_t i = 0; i < boxes * places; ++i) f.values.push_back(of(a.values[i], b.values[i]));
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
      for (std::size_t i = 0; i < boxes * places; ++i)
        f.values.push_back(a.values[i] + (factor[i / places] == 0 ? 0.0L : factor[i / places] * b.values[i]));
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
      const TaylorModel::Values lower = f.model.lowers(), upper = f.model.uppers();
      for (std::size_t box = 0; box < boxes; ++box) {
        known += int(f.model.known(box));
        if (!f.model.known(box)) continue;
        for (std::size_t i = 0; i < places; ++i) {
          const long double value = f.values[box * places + i];
          // Where a root or a quotient is not defined nothing is stated.
          if (!std::isfinite(double(value)) || std::abs(value) > 1e100L) continue;
          ++judged;
          ASSERT_LE(std::abs(value - taylor_value(f.model, e.where()[i], box)), f.model.radius(box))
              << "trial " << trial << ", box " << box;
          ASSERT_LE(value, upper[box]);
          ASSERT_GE(value, lower[box]);
          ASSERT_LE(std::abs(value), f.model.farthest()[box]);
        }
      }
    }
  }
  EXPECT_GT(known, 450 * int(boxes));
  EXPECT_GT(judged, 15000 * int(boxes));
}

// What is found of a box must not depend on those beside it, but for the order in which a sum is rounded.
TEST(TaylorModel, SaysTheSameOfABoxByItself) {
  const Monomials& m = Monomials::of(2, 4);
  const auto function = [&](const TaylorModel::Values& lower, const TaylorModel::Values& upper) {
    const TaylorModel x = TaylorModel::variable(m, 0, lower, upper), y = TaylorModel::variable(m, 1, lower, upper);
    return sqrt(x + TaylorModel(1.0)) * inverse(y) + sin(x * y);
  };
  // Some hold 0, others are beyond the root's range, others small.
  const TaylorModel::Values lower = {0.5, -0.1, 1, -3, 2, 0.1, -0.9, 1}, upper = {0.6, 0.1, 2, -2.9, 2.1, 3, -0.8, 1};
  const TaylorModel together = function(lower, upper);
  int known = 0;
  for (std::size_t box = 0; box < boxes; ++box) {
    TaylorModel::Values l, u;
    l.fill(lower[box]);
    u.fill(upper[box]);
    const TaylorModel alone = function(l, u);
    EXPECT_EQ(alone.known(), together.known(box)) << box;
    if (!alone.known()) continue;
    ++known;
    EXPECT_NEAR(alone.radius(), together.radius(box), 1e-9 * alone.radius()) << box;
    for (std::size_t i = 0; i < alone.terms(); ++i)
      EXPECT_NEAR(alone.coefficient(i), together.coefficient(i, box), 1e-13) << box;
  }
  EXPECT_EQ(known, 6);
}

TEST(TaylorModel, KernelsOfAllInstructionsComputeTheSameBits) {
  const Monomials& m = Monomials::of(3, 4);
  const std::size_t terms = m.count(), terms_a = 17;
  Random random(7, 0);
  const auto drawn = [&](std::size_t size) {
    std::vector<double> x(size);
    for (double& one : x) one = random.uniform(-1, 1);
    return x;
  };
  const std::vector<double> start = drawn(boxes * terms), a = drawn(boxes * terms_a), b = drawn(boxes * terms);
  // By the definition: products, sum, sizes; the first of a is the factor.
  std::vector<double> products = start, sum = start, multiple(boxes * terms);
  std::vector<double> of_sum(2 * boxes, 0.0), of_multiple(boxes, 0.0);
  for (std::size_t i = 1; i < terms_a; ++i)
    for (std::size_t j = 1; j < terms; ++j)
      for (std::size_t to = 0; to < terms; ++to) {
        bool is_product = true;
        for (std::size_t v = 0; v < 3; ++v)
          is_product = is_product && m.exponents(i)[v] + m.exponents(j)[v] == m.exponents(to)[v];
        for (std::size_t k = 0; is_product && k < boxes; ++k)
          products[boxes * to + k] += a[boxes * i + k] * b[boxes * j + k];
      }
  for (std::size_t j = 0; j < terms; ++j)
    for (std::size_t k = 0; k < boxes; ++k) {
      sum[boxes * j + k] += a[k] * b[boxes * j + k];
      multiple[boxes * j + k] = a[k] * b[boxes * j + k];
      of_sum[k] += std::abs(b[boxes * j + k]);
      of_sum[boxes + k] += std::abs(sum[boxes * j + k]);
      of_multiple[k] += std::abs(multiple[boxes * j + k]);
    }
  const auto check = [&](const TaylorKernels& kernels) {
    std::vector<double> out = start, sizes(2 * boxes), one(boxes);
    kernels.add_products(out.data(), a.data(), terms_a, b.data(), terms,
                         {m.products(0), m.first_products().data(), m.counts().data(), m.degree()});
    EXPECT_EQ(out, products);
    out = start;
    kernels.add_multiple(out.data(), a.data(), b.data(), terms, sizes.data());
    EXPECT_EQ(out, sum);
    EXPECT_EQ(sizes, of_sum);
    kernels.take_multiple(out.data(), a.data(), b.data(), terms, one.data());
    EXPECT_EQ(out, multiple);
    EXPECT_EQ(one, of_multiple);
    kernels.sum_sizes(b.data(), terms, one.data());
    EXPECT_EQ(one, std::vector<double>(of_sum.begin(), of_sum.begin() + boxes));
  };
  check(taylor_kernels_sse2);
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2")) check(taylor_kernels_avx2);
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl")) check(taylor_kernels_avx512);
#endif
}

TEST(TaylorModel, ZeroTimesKnownIsZeroAndTimesUnknownIsUnknown) {
  TaylorModel x = TaylorModel::variable(Monomials::of(2, 3), 0, 1.0, 2.0);
  EXPECT_TRUE((TaylorModel(0.0) * x).is_zero());
  EXPECT_TRUE((x * TaylorModel(0.0)).is_zero());
  x.put_unknown(3);
  const TaylorModel product = TaylorModel(0.0) * x;
  EXPECT_TRUE(product.known(2));
  EXPECT_FALSE(product.known(3));
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
