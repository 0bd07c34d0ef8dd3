// Designs of other numbers of poses.

#include "posewright/search/other_sizes.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <set>

#include "tests/kit/random_blocks.hpp"

namespace posewright {
namespace {

constexpr int rows = 2, columns = 4;

std::vector<SearchPart> parts_of(const BlockArray& blocks, int nuisance) {
  std::vector<int> all(blocks.count());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = int(i);
  std::vector<SearchPart> parts;
  parts.push_back({blocks.subset(all), nuisance, 1.0, Eigen::VectorXd::Ones(blocks.columns())});
  return parts;
}

/// log det of the columns of interest, by its definition.
double log_det(const BlockArray& blocks, const std::vector<int>& members, int nuisance) {
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(columns, columns);
  for (const int i : members) M += blocks.block(std::size_t(i)).transpose() * blocks.block(std::size_t(i));
  return std::log(M.determinant()) - (nuisance > 0 ? std::log(M.topLeftCorner(nuisance, nuisance).determinant()) : 0);
}

SearchRequest request_of(int poses) {
  SearchRequest request;
  request.criterion = "o1";
  request.method = "exchange";
  request.poses = poses;
  request.planner.threads = 1;
  return request;
}

TEST(OtherSizes, NoSwapOfOnePoseIsBetter) {
  for (const int nuisance : {0, 1}) {
    const BlockArray blocks = random_blocks(30, rows, columns, std::uint64_t(40 + nuisance));
    const std::vector<int> own = {1, 4, 7, 11, 19, 25}, sizes = {9, 3, 12, 4};
    const auto found = designs_of_sizes(parts_of(blocks, nuisance), request_of(6), own, sizes, Monitor{});
    ASSERT_EQ(found.size(), sizes.size());
    for (std::size_t s = 0; s < sizes.size(); ++s) {
      ASSERT_EQ(found[s].size(), std::size_t(sizes[s]));
      EXPECT_EQ(std::set<int>(found[s].begin(), found[s].end()).size(), found[s].size()) << "none twice";
      const double value = log_det(blocks, found[s], nuisance);
      for (std::size_t k = 0; k < found[s].size(); ++k)
        for (int j = 0; j < 30; ++j) {
          if (std::find(found[s].begin(), found[s].end(), j) != found[s].end()) continue;
          std::vector<int> swapped = found[s];
          swapped[k] = j;
          EXPECT_LE(log_det(blocks, swapped, nuisance), value + 1e-8) << sizes[s] << " poses: " << j;
        }
    }
  }
}

TEST(OtherSizes, CandidatesOfLittleGainAreLeftOutAndNothingIsLost) {
  // Three hundred remain: among short blocks the long ones must be found wherever they are.
  BlockArray blocks = random_blocks(700, rows, columns, 8);
  for (std::size_t i = 0; i < 700; ++i)
    if (i % 37 != 5) blocks.block(i) *= 0.05;
  const auto found = designs_of_sizes(parts_of(blocks, 0), request_of(4), {0, 1, 2, 3}, {8}, Monitor{});
  ASSERT_EQ(found[0].size(), 8U);
  for (const int i : found[0]) EXPECT_EQ(i % 37, 5) << i;
}

TEST(OtherSizes, KeepsTheDistanceAndTellsWhereSoManyDoNotFit) {
  const BlockArray blocks = random_blocks(20, rows, columns, 9);
  Spacing spacing;
  spacing.unit = Eigen::VectorXd::Constant(1, 1.5);
  spacing.period = Eigen::VectorXd::Zero(1);
  spacing.points.resize(20, 1);
  for (int i = 0; i < 20; ++i) spacing.points(i, 0) = i;
  SearchRequest request = request_of(5);
  request.spacing = &spacing;
  const auto found = designs_of_sizes(parts_of(blocks, 0), request, {0, 4, 8, 12, 16}, {8, 12, 3}, Monitor{});
  for (const std::size_t s : {0, 2})
    for (std::size_t k = 1; k < found[s].size(); ++k) EXPECT_GE(found[s][k] - found[s][k - 1], 2);
  EXPECT_EQ(found[0].size(), 8U);
  EXPECT_TRUE(found[1].empty()) << "ten of twenty are no neighbours";
  EXPECT_EQ(found[2].size(), 3U);
}

TEST(OtherSizes, TooFewForTheParametersAreNone) {
  const BlockArray blocks = random_blocks(20, 1, columns, 10);
  const auto found = designs_of_sizes(parts_of(blocks, 0), request_of(5), {0, 1, 2, 3, 4}, {3, 4}, Monitor{});
  EXPECT_TRUE(found[0].empty()) << "three readings for four parameters";
  EXPECT_EQ(found[1].size(), 4U);
}

}  // namespace
}  // namespace posewright
