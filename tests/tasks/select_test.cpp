// Blocks that are in a plan before the search, against all plans that have them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "posewright/blocks/read_blocks.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/random.hpp"
#include "posewright/tasks/select_blocks.hpp"
#include "tests/kit/message_of.hpp"

namespace posewright {
namespace {

using testing::HasSubstr;

constexpr int count = 12, rows = 2, columns = 4;

BlockFile random_blocks() {
  BlockFile file{BlockArray(count, rows, columns), {"a", "b", "c", "d"}, {}};
  Random random(3, 1);
  for (std::size_t i = 0; i < std::size_t(count); ++i)
    for (int r = 0; r < rows; ++r)
      for (int c = 0; c < columns; ++c) file.blocks.block(i)(r, c) = random.normal();
  return file;
}

double log_det_of(const BlockFile& file, const std::vector<int>& members) {
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(columns, columns);
  for (const int i : members) M += file.blocks.block(std::size_t(i)).transpose() * file.blocks.block(std::size_t(i));
  return std::log(M.determinant());
}

/// The best `more` blocks beside those given, by looking at all of them.
double best_of_all(const BlockFile& file, const std::vector<int>& given, int more) {
  double best = -1e300;
  for (unsigned set = 0; set < (1U << count); ++set) {
    if (std::popcount(set) != more) continue;
    std::vector<int> members = given;
    for (int i = 0; i < count; ++i)
      if ((set >> i & 1U) != 0) members.push_back(i);
    std::sort(members.begin(), members.end());
    if (std::adjacent_find(members.begin(), members.end()) != members.end()) continue;
    best = std::max(best, log_det_of(file, members));
  }
  return best;
}

std::vector<int> candidates_of(const Plan& plan) {
  std::vector<int> result;
  for (const PlannedPose& pose : plan.poses) result.push_back(*pose.candidate);
  return result;
}

TEST(Select, FixedBlocksAreAmongTheBestPlanThatHasThem) {
  const BlockFile file = random_blocks();
  for (const char* method : {"exchange", "branch_and_bound"}) {
    SelectOptions options;
    options.poses = 6;
    options.method = method;
    options.fixed = {7, 2};
    const Plan plan = select_blocks(random_blocks(), options, Monitor{});
    const std::vector<int> members = candidates_of(plan);
    ASSERT_EQ(members.size(), 6U);
    EXPECT_EQ(members[0], 7);
    EXPECT_EQ(members[1], 2);
    const double best = best_of_all(file, options.fixed, 4);
    EXPECT_NEAR(plan.log_det, log_det_of(file, members), 1e-9);
    EXPECT_NEAR(plan.log_det, best, 1e-9) << method;
    EXPECT_GE(plan.certificate.bound, best - 1e-9);
    // What is left without each, by its definition.
    for (std::size_t i = 0; i < members.size(); ++i) {
      std::vector<int> rest = members;
      rest.erase(rest.begin() + std::ptrdiff_t(i));
      EXPECT_NEAR(plan.poses[i].without, std::exp((log_det_of(file, rest) - plan.log_det) / columns), 1e-9);
    }
  }
}

TEST(Select, AGapIsForAProofAndNoPlanIsBetterByMore) {
  const BlockFile file = random_blocks();
  SelectOptions options;
  options.poses = 6;
  options.gap = 0.05;
  EXPECT_THROW(select_blocks(random_blocks(), options, Monitor{}), InputError);
  options.method = "branch_and_bound";
  const Plan plan = select_blocks(random_blocks(), options, Monitor{});
  const double best = best_of_all(file, {}, 6), allowed = columns * std::log(1.05);
  EXPECT_FALSE(plan.interrupted);
  EXPECT_GE(plan.log_det, best - allowed);
  EXPECT_GE(plan.certificate.bound, best - 1e-9);
  EXPECT_LE(plan.certificate.bound, plan.log_det + allowed + 1e-9);
}

TEST(Select, ToMeasuredBlocksSoManyMoreCome) {
  const BlockFile file = random_blocks();
  SelectOptions options;
  options.poses = 3;
  options.measured = {0, 5, 9};
  const Plan plan = select_blocks(random_blocks(), options, Monitor{});
  ASSERT_EQ(plan.poses.size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(plan.poses[i].measured, i < 3);
  EXPECT_NEAR(plan.log_det, best_of_all(file, options.measured, 3), 1e-9);
  // Where repeats are allowed, what is measured may be measured again.
  options.repeats.most = Repeats::any_number;
  EXPECT_GE(select_blocks(random_blocks(), options, Monitor{}).log_det, plan.log_det - 1e-12);
}

TEST(Select, ATimeLimitIsUsedUnlessStartsAreStated) {
  for (const bool stated : {false, true}) {
    SelectOptions options;
    options.poses = 4;
    if (stated) options.restarts = 3;
    Monitor monitor;
    monitor.deadline = Monitor::Clock::now() + std::chrono::milliseconds(200);
    const Plan plan = select_blocks(random_blocks(), options, monitor);
    if (stated) EXPECT_EQ(plan.statistics.restarts, 3);
    else EXPECT_GT(plan.statistics.restarts, 10);
    EXPECT_FALSE(plan.interrupted);
  }
}

TEST(Select, GivenBlocksThatMakeNoSenseAreRefused) {
  const auto refusal = [](const std::vector<int>& fixed, const std::vector<int>& measured) -> std::string {
    SelectOptions options;
    options.poses = 4;
    options.fixed = fixed;
    options.measured = measured;
    return message_of<InputError>([&] { select_blocks(random_blocks(), options, Monitor{}); });
  };
  EXPECT_EQ(refusal({1}, {2}), "");
  EXPECT_THAT(refusal({12}, {}), HasSubstr("there is no block 12; 0 to 11"));
  EXPECT_THAT(refusal({}, {-1}), HasSubstr("there is no block -1"));
  EXPECT_THAT(refusal({3, 3}, {}), HasSubstr("block 3 is fixed or measured twice"));
  EXPECT_THAT(refusal({3}, {3}), HasSubstr("twice"));
  EXPECT_THAT(refusal({1, 2, 3, 4}, {}), HasSubstr("4 of 4 poses are fixed"));
}

}  // namespace
}  // namespace posewright
