#include "posewright/criterion/share_state.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "posewright/support/random.hpp"

namespace posewright {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Random candidates, every third one a copy of the one before with its sign turned: the same information, a tie.
BlockArray candidates_with_ties(int count, int rows, int columns, std::uint64_t seed) {
  BlockArray blocks(std::size_t(count), rows, columns);
  Random random(seed, 0);
  for (int i = 0; i < count; ++i)
    for (int row = 0; row < rows; ++row)
      for (int j = 0; j < columns; ++j)
        blocks.block(std::size_t(i))(row, j) = i % 3 == 2 ? -blocks.block(std::size_t(i - 1))(row, j) : random.normal();
  return blocks;
}

double log_det(const Eigen::MatrixXd& M) {
  const double det = M.determinant();
  return det > 1e-12 ? std::log(det) : -infinity;
}

/// A share of all candidates with the design of `members`, as one process holds it.
struct Share {
  Share(const BlockArray& all, int first, int count, const std::vector<int>& members, int threads)
      : from(first), blocks(std::size_t(count) + members.size() + 2, all.rows(), all.columns()) {
    for (int i = 0; i < count; ++i) blocks.block(std::size_t(i)) = all.block(std::size_t(first + i));
    state = std::make_unique<ShareState>(blocks, std::size_t(count), int(members.size()) + 1, threads);
    for (const int member : members) {
      state->add(all.row(std::size_t(member), 0));
      if (member >= first && member < first + count) state->block(member - first, true);
    }
    state->refresh();
  }
  Swap in_all(Swap swap) const {
    if (swap.enter >= 0) swap.enter += from;
    return swap;
  }

  int from;
  BlockArray blocks;
  std::unique_ptr<ShareState> state;
};

Swap better(const Swap& a, const Swap& b) { return a.enter < 0 || (b.enter >= 0 && b.gain > a.gain) ? b : a; }

class ShareStates : public testing::TestWithParam<int> {};

TEST_P(ShareStates, FindTheExchangeThatTryingAllFinds) {
  const int rows = GetParam(), columns = 5, count = 60;
  const BlockArray all = candidates_with_ties(count, rows, columns, 3);
  const std::vector<int> members = {4, 17, 23, 31, 40, 41, 58};
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(columns, columns);
  for (const int i : members) M += all.block(std::size_t(i)).transpose() * all.block(std::size_t(i));
  Share share(all, 0, count, members, 1);
  EXPECT_NEAR(share.state->value(), log_det(M), 1e-9);
  int exchanges = 0;
  for (int position = 0; position < int(members.size()); ++position) {
    const auto leaving = all.block(std::size_t(members[std::size_t(position)]));
    Swap expected{-1, 0.0};
    for (int j = 0; j < count; ++j) {
      if (std::find(members.begin(), members.end(), j) != members.end()) continue;
      const auto entering = all.block(std::size_t(j));
      const double gain = log_det(M - leaving.transpose() * leaving + entering.transpose() * entering) - log_det(M);
      if (gain > expected.gain + 1e-10) expected = {j, gain};
    }
    const Swap found = share.state->best_swap(position, 1e-9);
    EXPECT_EQ(found.enter, expected.enter) << position;
    if (expected.enter < 0) continue;
    ++exchanges;
    EXPECT_NEAR(found.gain, expected.gain, 1e-9);
  }
  EXPECT_GT(exchanges, 2);
}

TEST_P(ShareStates, FindTheSameToTheLastBitHoweverCandidatesAreShared) {
  const int rows = GetParam(), count = 60;
  const BlockArray all = candidates_with_ties(count, rows, 5, 8);
  const std::vector<int> members = {1, 9, 22, 33, 34, 47, 55};
  for (const int shares : {2, 3, 5, 60}) {
    Share whole(all, 0, count, members, 1), threads(all, 0, count, members, 3);
    std::vector<std::unique_ptr<Share>> parts;
    for (int k = 0; k < shares; ++k) {
      const int first = count * k / shares;
      parts.push_back(std::make_unique<Share>(all, first, count * (k + 1) / shares - first, members, 1));
    }
    // Exchanges are made, so that running numbers have a history, and one is added at the end.
    for (int step = 0; step < 90; ++step) {
      const int position = step % int(members.size());
      const auto look = [&](ShareState& state) {
        return step < 80 ? state.best_swap(position, -infinity) : state.best_addition();
      };
      const Swap expected = look(*whole.state);
      ASSERT_GE(expected.enter, 0);
      Swap found;
      for (const auto& part : parts) found = better(found, part->in_all(look(*part->state)));
      ASSERT_EQ(found.enter, expected.enter) << shares << " shares, step " << step;
      ASSERT_EQ(found.gain, expected.gain);
      ASSERT_EQ(look(*threads.state).gain, expected.gain);
      if (step >= 80) continue;
      whole.state->replace(position, all.row(std::size_t(expected.enter), 0));
      threads.state->replace(position, all.row(std::size_t(expected.enter), 0));
      for (const auto& part : parts) part->state->replace(position, all.row(std::size_t(expected.enter), 0));
      ASSERT_EQ(whole.state->value(), parts.back()->state->value());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(RowsOfABlock, ShareStates, testing::Values(1, 3));

TEST(ShareState, AddsTheBlockThatTryingAllFindsFromNothingOn) {
  const int columns = 4, count = 30;
  const BlockArray all = candidates_with_ties(count, 2, columns, 5);
  BlockArray blocks(std::size_t(count + 7), 2, columns);
  for (int i = 0; i < count; ++i) blocks.block(std::size_t(i)) = all.block(std::size_t(i));
  ShareState state(blocks, std::size_t(count), 6, 1);
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(columns, columns);
  std::vector<bool> used(std::size_t(count), false);
  for (int n = 0; n < 6; ++n) {
    const Swap found = state.best_addition();
    ASSERT_GE(found.enter, 0);
    if (n >= 2) {
      double best = -infinity;
      for (int j = 0; j < count; ++j)
        if (!used[std::size_t(j)])
          best = std::max(best, log_det(M + all.block(std::size_t(j)).transpose() * all.block(std::size_t(j))));
      EXPECT_NEAR(log_det(M) + found.gain, best, 1e-9) << n;
    }
    used[std::size_t(found.enter)] = true;
    state.block(found.enter, true);
    state.add(all.row(std::size_t(found.enter), 0));
    M += all.block(std::size_t(found.enter)).transpose() * all.block(std::size_t(found.enter));
  }
  EXPECT_NEAR(state.value(), log_det(M), 1e-9);
}

}  // namespace
}  // namespace posewright
