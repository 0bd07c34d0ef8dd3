// Planners beyond the conformance kit: proofs on small problems, poses between the candidates, what is lost with a
// pose.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "planners/continuous.hpp"
#include "planners/design_tree.hpp"
#include "planners/planner_registry.hpp"
#include "posewright/criterion/determinant.hpp"
#include "posewright/criterion/registry.hpp"
#include "posewright/planning/ascent.hpp"
#include "posewright/planning/extended_bound.hpp"
#include "posewright/planning/workspace_bound.hpp"
#include "tests/kit/random_blocks.hpp"
#include "tests/kit/wave_space.hpp"
#include "tests/planners/best_in_box.hpp"

namespace posewright {
namespace {

CriterionData plain_data(int columns) {
  CriterionData data{Eigen::MatrixXd::Identity(columns, columns), Eigen::VectorXd::Ones(columns), 0};
  data.test_points.push_back({random_blocks(1, 3, columns, 9).block(0), 1.0});
  return data;
}

TEST(BranchAndBound, ProvesFiftySmallProblemsAndAutoFindsTheOptimumOfNearlyAll) {
  int found = 0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const int rows = seed % 2 == 0 ? 1 : 2, poses = 5 + int(seed % 3);
    const BlockArray blocks = random_blocks(22, rows, 4, 300 + seed);
    const auto criterion = make_criterion(seed % 5 == 4 ? "a" : "o1", plain_data(4));
    ApproximateDesignOptions options;
    options.cap = 1.0 / poses;
    const ApproximateDesign approximate = solve_approximate_design(blocks, criterion->function(), options, Monitor{});
    DesignTask task{{&blocks, 0, 1}, criterion.get(), poses, &approximate};
    const Design proved = find_planner("branch_and_bound")->plan(task, {}, Monitor{});
    EXPECT_TRUE(proved.optimal) << seed;
    EXPECT_LE(proved.value, approximate.bound_for(poses));
    const Design searched = find_planner("auto")->plan(task, {}, Monitor{});
    EXPECT_LE(searched.value, proved.value + 1e-8);
    if (searched.value > proved.value - 1e-8) ++found;
  }
  EXPECT_GE(found, 48) << "of 50";
}

TEST(BranchAndBound, NoDesignOfABoxIsBetterThanItsBoundAndTighteningLosesNoneThatIs) {
  int tightened = 0, ruled_out = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    Random random(seed, 3);
    const int columns = 3 + int(seed % 4), rows = seed % 5 == 0 ? 2 : 1, repeats = seed % 3 == 0 ? 2 : 1;
    const BlockArray blocks = random_blocks(11, rows, columns, 700 + seed);
    const auto criterion = make_criterion(seed % 7 == 6 ? "a" : "o1", plain_data(columns));
    DesignTask task{{&blocks, 0, repeats}, criterion.get(), std::max(4, columns + int(seed % 2)), nullptr};
    ChoiceBox box{std::vector<std::uint16_t>(11, 0), std::vector<std::uint16_t>(11, std::uint16_t(repeats))};
    for (int k = 0; k < int(seed % 5); ++k) {
      const auto c = std::size_t(random.index(11));
      if (random.uniform() < 0.6) box.least[c] = box.most[c] = std::uint16_t(std::max<int>(1, box.most[c]));
      else box.most[c] = box.least[c];
    }
    std::vector<int> members;
    const double best = best_in_box(task, box, 0, members);
    // What is known already lies below, above, or nowhere near.
    const double known = best + (random.uniform() < 0.7 ? -1 : 1) * 0.3 * random.uniform();
    NodeRelaxation relaxation(task);
    RelaxedBox relaxed;
    relaxed.numbers.assign(11, task.poses / 11.0);
    if (!relaxation.solve(box, relaxed, std::isfinite(best) ? known : -100.0)) {
      EXPECT_FALSE(best > known + 1e-9) << seed;
      ++ruled_out;
      continue;
    }
    EXPECT_GE(relaxed.bound, best - 1e-9) << seed;
    if (best <= known) continue;
    EXPECT_NEAR(best_in_box(task, box, 0, members), best, 1e-12) << seed;
    if (box.most != std::vector<std::uint16_t>(11, std::uint16_t(repeats))) ++tightened;
  }
  EXPECT_GT(tightened, 50);
  EXPECT_GT(ruled_out, 50);
}

