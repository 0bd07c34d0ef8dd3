// Bounds of o2, o3 and o4: against all plans of small instances, and from any E and F.

#include "posewright/planning/spectral_bound.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "posewright/criterion/registry.hpp"
#include "posewright/support/random.hpp"
#include "tests/kit/random_blocks.hpp"

namespace posewright {
namespace {

constexpr int bound_columns = 4;

/// Calls look(M) with the information of every plan of `poses` of the blocks, each at most `repeats` times.
void every_plan(const BlockArray& blocks, int poses, int repeats, const Eigen::MatrixXd& prior,
                const std::function<void(const Eigen::MatrixXd&)>& look) {
  const std::function<void(std::size_t, int, const Eigen::MatrixXd&)> next = [&](std::size_t first, int left,
                                                                                 const Eigen::MatrixXd& M) {
    if (left == 0) return look(M);
    if (first == blocks.count()) return;
    Eigen::MatrixXd more = M;
    for (int taken = 0; taken <= std::min(left, repeats); ++taken) {
      next(first + 1, left - taken, more);
      more += blocks.block(first).transpose() * blocks.block(first);
    }
  };
  next(0, poses, prior);
}

struct Sizes {
  std::string criterion;
  int rows, nuisance, repeats;
  bool prior;
};

class SpectralBounds : public testing::TestWithParam<Sizes> {};

TEST_P(SpectralBounds, NoPlanExceedsTheBoundAndItIsNotFarOff) {
  const Sizes& s = GetParam();
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const BlockArray blocks = random_blocks(11, s.rows, bound_columns, seed);
    CriterionData data{Eigen::MatrixXd::Identity(bound_columns, bound_columns),
                       Eigen::VectorXd::LinSpaced(bound_columns, 0.5, 2.0), s.nuisance};
    const auto criterion = make_criterion(s.criterion, data);
    const Eigen::MatrixXd known = random_blocks(1, 2, bound_columns, 50 + seed).block(0);
    SpectralBoundOptions options;
    options.poses = 5;
    options.repeats = s.repeats;
    if (s.prior) options.prior = known.transpose() * known;
    const auto found = spectral_bound(blocks, criterion->function(), options, Monitor{});
    if (s.criterion == "o2" && s.nuisance > 0) {
      EXPECT_FALSE(found) << "the largest eigenvalue of a Schur complement has no such bound";
      continue;
    }
    ASSERT_TRUE(found);
    // By singular values of the stacked rows' information, nuisance eliminated by the inverse.
    double best = -INFINITY;
    every_plan(
        blocks, options.poses, s.repeats, s.prior ? options.prior : Eigen::MatrixXd::Zero(bound_columns, bound_columns),
        [&](const Eigen::MatrixXd& M) {
          const Eigen::MatrixXd scaled = data.scale.asDiagonal() * M * data.scale.asDiagonal();
          if (std::abs(scaled.determinant()) < 1e-9) return;
          const int interest = bound_columns - s.nuisance;
          const Eigen::VectorXd variance = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(
                                               Eigen::MatrixXd(scaled.inverse().bottomRightCorner(interest, interest)))
                                               .eigenvalues();
          const double least = 1 / std::sqrt(variance[interest - 1]), most = 1 / std::sqrt(variance[0]);
          const double value = s.criterion == "o3" ? least : s.criterion == "o2" ? least / most : least * least / most;
          best = std::max(best, std::log(value));
        });
    EXPECT_GE(found->bound, best - 1e-9) << seed;
    // A bound that says nothing would hold as well; o4's is the product of two.
    EXPECT_LT(found->bound - best, s.criterion == "o4" ? 1.2 : 0.6) << seed;
    EXPECT_LE(found->gap, 2e-2) << seed;
  }
}

std::vector<Sizes> all_sizes() {
  std::vector<Sizes> sizes;
  for (const char* name : {"o2", "o3", "o4"})
    for (const int rows : {1, 2})
      for (const int nuisance : {0, 1})
        for (const int repeats : {1, 2}) sizes.push_back({name, rows, nuisance, repeats, rows == 2});
  return sizes;
}

INSTANTIATE_TEST_SUITE_P(All, SpectralBounds, testing::ValuesIn(all_sizes()), [](const auto& instance) {
  const Sizes& s = instance.param;
  return s.criterion + "_r" + std::to_string(s.rows) + "_nuisance" + std::to_string(s.nuisance) + "_repeats" +
         std::to_string(s.repeats) + (s.prior ? "_prior" : "");
});

TEST(SpectralBound, NoMatricesOfTraceOneGiveAnInvalidBound) {
  // The inequalities themselves, from E and F that nobody has optimised, against every plan.
  const BlockArray blocks = random_blocks(9, 2, bound_columns, 7);
  Random random(5, 0);
  const auto draw = [&] {
    Eigen::MatrixXd X(bound_columns, 1 + random.index(bound_columns));
    for (Eigen::Index i = 0; i < X.size(); ++i) X.data()[i] = random.uniform() - 0.5;
    const Eigen::MatrixXd S = X * X.transpose();
    return Eigen::MatrixXd(S / S.trace());
  };
  for (int trial = 0; trial < 30; ++trial) {
    const Eigen::MatrixXd E = draw(), F = draw();
    const auto sum = [&](const Eigen::MatrixXd& W) {
      std::vector<double> value;
      for (std::size_t i = 0; i < blocks.count(); ++i)
        value.push_back((blocks.block(i) * W * blocks.block(i).transpose()).trace());
      std::sort(value.rbegin(), value.rend());
      return value[0] + value[1] + value[2] + value[3];
    };
    double t = 0.0;
    while (sum(E - t * F) > 0) t += 0.01;
    every_plan(blocks, 4, 1, Eigen::MatrixXd::Zero(bound_columns, bound_columns), [&](const Eigen::MatrixXd& M) {
      const Eigen::VectorXd lambda = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(M).eigenvalues();
      ASSERT_LE(lambda[0], sum(E) + 1e-12);
      ASSERT_LE(lambda[0], t * lambda[bound_columns - 1] + 1e-12);
    });
  }
}

TEST(SpectralBound, IsOfUseAmongManyCandidates) {
  // More candidates than the method works on at a time: the pass over all of them brings the missing ones in.
  const BlockArray blocks = random_blocks(600, 1, 8, 3);
  const CriterionData data{Eigen::MatrixXd::Identity(8, 8), Eigen::VectorXd::Ones(8), 0};
  for (const char* name : {"o2", "o3"}) {
    const auto criterion = make_criterion(name, data);
    SpectralBoundOptions options;
    options.poses = 40;
    const auto found = spectral_bound(blocks, criterion->function(), options, Monitor{});
    ASSERT_TRUE(found);
    EXPECT_LE(found->gap, 1e-2) << name;
    if (std::string(name) == "o2") {
      EXPECT_LE(found->bound, 1e-9) << "no condition number is below one";
    }
  }
}

}  // namespace
}  // namespace posewright
