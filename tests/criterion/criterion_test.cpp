#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numeric>

#include "posewright/criterion/inverse_information.hpp"
#include "posewright/criterion/observability_indices.hpp"
#include "posewright/criterion/registry.hpp"
#include "posewright/support/random.hpp"
#include "tests/kit/random_blocks.hpp"

namespace posewright {
namespace {

double schur_log_det(const BlockArray& blocks, const std::vector<int>& members, int nuisance) {
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(blocks.columns(), blocks.columns());
  for (const int i : members) m += blocks.block(std::size_t(i)).transpose() * blocks.block(std::size_t(i));
  const auto log_det = [](const Eigen::MatrixXd& a) { return a.ldlt().vectorD().array().log().sum(); };
  return log_det(m) - (nuisance > 0 ? log_det(m.topLeftCorner(nuisance, nuisance)) : 0.0);
}

TEST(ObservabilityIndices, HandComputedCase) {
  const ObservabilityIndices o = observability_indices(Eigen::Vector3d(4, 2, 1), 3);
  EXPECT_NEAR(o.o1, 2 / std::sqrt(3.0), 1e-15);
  EXPECT_DOUBLE_EQ(o.o2, 0.25);
  EXPECT_DOUBLE_EQ(o.o3, 1);
  EXPECT_DOUBLE_EQ(o.o4, 0.25);
  EXPECT_NEAR(o.o5, 4.0 / 7, 1e-15);
}

TEST(ObservabilityIndices, SingularMeansZero) {
  const ObservabilityIndices o = observability_indices(Eigen::Vector2d(4, 0), 3);
  EXPECT_EQ(o.o1, 0);
  EXPECT_EQ(o.o5, 0);
}

struct Shape {
  int rows, columns, nuisance, repeats;
};

void PrintTo(const Shape& s, std::ostream* out) {
  *out << "r = " << s.rows << ", m = " << s.columns << ", nuisance " << s.nuisance << ", repeats " << s.repeats;
}

class DeterminantSwaps : public testing::TestWithParam<Shape> {};

TEST_P(DeterminantSwaps, GainEqualsRecomputationForEverySwapTaken) {
  const auto [rows, columns, nuisance, repeats] = GetParam();
  const BlockArray blocks = random_blocks(60, rows, columns, 7);
  const CandidateView view{&blocks, nuisance, repeats};
  const auto criterion = make_criterion("o1", {});
  Random random(3, 0);
  std::vector<int> members(std::size_t((columns + rows - 1) / rows + 4));
  std::iota(members.begin(), members.end(), 0);
  const auto state = criterion->start(view, members);
  int compared = 0;
  for (int swap = 0; swap < 1000; ++swap) {
    const int position = random.index(int(members.size()));
    const int enter = random.index(60);
    const auto used = std::count(state->members().begin(), state->members().end(), enter);
    if (used >= repeats) continue;
    state->apply(position, enter);
    // With many repeats a random set can be singular; the state says so and goes on with a ridge.
    if (std::isfinite(state->value())) {
      ++compared;
      EXPECT_NEAR(state->value(), schur_log_det(blocks, state->members(), nuisance), 1e-8) << "swap " << swap;
    }
    if (!std::isfinite(state->value())) state->refresh();
  }
  EXPECT_GT(compared, 700);
}

TEST_P(DeterminantSwaps, BestSwapEqualsExhaustiveSearch) {
  const auto [rows, columns, nuisance, repeats] = GetParam();
  Random random(5, 0);
  int compared = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const BlockArray blocks = random_blocks(40, rows, columns, std::uint64_t(100 + trial));
    const auto state = make_criterion("o1", {})->start({&blocks, nuisance, repeats}, [&] {
      std::vector<int> members(std::size_t((columns + rows - 1) / rows + 1 + trial % 4), -1);
      for (int& i : members) {
        do i = random.index(40);
        while (std::count(members.begin(), members.end(), i) > repeats);
      }
      return members;
    }());
    if (!std::isfinite(state->value())) continue;
    ++compared;
    const int position = random.index(int(state->members().size()));
    const double before = schur_log_det(blocks, state->members(), nuisance);
    double best = 0;
    for (int j = 0; j < 40; ++j) {
      if (std::count(state->members().begin(), state->members().end(), j) >= repeats) continue;
      std::vector<int> members = state->members();
      members[std::size_t(position)] = j;
      best = std::max(best, schur_log_det(blocks, members, nuisance) - before);
    }
    const Swap swap = state->best_swap(position, 1e-9);
    EXPECT_NEAR(swap.enter < 0 ? 0.0 : swap.gain, best, 1e-7 * std::max(1.0, best)) << "trial " << trial;
  }
  EXPECT_GT(compared, 25);
}

INSTANTIATE_TEST_SUITE_P(Shapes, DeterminantSwaps,
                         testing::Values(Shape{1, 6, 0, 1}, Shape{1, 6, 0, 3}, Shape{1, 6, 2, 1}, Shape{3, 7, 0, 1},
                                         Shape{3, 7, 3, 1}, Shape{6, 36, 0, 1}, Shape{3, 30, 10, 2}));

TEST(DeterminantState, SingularStartRecoversWhenTheCandidatesAllowIt) {
  // All members alike: M has rank 3 of 7.
  const BlockArray blocks = random_blocks(40, 3, 7, 11);
  const auto state = make_criterion("o1", {})->start({&blocks, 0, 5}, {4, 4, 4, 4});
  EXPECT_EQ(state->value(), -std::numeric_limits<double>::infinity());
  for (int pass = 0; pass < 3; ++pass)
    for (int p = 0; p < 4; ++p)
      if (const Swap swap = state->best_swap(p, 1e-9); swap.enter >= 0) state->apply(p, swap.enter);
  EXPECT_TRUE(state->refresh());
  EXPECT_NEAR(state->value(), schur_log_det(blocks, state->members(), 0), 1e-9);
}

TEST(InverseInformation, TracesStayTrueOverManySwaps) {
  const BlockArray blocks = random_blocks(80, 2, 9, 21);
  InverseInformation inverse(blocks, 9, nullptr);
  std::vector<int> members = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
  ASSERT_TRUE(inverse.refresh(members, 0));
  Random random(9, 1);
  for (int i = 0; i < 40; ++i) {
    const int p = random.index(10), enter = 10 + random.index(70);
    if (!inverse.change(members[std::size_t(p)], enter)) ASSERT_TRUE(inverse.refresh(members, 0));
    else members[std::size_t(p)] = enter;
  }
  InverseInformation fresh(blocks, 9, nullptr);
  ASSERT_TRUE(fresh.refresh(members, 0));
  for (int j = 0; j < 80; ++j) EXPECT_NEAR(inverse.trace(j), fresh.trace(j), 1e-8 * (1 + fresh.trace(j)));
  EXPECT_NEAR(inverse.log_det(), fresh.log_det(), 1e-9);
}

}  // namespace
}  // namespace posewright