TEST(BranchAndBound, FindsTheOptimumFromTheWorstDesignOnAnyNumberOfThreads) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const int columns = 4 + int(seed % 3);
    const BlockArray blocks = random_blocks(16, 1, columns, 900 + seed);
    const auto criterion = make_criterion("o1", plain_data(columns));
    DesignTask task{{&blocks, 0, 1}, criterion.get(), columns + int(seed % 2), nullptr};
    ChoiceBox whole{std::vector<std::uint16_t>(16, 0), std::vector<std::uint16_t>(16, 1)};
    std::vector<int> members;
    const double optimum = best_in_box(task, whole, 0, members);
    expect_found_from_the_worst(task, optimum, seed);
  }
}

TEST(BranchAndBound, ReplicatedDesignReachesTheReplicationBound) {
  // Quadratic on [−1, 1]: support −1, 0, 1 with weights 1/3; N = 6 with repeats attains the bound itself.
  BlockArray blocks(21, 1, 3);
  for (int i = 0; i < 21; ++i) {
    const double x = -1 + 0.1 * i;
    blocks.row(std::size_t(i), 0)[0] = 1;
    blocks.row(std::size_t(i), 0)[1] = x;
    blocks.row(std::size_t(i), 0)[2] = x * x;
  }
  const auto criterion = make_criterion("o1", plain_data(3));
  const ApproximateDesign approximate = solve_approximate_design(blocks, criterion->function(), {}, Monitor{});
  DesignTask task{{&blocks, 0, 6}, criterion.get(), 6, &approximate};
  const Design proved = find_planner("branch_and_bound")->plan(task, {}, Monitor{});
  EXPECT_EQ(proved.members, (std::vector<int>{0, 0, 10, 10, 20, 20}));
  EXPECT_NEAR(proved.value, approximate.bound_for(6), 1e-8);
}

/// A thin, bent, disconnected feasible set.
bool hostile(std::span<const double> q) {
  const double x = q[0] - 0.5, y = q[1] - 0.5, ring = std::sqrt(x * x + y * y);
  return std::abs(ring - 0.3) < 0.02 || std::sin(40 * q[0]) * std::sin(40 * q[1]) > 0.9;
}

TEST(Continuous, WhatTakesLongToCheckIsAskedOfFewAndHoldsAllTheSame) {
  const auto quick = [](std::span<const double> q) { return std::abs(q[0] - 0.5) > 0.1; };
  const auto whole = [&](std::span<const double> q) { return quick(q) && q[1] > 0.3 * q[0]; };
  int moved = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    WaveSpace space(2, 2, 6, 60, seed, whole);
    space.check_first(quick);
    const auto criterion = make_criterion("o1", plain_data(6));
    DesignTask task{{&space.blocks(), 0, 1}, criterion.get(), 7, nullptr};
    task.space = &space;
    PlannerOptions options;
    options.restarts = 1;
    const Design exchanged = find_planner("exchange")->plan(task, options, Monitor{});
    const Design design = find_planner("continuous")->plan(task, options, Monitor{});
    EXPECT_GE(design.value, exchanged.value - 1e-9);
    for (const auto& q : design.added) EXPECT_TRUE(space.inside(q)) << seed;
    moved += int(design.added.size());
    // 300 evaluations a pose and round otherwise.
    EXPECT_LT(space.asked(), 1500) << seed;
  }
  EXPECT_GT(moved, 30);
}

TEST(Continuous, NeverLeavesAHostileFeasibleSetAndNeverReturnsLess) {
  for (const bool box : {true, false})
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      const WaveSpace space(2, 2, 6, 60, seed, box ? WaveSpace::Oracle() : WaveSpace::Oracle(hostile));
      const auto criterion = make_criterion(seed % 2 == 0 ? "o1" : "a", plain_data(6));
      DesignTask task{{&space.blocks(), 0, 1}, criterion.get(), 7, nullptr};
      task.space = &space;
      Random random(seed, 3);
      std::vector<int> members;
      while (members.size() < 7)
        if (const int i = random.index(60); std::find(members.begin(), members.end(), i) == members.end())
          members.push_back(i);
      PoseSet poses = pose_set_of(task, members);
      const double before = poses.value;
      improve(task, poses, 1, Monitor{});
      EXPECT_GE(poses.value, before);
      EXPECT_GT(poses.value, before + 1e-3) << "somewhere there is something to gain";
      for (std::size_t i = 0; i < poses.configurations.size(); ++i) {
        EXPECT_TRUE(space.inside(poses.configurations[i]));
        for (std::size_t j = 0; j < i; ++j)
          if (poses.candidates[i] < 0 || poses.candidates[j] < 0) {
            EXPECT_FALSE(space.spacing().too_near(poses.configurations[i], poses.configurations[j]));
          }
      }
      EXPECT_NEAR(criterion->function().value(poses.blocks.all().transpose() * poses.blocks.all()), poses.value, 1e-9);
    }
}

