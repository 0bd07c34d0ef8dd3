// Virtual experiments: prediction, level and coverage are right where the problem is linear, and the draws belong to
// seed and number alone.

#include "posewright/calibration/experiment.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <filesystem>
#include <limits>

#include "posewright/blocks/identifiability.hpp"
#include "posewright/calibration/experiment_summary.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/support/error.hpp"
#include "tests/kit/virtual_data.hpp"

namespace posewright {
namespace {

namespace fs = std::filesystem;

/// A variant of an example at random poses, its own truth.
struct ExperimentCase {
  std::unique_ptr<IdentificationModel> model;
  VirtualExperiment experiment;

  ExperimentCase(const std::string& file, const std::string& variant, int count, int draws) {
    const Problem problem = read_problem(fs::path(POSEWRIGHT_SOURCE_DIR) / "examples" / file);
    const VariantSpec& spec = find_variant(problem, variant);
    model = make_model({problem, spec});
    experiment.model = experiment.truth.model = model.get();
    Random random(3, 1);
    experiment.poses = random_poses(*model, count, random);
    for (MeasuredPose& pose : experiment.poses) {
      pose.y = Eigen::VectorXd::Zero(Eigen::Index(model->readings().size()));
      experiment.truth.configurations.push_back(pose.q);
    }
    const VariantColumns all = select_columns(*model, {problem, spec});
    IdentifiabilityOptions options;
    options.tiers = all.tiers;
    experiment.columns =
        subset(all, identifiability(blocks_of(*model, all, experiment.poses), all.parameters, options).kept);
    experiment.truth.drawn = experiment.columns;
    experiment.options.draws = draws;
  }

