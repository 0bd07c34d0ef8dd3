// A local optimum by its definition: no exchange of one member gains, whatever a search passed over on the way.

#include "planners/local_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "posewright/criterion/information_function.hpp"
#include "posewright/criterion/registry.hpp"
#include "posewright/criterion/summed_information.hpp"
#include "tests/kit/random_blocks.hpp"

namespace posewright {
namespace {

/// Largest gain of a swap of one member that the limit of repeats allows, each by a determinant of its own.
double largest_gain(const BlockArray& blocks, const InformationFunction& function, const std::vector<int>& members,
                    int repeats) {
  const double value = function.value(summed_information(blocks, nullptr, members));
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t position = 0; position < members.size(); ++position)
    for (int j = 0; j < int(blocks.count()); ++j) {
      std::vector<int> swapped = members;
      swapped[position] = j;
      if (std::count(swapped.begin(), swapped.end(), j) > repeats) continue;
      most = std::max(most, function.value(summed_information(blocks, nullptr, swapped)) - value);
    }
  return most;
}

void expect_settled(int rows, int columns, int nuisance, int poses, int repeats) {
  const BlockArray blocks = random_blocks(60, rows, columns, std::uint64_t(rows * 100 + nuisance));
  const auto criterion =
      make_criterion("o1", {Eigen::MatrixXd::Identity(columns, columns), Eigen::VectorXd::Ones(columns), nuisance});
  for (std::uint64_t start = 0; start < 12; ++start) {
    Random random(start, 0);
    std::vector<int> members;
    for (int i = 0; i < poses; ++i) members.push_back((i * 7 + random.index(7)) % 60);
    const auto state = criterion->start({&blocks, nuisance, repeats}, members);
    EXPECT_GT(settle(*state, Monitor{}), 0);
    EXPECT_LT(largest_gain(blocks, criterion->function(), state->members(), repeats), 1e-8)
        << rows << " rows, " << nuisance << " of nuisance, repeats " << repeats << ", start " << start;
    EXPECT_NEAR(state->value(), criterion->function().value(summed_information(blocks, nullptr, state->members())),
                1e-9);
  }
}

TEST(LocalSearch, NoExchangeOfASettledDesignGains) {
  expect_settled(1, 5, 0, 8, 1);
  expect_settled(1, 5, 2, 8, 8);
  expect_settled(3, 9, 0, 6, 1);
  expect_settled(3, 9, 3, 6, 1);
  expect_settled(3, 9, 3, 6, 6);
}

/// Every candidate is there twice, so the best partner of a member is, too.
TEST(LocalSearch, OfEqualPartnersTheFirstOneEnters) {
  std::vector<int> twice;
  for (int i = 0; i < 60; ++i) twice.push_back(i % 30);
  const BlockArray blocks = random_blocks(30, 3, 9, 21).subset(twice);
  int swaps = 0;
  for (const int nuisance : {0, 3}) {
    const auto criterion = make_criterion("o1", {Eigen::MatrixXd::Identity(9, 9), Eigen::VectorXd::Ones(9), nuisance});
    const std::vector<int> members = {3, 14, 22, 27, 8, 11};
    const auto state = criterion->start({&blocks, nuisance, 1}, members);
    for (int position = 0; position < 6; ++position) {
      std::vector<double> values(60, -std::numeric_limits<double>::infinity());
      for (int j = 0; j < 60; ++j) {
        std::vector<int> swapped = members;
        swapped[std::size_t(position)] = j;
        if (std::count(members.begin(), members.end(), j) == 0)
          values[std::size_t(j)] = criterion->function().value(summed_information(blocks, nullptr, swapped));
      }
      const double most = *std::max_element(values.begin(), values.end());
      const auto first = std::find_if(values.begin(), values.end(), [&](double v) { return v > most - 1e-9; });
      const Swap swap = state->best_swap(position, smallest_gain);
      if (swap.enter < 0) continue;
      ++swaps;
      EXPECT_EQ(swap.enter, first - values.begin()) << nuisance << " " << position;
    }
  }
  EXPECT_GT(swaps, 6);
}

}  // namespace
}  // namespace posewright
