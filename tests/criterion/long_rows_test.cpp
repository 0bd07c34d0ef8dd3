// Swaps of single rows that are long enough for their products with all candidates to be kept, against log det of
// every set with one member exchanged.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "planners/local_search.hpp"
#include "posewright/criterion/determinant.hpp"
#include "posewright/support/dense.hpp"
#include "tests/kit/random_blocks.hpp"

namespace posewright {
namespace {

constexpr int columns = 70, poses = 110, candidates = 260;

class LongRows : public testing::TestWithParam<int> {  // repeats
 protected:
  LongRows() : blocks(random_blocks(candidates, 1, columns, 4)) {
    const Eigen::MatrixXd rows = random_blocks(1, 5, columns, 9).block(0);
    prior = 0.1 * rows.transpose() * rows;
    view = {&blocks, 0, GetParam(), &prior};
    for (int i = 0; i < poses; ++i) start.push_back(GetParam() > 1 ? i % 100 : i);
  }

  Eigen::MatrixXd information(const std::vector<int>& members) const {
    Eigen::MatrixXd M = prior;
    for (const int i : members) M += square(i);
    return M;
  }

  Eigen::MatrixXd square(int candidate) const {
    return blocks.block(std::size_t(candidate)).transpose() * blocks.block(std::size_t(candidate));
  }

  static double log_det(const Eigen::MatrixXd& M) {
    return Eigen::VectorXd(Eigen::MatrixXd(M.llt().matrixL()).diagonal()).array().log().sum() * 2;
  }

  /// Largest gain at a position by trying all who may enter.
  double best_gain(const DesignState& state, int position) const {
    const int left = state.members()[std::size_t(position)];
    const Eigen::MatrixXd M = information(state.members());
    const double before = log_det(M);
    double best = 0.0;
    for (int j = 0; j < candidates; ++j)
      if (state.may_enter(j) && j != left) best = std::max(best, log_det(M - square(left) + square(j)) - before);
    return best;
  }

  BlockArray blocks;
  Eigen::MatrixXd prior;
  CandidateView view;
  std::vector<int> start;
};

TEST_P(LongRows, TheChosenSwapIsThatOfTryingAllHoweverManyCameBefore) {
  const DeterminantCriterion criterion("o1", 0, columns);
  const auto state = criterion.start(view, start);
  int taken = 0;
  for (int pass = 0; pass < 3; ++pass)
    for (int position = 0; position < poses; ++position) {
      const Swap swap = state->best_swap(position, 1e-10);
      if ((position + pass) % 11 == 0) {
        ASSERT_NEAR(swap.enter < 0 ? 0.0 : swap.gain, best_gain(*state, position), 1e-9)
            << "pass " << pass << ", position " << position << ", swaps " << taken;
      }
      if (swap.enter < 0) continue;
      const double before = state->value();
      state->apply(position, swap.enter);
      ASSERT_NEAR(state->value() - before, swap.gain, 1e-10);
      ++taken;
    }
  EXPECT_GT(taken, 60);
  EXPECT_NEAR(state->value(), log_det(information(state->members())), 1e-9);
}

TEST_P(LongRows, KicksAdditionsAndRemovalsAreFollowed) {
  const DeterminantCriterion criterion("o1", 0, columns);
  const auto state = criterion.start(view, start);
  Random random(1, 0);
  for (int round = 0; round < 6; ++round) {
    kick(*state, candidates, random);
    ASSERT_NEAR(state->best_swap(3 * round, 0.0).gain, best_gain(*state, 3 * round), 1e-9);
    state->remove(round);
    const Swap more = state->best_addition();
    state->add(more.enter);
    ASSERT_NEAR(state->best_swap(5 * round, 0.0).gain, best_gain(*state, 5 * round), 1e-9);
    state->ban(state->best_swap(7, 0.0).enter, true);
    ASSERT_NEAR(state->best_swap(7, 0.0).gain, best_gain(*state, 7), 1e-9);
  }
}

INSTANTIATE_TEST_SUITE_P(Repeats, LongRows, testing::Values(1, 2));

}  // namespace
}  // namespace posewright
