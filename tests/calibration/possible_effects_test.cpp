// Sizes of a missing effect that drawn readings leave possible. The effect is drawn from its kernel by a dense factor.

#include "posewright/calibration/possible_effects.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/kit/drawn_positioner.hpp"

namespace posewright {
namespace {

class PossibleSizes : public DrawnPositioner {
 protected:
  std::vector<PossibleEffects> possible(int poses, double size, std::uint64_t seed) const {
    return possible_effects(*model_, columns_, drawn(poses, size, pi / 3, 1.0, seed));
  }
  /// Quantile of the size among effects of the true shape.
  double quantile(int poses, double size, std::uint64_t seed, double probability) const {
    std::vector<std::pair<double, double>> sizes;
    double all = 0, sum = 0;
    for (const PossibleEffects& one : possible(poses, size, seed))
      if (one.shape.rotation == 0 && std::abs(one.shape.length - pi / 3) < 1e-9)
        for (const PossibleSize& own : one.sizes) {
          sizes.emplace_back(own.effect, own.probability);
          all += own.probability;
        }
    std::sort(sizes.begin(), sizes.end());
    for (const auto& [effect, own] : sizes)
      if ((sum += own) >= probability * all) return effect;
    return 0;
  }
};

TEST_F(PossibleSizes, LimitHoldsFor95PercentOfRobotsWhoseEffectIsDrawnAsAssumed) {
  constexpr int draws = 100;
  Random random(7, 1);
  for (const int poses : {4, 12}) {
    int held = 0;
    for (int i = 0; i < draws; ++i) {
      const double truth = 0.23e-3 * std::exp(random.uniform(std::log(0.5), std::log(16)));
      // Sizes are tried in steps of 32^(1/9): each counts for half a step around it.
      held += truth <= std::pow(32, 1.0 / 18) * quantile(poses, truth, 40 + std::uint64_t(i), 0.95) ? 1 : 0;
    }
    EXPECT_GE(held, 0.95 * draws - 3 * 2.2) << poses;
  }
}

TEST_F(PossibleSizes, FallsWithPosesWhereThereIsNoEffectAndStaysWhereThereIsOne) {
  const double few = quantile(3, 0.0, 5, 0.95), many = quantile(60, 0.0, 5, 0.95);
  EXPECT_GT(few, 2 * many);
  EXPECT_LT(many, 2 * 0.23e-3);
  EXPECT_GT(quantile(60, 0.9e-3, 5, 0.05), 0.3e-3);
}

TEST_F(PossibleSizes, WithoutADegreeOfFreedomAllStayPossible) {
  const std::vector<PossibleEffects> effects = possible(2, 0.4e-3, 3);
  double sum = 0;
  for (const PossibleEffects& one : effects)
    for (const PossibleSize& size : one.sizes) {
      EXPECT_NEAR(size.probability, effects[0].sizes[0].probability, 1e-12);
      sum += size.probability;
    }
  EXPECT_NEAR(sum, 1, 1e-9);
}

}  // namespace
}  // namespace posewright
