// The bound of plans within limits, against all plans of small problems and against the bound without limits.

#include "posewright/planning/limited_bound.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "planners/planner_registry.hpp"
#include "posewright/criterion/registry.hpp"
#include "tests/kit/random_blocks.hpp"

namespace posewright {
namespace {

constexpr int limited_columns = 4;

std::unique_ptr<Criterion> criterion_named(const std::string& name) {
  return make_criterion(name, {Eigen::MatrixXd::Identity(limited_columns, limited_columns),
                               Eigen::VectorXd::LinSpaced(limited_columns, 0.5, 2.0), 1});
}

/// Candidates of which every third one has the value 0, and longer rows.
struct LimitedSet {
  BlockArray blocks;
  Spacing spacing;

  LimitedSet(std::size_t count, std::vector<int> most, std::uint64_t seed)
      : blocks(random_blocks(count, 2, limited_columns, seed)) {
    spacing.most = std::move(most);
    spacing.points.resize(Eigen::Index(count), 1);
    for (std::size_t i = 0; i < count; ++i) {
      spacing.points(Eigen::Index(i), 0) = i % 3 == 0 ? 0 : 1;
      if (i % 3 == 0) blocks.block(i) *= 3;
    }
  }
};

class LimitedBound : public testing::TestWithParam<const char*> {};

TEST_P(LimitedBound, NoPlanWithinTheLimitsIsBetter) {
  const auto criterion = criterion_named(GetParam());
  const int poses = 5;
  for (const int repeats : {1, poses})
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
      const LimitedSet set(12, {1, poses}, 60 + seed);
      ApproximateDesignOptions options;
      options.cap = double(repeats) / poses;
      const ApproximateDesign free = solve_approximate_design(set.blocks, criterion->function(), options, Monitor{});
      const double bound =
          limited_bound({set.blocks, set.spacing, poses, repeats}, criterion->function(), free, 1, Monitor{});
      double best = -std::numeric_limits<double>::infinity();
      std::vector<int> members(poses);
      const auto next = [&](auto&& self, int position, int first) -> void {
        if (position == poses) {
          const CandidateView view{&set.blocks, 1, repeats};
          if (set.spacing.allows(members)) best = std::max(best, criterion->start(view, members)->value());
          return;
        }
        for (int i = first; i < 12; ++i) {
          members[std::size_t(position)] = i;
          self(self, position + 1, repeats > 1 ? i : i + 1);
        }
      };
      next(next, 0, 0);
      EXPECT_GE(bound, best - 1e-9) << seed;
      EXPECT_LT(bound, free.bound_for(poses)) << seed;
    }
}

TEST_P(LimitedBound, IsNearTheBestPlanOfManyPoses) {
  const auto criterion = criterion_named(GetParam());
  const int poses = 40;
  const LimitedSet set(300, {6, poses}, 9);
  const ApproximateDesign free = solve_approximate_design(set.blocks, criterion->function(), {}, Monitor{});
  const double bound =
      limited_bound({set.blocks, set.spacing, poses, poses}, criterion->function(), free, 1, Monitor{});
  const DesignTask task{{&set.blocks, 1, poses, nullptr, &set.spacing}, criterion.get(), poses, &free};
  const Design plan = find_planner("exchange")->plan(task, {}, Monitor{});
  EXPECT_TRUE(set.spacing.allows(plan.members));
  const double degree = criterion->function().degree();
  EXPECT_GT(std::exp((plan.value - bound) / degree), 0.98);
  EXPECT_LE(plan.value, bound);
  EXPECT_LT(std::exp((plan.value - free.bound_for(poses)) / degree), 0.9) << "the limit is felt";
}

INSTANTIATE_TEST_SUITE_P(Criteria, LimitedBound, testing::Values("o1", "a"));

}  // namespace
}  // namespace posewright
