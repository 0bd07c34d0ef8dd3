// Least squares: known truths come back, intervals hold, outliers lose their weight.

#include "posewright/calibration/fit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "posewright/blocks/identifiability.hpp"
#include "posewright/calibration/curvature.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/support/error.hpp"
#include "tests/kit/example_problems.hpp"
#include "tests/kit/virtual_data.hpp"

namespace posewright {
namespace {

namespace fs = std::filesystem;

/// A variant of an example, ready to be fitted: columns that these poses determine.
struct Case {
  std::unique_ptr<IdentificationModel> model;
  VariantColumns columns;
  std::vector<MeasuredPose> poses;
  Random random{3, 1};

  Case(const std::string& file, const std::string& variant, int count) {
    const Problem problem = example(file);
    const VariantSpec& spec = find_variant(problem, variant);
    model = make_model({problem, spec});
    poses = random_poses(*model, count, random);
    columns = select_columns(*model, {problem, spec});
    for (MeasuredPose& pose : poses) pose.y = Eigen::VectorXd::Zero(Eigen::Index(model->readings().size()));
    IdentifiabilityOptions options;
    options.tiers = columns.tiers;
    columns = subset(columns, identifiability(blocks_of(*model, columns, poses), columns.parameters, options).kept);
  }
  void read(const std::vector<double>& truth, double noise) { read_poses_of(*model, truth, noise, random, poses); }
};

struct FitExample {
  const char *file, *variant;
  int poses;
  /// Of what the problem states: the legs' directions are told so badly that only little noise leaves the problem
  /// linear.
  double noise = 1.0;
};
void PrintTo(const FitExample& named, std::ostream* out) { *out << named.file << ' ' << named.variant; }

class EveryRobot : public testing::TestWithParam<FitExample> {};

TEST_P(EveryRobot, TheTruthComesBackFromReadingsWithoutNoise) {
  Case c(GetParam().file, GetParam().variant, GetParam().poses);
  const std::vector<double> truth = random_truth(*c.model, c.columns, 0.5, c.random);
  c.read(truth, 0.0);
  const Fit result = fit(*c.model, c.columns, c.poses, {});
  EXPECT_TRUE(result.converged);
  EXPECT_LT(result.chi_square, 1e-9);
  // As far as rounding lets the data tell: a millionth of what noise would do to it.
  for (std::size_t j = 0; j < c.columns.selected.size(); ++j)
    EXPECT_NEAR(result.change[Eigen::Index(j)], truth[std::size_t(c.columns.selected[j])],
                1e-4 * std::sqrt(result.covariance(Eigen::Index(j), Eigen::Index(j))) +
                    1e-9 * c.columns.parameters[j].tolerance)
        << c.columns.parameters[j].name;
}

TEST_P(EveryRobot, ChiSquareOverFreedomIsOneAndErrorsAreAsLargeAsPredicted) {
  Case c(GetParam().file, GetParam().variant, GetParam().poses);
  double chi_square = 0, squares = 0;
  int freedom = 0, count = 0;
  for (int draw = 0; draw < 20; ++draw) {
    const std::vector<double> truth = random_truth(*c.model, c.columns, 0.1, c.random);
    c.read(truth, GetParam().noise);
    const Fit result = fit(*c.model, c.columns, c.poses, {});
    chi_square += result.chi_square;
    freedom += result.freedom;
    Eigen::VectorXd error = result.change;
    for (std::size_t j = 0; j < c.columns.selected.size(); ++j)
      error[Eigen::Index(j)] -= truth[std::size_t(c.columns.selected[j])];
    // Σ of m squares of unit normals for the errors in the metric of their covariance.
    squares += error.dot(result.covariance.ldlt().solve(error));
    count += int(error.size());
  }
  const double variance = GetParam().noise * GetParam().noise;
  EXPECT_NEAR(chi_square / freedom / variance, 1.0, 5 * std::sqrt(2.0 / freedom));
  EXPECT_NEAR(squares / count / variance, 1.0, 5 * std::sqrt(2.0 / count));
}

INSTANTIATE_TEST_SUITE_P(
    Examples, EveryRobot,
    testing::Values(FitExample{"kr270/problem.yaml", "", 18}, FitExample{"kr270/elastostatic.yaml", "", 30},
                    FitExample{"kr270/compensator.yaml", "", 30}, FitExample{"kr270/compensator_geometry.yaml", "", 10},
                    FitExample{"telescope/problem.yaml", "rigid", 20, 0.005},
                    FitExample{"telescope/problem.yaml", "linear", 20},
                    FitExample{"telescope/problem.yaml", "matrix", 20}, FitExample{"gough/problem.yaml", "", 25},
                    FitExample{"delta/problem.yaml", "", 25}, FitExample{"five_bar/problem.yaml", "", 25},
                    FitExample{"instruments/ball_bar.yaml", "", 60}, FitExample{"instruments/cables.yaml", "", 30},
                    FitExample{"instruments/camera_on_hand.yaml", "", 20},
                    FitExample{"instruments/photogrammetry.yaml", "", 20},
                    FitExample{"instruments/tracker_two_stations.yaml", "", 25}),
    [](const auto& row) { return test_name(std::string(row.param.file) + "_" + row.param.variant); });

TEST(Fit, TargetsThatWereNotReadAreLeftOut) {
  Case c("kr270/problem.yaml", "", 18);
  const std::vector<double> truth = random_truth(*c.model, c.columns, 0.1, c.random);
  c.read(truth, 1.0);
  const Fit all = fit(*c.model, c.columns, c.poses, {});
  c.poses[2].y.segment<3>(3).setConstant(std::numeric_limits<double>::quiet_NaN());
  const Fit fewer = fit(*c.model, c.columns, c.poses, {});
  EXPECT_EQ(fewer.readings, all.readings - 3);
  EXPECT_TRUE(std::isnan(fewer.residuals[2][4]) && std::isnan(fewer.whitened[2][4]));
  // Without three readings every variance is at least what it was.
  for (Eigen::Index j = 0; j < all.change.size(); ++j)
    EXPECT_GE(fewer.covariance(j, j), all.covariance(j, j) * (1 - 1e-3));
}

TEST(Fit, GrossErrorsSpoilTheWeightedFitAndNotTheRobustOne) {
  Case c("kr270/problem.yaml", "", 24);
  const std::vector<double> truth = random_truth(*c.model, c.columns, 0.1, c.random);
  c.read(truth, 1.0);
  const Fit clean = fit(*c.model, c.columns, c.poses, {});
  for (const std::size_t k : {1, 7, 13}) c.poses[k].y[4] += 20e-3;
  const auto distance = [&](const Fit& result) {
    const Eigen::VectorXd change = result.change - clean.change;
    return std::sqrt(change.dot(clean.covariance.ldlt().solve(change)) / double(change.size()));
  };
  FitOptions robust;
  robust.weighting = Weighting::robust;
  const Fit held = fit(*c.model, c.columns, c.poses, robust);
  EXPECT_GT(distance(fit(*c.model, c.columns, c.poses, {})), 3.0);
  EXPECT_LT(distance(held), 0.7);
  EXPECT_EQ(held.weights[1][1], 0.0);
  EXPECT_GT(held.weights[1][0], 0.1);
  EXPECT_NEAR(held.scale, 1.0, 0.2);
}

TEST(Fit, OrdinaryLeastSquaresFindsTheSizeOfTheNoise) {
  Case c("kr270/problem.yaml", "", 40);
  const std::vector<double> truth = random_truth(*c.model, c.columns, 0.1, c.random);
  c.read(truth, 3.0);
  FitOptions ordinary;
  ordinary.weighting = Weighting::ordinary;
  const Fit result = fit(*c.model, c.columns, c.poses, ordinary);
  EXPECT_FALSE(result.scale_known);
  EXPECT_NEAR(result.scale, 3.0, 0.4);
  const Fit stated = fit(*c.model, c.columns, c.poses, {});
  // The stated noise is refused, so that both count the noise that the residuals show.
  EXPECT_NEAR(stated.noise_factor, 3.0, 0.4);
  EXPECT_NEAR(result.covariance.trace() / stated.covariance.trace(), 1.0, 0.1);
}

TEST(Fit, APriorHoldsWhatTheDataCannotTell) {
  Case c("kr270/problem.yaml", "", 18);
  const std::vector<double> truth = random_truth(*c.model, c.columns, 0.1, c.random);
  c.read(truth, 1.0);
  std::vector<MeasuredPose> few(c.poses.begin(), c.poses.begin() + 2);
  EXPECT_THROW(fit(*c.model, c.columns, few, {}), CannotDo);
  FitOptions options;
  options.prior = Prior::every;
  const Fit result = fit(*c.model, c.columns, few, options);
  EXPECT_TRUE(result.converged);
  for (Eigen::Index j = 0; j < result.change.size(); ++j) {
    const double tolerance = c.columns.parameters[std::size_t(j)].tolerance;
    EXPECT_LE(std::sqrt(result.covariance(j, j)), tolerance * (1 + 1e-9));
    EXPECT_LT(std::abs(result.change[j]), 6 * tolerance);
  }
}

TEST(Fit, CurvatureGrowsWithTheNoiseWhicheverWayItIsKnown) {
  Case c("kr270/problem.yaml", "", 30);
  c.read(std::vector<double>(c.model->parameters().size(), 0.0), 1.0);
  const double quiet = curvature(*c.model, c.columns, c.poses, fit(*c.model, c.columns, c.poses, {})).largest;
  c.read(std::vector<double>(c.model->parameters().size(), 0.0), 10.0);
  FitOptions ordinary;
  ordinary.weighting = Weighting::ordinary;
  const Fit stated = fit(*c.model, c.columns, c.poses, {}), told = fit(*c.model, c.columns, c.poses, ordinary);
  const double by_stated = curvature(*c.model, c.columns, c.poses, stated).largest,
               by_told = curvature(*c.model, c.columns, c.poses, told).largest;
  EXPECT_NEAR(by_told / by_stated, 1.0, 0.2);
  EXPECT_NEAR(by_told / quiet / told.scale, 1.0, 0.2);
}

TEST(Fit, APriorIsNotStretchedByTheNoise) {
  Case c("kr270/problem.yaml", "", 18);
  c.read(random_truth(*c.model, c.columns, 0.1, c.random), 50.0);
  FitOptions options;
  options.prior = Prior::every;
  options.weighting = Weighting::ordinary;
  const Fit result = fit(*c.model, c.columns, c.poses, options);
  for (Eigen::Index j = 0; j < result.change.size(); ++j)
    EXPECT_LE(std::sqrt(result.covariance(j, j)), c.columns.parameters[std::size_t(j)].tolerance * (1 + 1e-9));
}

TEST(Fit, SaysWhereThePredictedIntervalsCannotHold) {
  // The same robot, the same poses: linear with little noise, far from it with the stated noise.
  Case c("telescope/problem.yaml", "rigid", 20);
  const std::vector<double> truth(c.model->parameters().size(), 0.0);
  c.read(truth, 1.0);
  const Curvature bent = curvature(*c.model, c.columns, c.poses, fit(*c.model, c.columns, c.poses, {}));
  EXPECT_GT(bent.largest, curvature_limit);
  EXPECT_GE(bent.parameter, 0);
  Case straight("kr270/problem.yaml", "", 18);
  straight.read(std::vector<double>(straight.model->parameters().size(), 0.0), 1.0);
  const Fit result = fit(*straight.model, straight.columns, straight.poses, {});
  EXPECT_LT(curvature(*straight.model, straight.columns, straight.poses, result).largest, 0.05);
}

TEST(Fit, DependentColumnsAreRefused) {
  Case c("telescope/problem.yaml", "rigid", 20);
  const Problem problem = example("telescope/problem.yaml");
  VariantColumns columns = c.columns;
  columns.selected.push_back(columns.selected.back());
  columns.parameters.push_back(columns.parameters.back());
  c.read(std::vector<double>(c.model->parameters().size(), 0.0), 1.0);
  EXPECT_THROW(fit(*c.model, columns, c.poses, {}), CannotDo);
}

}  // namespace
}  // namespace posewright