  ExperimentSummary run() const { return summarise(experiment, run_experiment(experiment, Monitor{})); }
  Eigen::VectorXd predicted() const {
    const BlockArray blocks = blocks_of(*model, experiment.columns, experiment.poses);
    const Eigen::MatrixXd M = blocks.all().transpose() * blocks.all();
    const Eigen::VectorXd unit = M.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd scaled = unit.asDiagonal() * M * unit.asDiagonal();
    return unit.cwiseProduct(scaled.inverse().diagonal().cwiseSqrt());
  }
  /// Root mean square over the parameters of observed over predicted σ.
  double mean_ratio(const ExperimentSummary& summary) const {
    const Eigen::VectorXd sigma = predicted();
    double sum = 0;
    for (Eigen::Index j = 0; j < sigma.size(); ++j)
      sum += std::pow(summary.parameters[std::size_t(j)].observed / sigma[j], 2) / double(sigma.size());
    return std::sqrt(sum);
  }
};

struct ExperimentExample {
  const char *file, *variant;
  int poses;
};
void PrintTo(const ExperimentExample& named, std::ostream* out) { *out << named.file << ' ' << named.variant; }

class EveryVirtualRobot : public testing::TestWithParam<ExperimentExample> {};

TEST_P(EveryVirtualRobot, HasThePredictedSigmaAndIntervalsThatCoverAndTestsThatKeepTheirLevel) {
  constexpr int draws = 300;
  ExperimentCase c(GetParam().file, GetParam().variant, GetParam().poses, draws);
  c.experiment.options.exact = true;
  const ExperimentSummary summary = c.run();
  ASSERT_EQ(summary.fitted, draws) << summary.first_failure;
  const Eigen::VectorXd sigma = c.predicted();
  double covered = 0;
  for (std::size_t j = 0; j < summary.parameters.size(); ++j) {
    const ParameterErrors& e = summary.parameters[j];
    const std::string& name = c.experiment.columns.parameters[j].name;
    EXPECT_NEAR(e.observed / sigma[Eigen::Index(j)], 1, 5 * summary.sigma_error) << name;
    EXPECT_NEAR(e.coverage, 0.95, 5 * summary.coverage_error) << name;
    EXPECT_LT(std::abs(e.bias), 5 * e.bias_error) << name;
    covered += e.coverage / double(summary.parameters.size());
  }
  EXPECT_NEAR(covered, 0.95, 3 * summary.coverage_error);
  EXPECT_NEAR(summary.chi_square, 1, 4 * summary.chi_square_error);
  ASSERT_TRUE(summary.rejected);
  EXPECT_NEAR(*summary.rejected, 0.05, 4 * summary.coverage_error);
}

INSTANTIATE_TEST_SUITE_P(Examples, EveryVirtualRobot,
                         testing::Values(ExperimentExample{"kr270/problem.yaml", "", 18},
                                         ExperimentExample{"kr270/elastostatic.yaml", "", 20},
                                         ExperimentExample{"telescope/problem.yaml", "linear", 20},
                                         ExperimentExample{"gough/problem.yaml", "", 20}),
                         [](const auto& row) { return std::string("Robot") + std::to_string(row.index); });

TEST(Experiment, GivesTheSameOnAnyNumberOfThreads) {
  ExperimentCase c("kr270/problem.yaml", "", 18, 12);
  c.experiment.options.missing = 0.1;
  c.experiment.options.outliers = 0.1;
  c.experiment.options.threads = 1;
  const std::vector<VirtualCalibration> one = run_experiment(c.experiment, Monitor{});
  for (const int threads : {2, 3}) {
    c.experiment.options.threads = threads;
    const std::vector<VirtualCalibration> several = run_experiment(c.experiment, Monitor{});
    for (std::size_t d = 0; d < one.size(); ++d) {
      EXPECT_EQ(several[d].error, one[d].error);
      EXPECT_EQ(several[d].sigma, one[d].sigma);
      EXPECT_EQ(several[d].chi_square, one[d].chi_square);
    }
  }
  c.experiment.options.seed = 1;
  EXPECT_NE(run_experiment(c.experiment, Monitor{})[0].error, one[0].error);
}

TEST(Experiment, NoiseIsTheSameWhateverElseIsDrawn) {
  ExperimentCase c("kr270/problem.yaml", "", 8, 1);
  std::vector<double> truth;
  c.experiment.options.exact = true;
  const std::vector<MeasuredPose> plain = draw_readings(c.experiment, 4, truth);
  c.experiment.options.missing = 0.4;
  const std::vector<MeasuredPose> fewer = draw_readings(c.experiment, 4, truth);
  int read = 0, missing = 0;
  for (const MeasuredPose& pose : fewer)
    for (Eigen::Index i = 0; i < pose.y.size(); ++i) {
      if (std::isnan(pose.y[i])) ++missing;
      else EXPECT_EQ(pose.y[i], plain[std::size_t(pose.id - 1)].y[i]) << ++read;
    }
  EXPECT_GT(missing, 0);
}

TEST(Experiment, HistogramsHoldEveryDrawWhereItsErrorIs) {
  ExperimentCase c("kr270/problem.yaml", "", 12, 40);
  const std::vector<VirtualCalibration> draws = run_experiment(c.experiment, Monitor{});
  const ExperimentSummary summary = summarise(c.experiment, draws);
  for (std::size_t j = 0; j < summary.parameters.size(); ++j) {
    const std::vector<int>& counts = summary.parameters[j].histogram;
    ASSERT_EQ(counts.size(), 18U);
    for (int bin = 0; bin < 18; ++bin) {
      // Half a σ wide, from −4.5 σ; what is beyond counts at the ends.
      const double lower = bin == 0 ? -1e9 : -4.5 + 0.5 * bin, upper = bin == 17 ? 1e9 : -4.0 + 0.5 * bin;
      int inside = 0;
      for (const VirtualCalibration& draw : draws) {
        const double error = draw.error[Eigen::Index(j)], sigma = draw.sigma[Eigen::Index(j)];
        inside += error >= lower * sigma && error < upper * sigma ? 1 : 0;
      }
      EXPECT_EQ(counts[std::size_t(bin)], inside) << "parameter " << j << ", bin " << bin;
    }
  }
}

TEST(Experiment, WhatIsHiddenIsNeverRead) {
  ExperimentCase c("kr270/problem.yaml", "", 8, 1);
  c.experiment.poses[2].y.segment<3>(3).setConstant(std::numeric_limits<double>::quiet_NaN());
  c.experiment.poses[5].y.setConstant(std::numeric_limits<double>::quiet_NaN());
  std::vector<double> truth;
  const std::vector<MeasuredPose> poses = draw_readings(c.experiment, 0, truth);
  ASSERT_EQ(poses.size(), 7U) << "a pose where nothing is read is none";
  EXPECT_TRUE(poses[2].y.segment<3>(3).array().isNaN().all());
  EXPECT_FALSE(poses[2].y.head<3>().array().isNaN().any());
}

TEST(Experiment, OutliersSpoilWeightedFitsAndNotRobustOnes) {
  ExperimentCase c("kr270/problem.yaml", "", 24, 60);
  const double clean = c.mean_ratio(c.run());
  c.experiment.options.outliers = 0.05;
  const ExperimentSummary spoiled = c.run();
  c.experiment.options.fit.weighting = Weighting::robust;
  const ExperimentSummary robust = c.run();
  EXPECT_GT(c.mean_ratio(spoiled), 1.8 * clean);
  EXPECT_LT(c.mean_ratio(robust), 1.4 * clean);
  EXPECT_GT(*spoiled.rejected, 0.95);
  EXPECT_FALSE(robust.rejected) << "weights make χ² meaningless";
}

TEST(Experiment, MissingTargetsRaiseSigmaAsMuchAsTheyTakeInformation) {
  ExperimentCase c("kr270/problem.yaml", "", 40, 200);
  c.experiment.options.exact = true;
  const double all = c.mean_ratio(c.run());
  c.experiment.options.missing = 0.3;
  EXPECT_NEAR(c.mean_ratio(c.run()) / all, 1 / std::sqrt(0.7), 0.1);
}

TEST(Experiment, EndsWithWhatIsDoneAndSaysWhyNothingIs) {
  ExperimentCase c("kr270/problem.yaml", "", 18, 8);
  std::atomic<bool> stop{true};
  Monitor monitor;
  monitor.interrupted = &stop;
  const std::vector<VirtualCalibration> none = run_experiment(c.experiment, monitor);
  EXPECT_EQ(none[7].end, VirtualCalibration::End::not_run);
  EXPECT_THROW(summarise(c.experiment, none), CannotDo);
  ExperimentCase few("kr270/problem.yaml", "", 18, 2);
  few.experiment.options.missing = 0.99;
  const std::vector<VirtualCalibration> failed = run_experiment(few.experiment, Monitor{});
  EXPECT_EQ(failed[0].end, VirtualCalibration::End::failed);
  EXPECT_NE(failed[0].why.find("parameters"), std::string::npos) << failed[0].why;
}

}  // namespace
}  // namespace posewright