TEST(Ascent, FollowsSmoothMarginsToTheBestPlaceOfADiscAndStaysInIt) {
  const auto margin = [](std::span<const double> q) {
    return 0.1 - (q[0] - 0.4) * (q[0] - 0.4) - (q[1] - 0.5) * (q[1] - 0.5);
  };
  class LargestTrace : public BlockObjective {
   public:
    double value(const BlockArray::ConstMap& J) override { return J.squaredNorm(); }
    const Eigen::MatrixXd& gradient(const BlockArray::ConstMap&) override { return one_; }

   private:
    Eigen::MatrixXd one_ = Eigen::MatrixXd::Identity(5, 5);
  };
  int on_the_rim = 0;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    WaveSpace space(2, 2, 5, 20, seed, [&](std::span<const double> q) { return margin(q) >= 0; });
    space.bound_by(margin);
    const auto probe = space.probe();
    ProbedBlock block(2, 5);
    LargestTrace f;
    double highest = 0;
    for (int i = 0; i <= 400; ++i)
      for (int j = 0; j <= 400; ++j)
        if (const std::vector<double> q{i / 400.0, j / 400.0}; space.inside(q) && block.at(*probe, q))
          highest = std::max(highest, f.value(block.map()));
    double reached = 0;
    const long before = space.blocks_asked();
    for (int i = 0; i < 20; ++i) {
      const AscentResult end =
          ascend(space, *probe, f, 2, 5, {space.candidate(i).begin(), space.candidate(i).end()}, 300);
      EXPECT_TRUE(space.inside(end.q));
      if (end.value > reached && margin(end.q) < 1e-4) ++on_the_rim;
      reached = std::max(reached, end.value);
    }
    EXPECT_GT(reached, highest - 1e-4) << seed;
    // Of 300 that each may take: few with the gradient, then half of them to look around.
    EXPECT_LT(space.blocks_asked() - before, 20 * 240) << seed;
  }
  EXPECT_GT(on_the_rim, 0);
}

TEST(Continuous, MakesAnotherChoiceWhereThatIsWorthMore) {
  int changed = 0;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    // All candidates have made the first choice; half of what the other one offers must be better.
    WaveSpace space(3, 2, 4, 1, seed);
    space.make_choice(2);
    BlockArray blocks(40, 2, 4);
    PoseSet poses;
    Random random(seed, 5);
    const auto probe = space.probe();
    poses.blocks = BlockArray(6, 2, 4);
    for (std::size_t i = 0; i < 6; ++i) {
      poses.configurations.push_back({random.uniform(), random.uniform(), 0.0});
      poses.candidates.push_back(-1);
      probe->block(poses.configurations[i], poses.blocks.row(i, 0), poses.blocks.stride());
    }
    const auto criterion = make_criterion("o1", plain_data(4));
    DesignTask task{{&blocks, 0, 1}, criterion.get(), 6, nullptr};
    task.space = &space;
    poses.value = value_of_blocks(task, poses.blocks);
    const double before = poses.value;
    improve(task, poses, 1, Monitor{});
    EXPECT_GE(poses.value, before);
    BlockArray again(6, 2, 4);
    for (std::size_t i = 0; i < 6; ++i) {
      const double choice = poses.configurations[i][2];
      EXPECT_TRUE(choice == 0.0 || choice == 1.0);
      if (choice == 1.0) ++changed;
      EXPECT_TRUE(space.inside(poses.configurations[i]));
      probe->block(poses.configurations[i], again.row(i, 0), again.stride());
    }
    EXPECT_NEAR(value_of_blocks(task, again), poses.value, 1e-9);
  }
  EXPECT_GT(changed, 6) << "of 36";
}

