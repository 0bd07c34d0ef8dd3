#include "posewright/workspace/workspace.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>

#include <set>

#include "posewright/support/error.hpp"
#include "posewright/workspace/candidates.hpp"

namespace posewright {
namespace {

using testing::HasSubstr;

/// Three coordinates in [−1, 1]; two actuators, x + y within ±travel and z within ±2; unreachable where x > reach.
class Stage : public IdentificationModel {
 public:
  explicit Stage(double travel, double reach = 2.0, bool periodic_x = false) : reach_(reach) {
    for (const char* name : {"x", "y", "z"}) coordinates_.push_back({name, "m", -1.0, 1.0, false});
    coordinates_[0].periodic = periodic_x;
    actuators_ = {{"sum", "m", -travel, travel}, {"z", "m", -2, 2}};
    parameters_ = {{"p", "m", 0, 1, Role::interest}};
    rows_ = 1;
  }

 private:
  bool do_linearise(const Point& at, std::span<const int>, Linearisation& out) const override {
    out.G = Eigen::MatrixXd::Constant(1, 1, at.q[0]);
    out.covariance = Eigen::MatrixXd::Constant(1, 1, 4.0);
    return true;
  }
  bool do_read(const Point&, Eigen::VectorXd&) const override { return false; }
  bool do_actuator_values(const Point& at, std::span<double> values) const override {
    values[0] = at.q[0] + at.q[1];
    values[1] = at.q[2];
    return at.q[0] <= reach_;
  }
  Eigen::Isometry3d do_tool_pose(const Point&) const override { return Eigen::Isometry3d::Identity(); }
  double reach_;
};

Problem problem_with(std::vector<CoordinateLimits> limits = {}, double margin = 0) {
  Problem problem;
  problem.file = "p.yaml";
  problem.workspace.limits = std::move(limits);
  problem.workspace.joint_margin_length = margin;
  return problem;
}

TEST(Workspace, LimitsNarrowAndMarginsShrink) {
  const Stage stage(10);
  const Workspace workspace(stage, problem_with({{{"x", 4}, -0.5, 0.25}}, 0.05));
  EXPECT_DOUBLE_EQ(workspace.proposed()[0].lower, -0.45);
  EXPECT_DOUBLE_EQ(workspace.proposed()[0].upper, 0.2);
  // Given configurations are taken up to the limits.
  EXPECT_DOUBLE_EQ(workspace.coordinates()[0].lower, -0.5);
  EXPECT_DOUBLE_EQ(workspace.coordinates()[0].upper, 0.25);
  EXPECT_EQ(workspace.violation(std::vector<double>{0.22, 0, 0}), -1);
  EXPECT_EQ(workspace.within_margin(std::vector<double>{0.22, 0, 0}), "x");
  EXPECT_EQ(workspace.within_margin(std::vector<double>{0.2, 0, 0}), "");
  EXPECT_EQ(workspace.violation(std::vector<double>{0.3, 0, 0}), 0);
  EXPECT_EQ(workspace.violation(std::vector<double>{0.1, 0, 0}), -1);
  EXPECT_EQ(workspace.violation(std::vector<double>{std::nan(""), 0, 0}), 0);
}

TEST(Workspace, ContradictoryLimitsNameLineAndRange) {
  const Stage stage(10);
  const auto text = [&](const Problem& problem) -> std::string {
    try {
      const Workspace workspace(stage, problem);
      return "accepted";
    } catch (const InputError& error) {
      return error.what();
    }
  };
  EXPECT_THAT(text(problem_with({{{"w", 4}, 0, 1}})),
              HasSubstr("p.yaml:4: 'w' is not a coordinate of this robot; allowed: x, y, z"));
  EXPECT_THAT(text(problem_with({{{"x", 5}, 0, 3}})),
              HasSubstr("p.yaml:5: limits of 'x' go beyond the robot's own; allowed: -1000 to 1000 mm"));
  EXPECT_THAT(text(problem_with({}, 1.5)), HasSubstr("no range is left for 'x'"));
}

TEST(Workspace, OmplSeesTheSameFeasibleSet) {
  const Stage stage(0.5);
  const Workspace workspace(stage, problem_with());
  const auto& space = workspace.space_information();
  ompl::base::ScopedState<ompl::base::RealVectorStateSpace> state(space->getStateSpace());
  for (const std::vector<double>& q : {std::vector<double>{0.2, 0.2, 0.9}, {0.4, 0.2, 0}, {1.2, -1, 0}}) {
    for (unsigned i = 0; i < 3; ++i) state[i] = q[i];
    EXPECT_EQ(space->isValid(state.get()), workspace.violation(q) < 0);
  }
}

TEST(SampleConfigurations, CountsOfReasonsAddUpToTheDraws) {
  const Stage stage(0.5, 0.4);
  const Workspace workspace(stage, problem_with());
  SamplingOptions options;
  options.count = 3000;
  const Configurations sample = sample_configurations(workspace, options, Monitor{});
  EXPECT_EQ(sample.count(), 3000U);
  long rejected = 0;
  std::set<std::string> reasons;
  for (const auto& [reason, count] : sample.rejected) {
    rejected += count;
    reasons.insert(reason);
  }
  EXPECT_EQ(sample.drawn, long(sample.count()) + rejected);
  EXPECT_EQ(reasons, (std::set<std::string>{"actuator travel", "out of reach"}));
  for (std::size_t i = 0; i < sample.count(); ++i) EXPECT_EQ(workspace.violation(sample[i]), -1);
}

TEST(SampleConfigurations, HalfLieOnTheBoundaryAndCornersAreAmongThem) {
  const Stage stage(10);
  const Workspace workspace(stage, problem_with());
  SamplingOptions options;
  options.count = 2000;
  const Configurations sample = sample_configurations(workspace, options, Monitor{});
  int on_boundary = 0;
  std::set<std::vector<double>> corners;
  for (std::size_t i = 0; i < sample.count(); ++i) {
    on_boundary += workspace.on_boundary(sample[i]) ? 1 : 0;
    if (workspace.share_of_coordinates_on_limits(sample[i]) == 1) corners.insert({sample[i].begin(), sample[i].end()});
  }
  EXPECT_GE(on_boundary, 1000);
  EXPECT_EQ(corners.size(), 8U);
}

TEST(SampleConfigurations, NoConfigurationComesTwice) {
  const Stage stage(10);
  const Workspace workspace(stage, problem_with());
  SamplingOptions options;
  options.count = 5000;
  const Configurations sample = sample_configurations(workspace, options, Monitor{});
  std::set<std::vector<double>> distinct;
  for (std::size_t i = 0; i < sample.count(); ++i) distinct.insert({sample[i].begin(), sample[i].end()});
  EXPECT_EQ(distinct.size(), sample.count());
}

TEST(SampleConfigurations, PeriodicCoordinatesHaveNoEnds) {
  const Stage stage(10, 2.0, true);
  const Workspace workspace(stage, problem_with());
  SamplingOptions options;
  options.count = 2000;
  const Configurations sample = sample_configurations(workspace, options, Monitor{});
  for (std::size_t i = 0; i < sample.count(); ++i) EXPECT_LT(std::abs(sample[i][0]), 1);
  EXPECT_FALSE(workspace.on_boundary(std::vector<double>{1, 0, 0}));
}

TEST(SampleConfigurations, WhereAConstraintCutsTheBoxItsEdgeIsSampled) {
  const Stage stage(0.3);
  const Workspace workspace(stage, problem_with());
  SamplingOptions options;
  options.count = 1000;
  const Configurations sample = sample_configurations(workspace, options, Monitor{});
  int on_edge = 0;
  for (std::size_t i = 0; i < sample.count(); ++i)
    on_edge += std::abs(std::abs(sample[i][0] + sample[i][1]) - 0.3) < 1e-6 ? 1 : 0;
  EXPECT_GT(on_edge, 300);
}

TEST(SampleConfigurations, SameSeedSamePointsOnAnyNumberOfThreads) {
  const Stage stage(0.5);
  const Workspace workspace(stage, problem_with());
  SamplingOptions options;
  options.count = 1000;
  options.threads = 1;
  const Configurations one = sample_configurations(workspace, options, Monitor{});
  options.threads = 3;
  EXPECT_EQ(sample_configurations(workspace, options, Monitor{}).values, one.values);
  options.seed = 1;
  EXPECT_NE(sample_configurations(workspace, options, Monitor{}).values, one.values);
}

TEST(SampleConfigurations, EmptyWorkspaceNamesTheConstraintThatRejectsMost) {
  const Stage stage(-1);
  const Workspace workspace(stage, problem_with());
  SamplingOptions options;
  options.count = 10;
  try {
    sample_configurations(workspace, options, Monitor{});
    FAIL() << "accepted";
  } catch (const CannotDo& error) {
    EXPECT_THAT(error.what(), HasSubstr("'actuator travel' rejects 100 %"));
  }
}

TEST(SampleConfigurations, InteriorPointsFillTheBoxEvenly) {
  const Stage stage(10);
  const Workspace workspace(stage, problem_with());
  SamplingOptions options;
  options.count = 2048;
  const Configurations sample = sample_configurations(workspace, options, Monitor{});
  // 1024 Sobol points: 16 × 64 in every projection to 16 bins.
  for (int k = 0; k < 3; ++k) {
    std::vector<int> bins(16, 0);
    for (std::size_t i = 0; i < 1024; ++i) ++bins[std::size_t((sample[i][std::size_t(k)] + 1) * 8)];
    for (const int count : bins) EXPECT_NEAR(count, 64, 3);
  }
}

TEST(BuildBlocks, WhitensWithTheCovarianceOfTheResidual) {
  const Stage stage(10);
  Configurations sample;
  sample.dimension = 3;
  sample.values = {0.5, 0, 0, -1, 0, 0};
  const std::vector<int> selected = {0};
  const BlockArray blocks = build_blocks(stage, selected, sample, 1);
  EXPECT_DOUBLE_EQ(blocks.block(0)(0, 0), 0.25);
  EXPECT_DOUBLE_EQ(blocks.block(1)(0, 0), -0.5);
}

}  // namespace
}  // namespace posewright