TEST(WorkspaceBound, IsNotExceededByADenseGridAndFindsWhatCandidatesMiss) {
  const WaveSpace space(2, 2, 6, 50, 4);
  const LogDetFunction function(0, 6);
  const ApproximateDesign design = solve_approximate_design(space.blocks(), function, {}, Monitor{});
  const WorkspaceBound bound = workspace_bound(space.blocks(), design, function, space, {}, Monitor{});
  EXPECT_LE(bound.max_ratio, 1.001);
  EXPECT_GT(bound.bound, design.bound) << "fifty candidates miss much of the square";
  EXPECT_FALSE(bound.support.empty());
  // Optimal weights on a fine grid: a lower bound of the true optimum.
  BlockArray grid(81 * 81, 2, 6);
  const auto probe = space.probe();
  for (int i = 0; i < 81; ++i)
    for (int j = 0; j < 81; ++j) {
      const std::vector<double> q{i / 80.0, j / 80.0};
      probe->block(q, grid.row(std::size_t(81 * i + j), 0), grid.stride());
    }
  const ApproximateDesign fine = solve_approximate_design(grid, function, {}, Monitor{});
  EXPECT_LE(fine.value, bound.bound + 1e-9);
  EXPECT_GT(fine.value, bound.bound - 0.02);
}

/// The bound of a space with all default options but these.
WorkspaceBound bound_of(const WaveSpace& space, const WorkspaceBoundOptions& options = {}) {
  const LogDetFunction function(0, space.blocks().columns());
  const ApproximateDesign design = solve_approximate_design(space.blocks(), function, {}, Monitor{});
  return workspace_bound(space.blocks(), design, function, space, options, Monitor{});
}

TEST(WorkspaceBound, TriesChoicesThatNoCandidateHas) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    WaveSpace space(3, 2, 6, 200, 60 + seed);
    space.make_choice(2);
    space.set_candidates(2, 0.0);
    const WorkspaceBound bound = bound_of(space);
    EXPECT_TRUE(std::any_of(bound.support.begin(), bound.support.end(), [](const auto& q) { return q[2] == 1.0; }));
    WaveSpace other(3, 2, 6, 200, 60 + seed);
    other.make_choice(2);
    other.set_candidates(2, 1.0);
    EXPECT_NEAR(bound_of(other).value, bound.value, 0.002 * 6) << "from the other choice alone the same weights";
  }
}

TEST(WorkspaceBound, IsSettledWhereNoneOfManyRandomPlacesExceedsIt) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const WaveSpace space(4, 2, 8, 1500, 80 + seed);
    const WorkspaceBound bound = bound_of(space);
    EXPECT_GT(bound.confirmed, 0);
    EXPECT_LE(bound.max_ratio, 1.005);
    BlockArray block(1, 2, 8);
    Random random(seed, 2);
    double most = 0;
    for (int i = 0; i < 20000; ++i) {
      const std::vector<double> q{random.uniform(), random.uniform(), random.uniform(), random.uniform()};
      space.probe()->block(q, block.row(0, 0), block.stride());
      most = std::max(most, (std::as_const(block).block(0) * bound.factor).squaredNorm());
    }
    EXPECT_LE(most, 1.005 * 8);
  }
}

TEST(WorkspaceBound, IsNotSettledWhereItsRoundsEndFirst) {
  WorkspaceBoundOptions one_round;
  one_round.rounds = 1;
  const WaveSpace space(4, 2, 8, 1500, 80);
  const WorkspaceBound bound = bound_of(space, one_round);
  EXPECT_EQ(bound.confirmed, 0);
  EXPECT_GT(bound.max_ratio, 1.005);
  EXPECT_LT(bound.value, bound_of(space).value);
}

TEST(ExtendedBound, EqualsThatOfCandidatesAndNewBlocksTogether) {
  for (const char* name : {"o1", "a", "test_pose"})
    for (const double cap : {1.0, 0.1}) {
      const BlockArray all = random_blocks(400, 2, 6, 21);
      std::vector<int> first, last;
      for (int i = 0; i < 400; ++i) (i < 380 ? first : last).push_back(i);
      const BlockArray candidates = all.subset(first);
      const auto criterion = make_criterion(name, plain_data(6));
      ApproximateDesignOptions options;
      options.cap = cap;
      const ApproximateDesign design = solve_approximate_design(candidates, criterion->function(), options, Monitor{});
      const ApproximateDesign extended =
          extended_bound(candidates, design, all.subset(last), criterion->function(), options, Monitor{});
      const ApproximateDesign whole = solve_approximate_design(all, criterion->function(), options, Monitor{});
      EXPECT_NEAR(extended.bound, whole.bound, 1e-6) << name << " " << cap;
      EXPECT_GE(extended.bound, whole.value - 1e-9);
    }
}

}  // namespace
}  // namespace posewright
