// Intervals by profile: where the sum of squares rises by what chance allows, the other parameters estimated anew.

#include "posewright/calibration/profile.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <functional>

#include "posewright/calibration/curvature.hpp"
#include "posewright/calibration/residual_statistics.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/support/distributions.hpp"
#include "posewright/support/error.hpp"
#include "tests/kit/example_problems.hpp"
#include "tests/kit/virtual_data.hpp"

namespace posewright {
namespace {

using Curve = std::function<double(double x, const Eigen::VectorXd& p)>;

/// One reading a configuration, any function of the coordinate and the parameters: nominal values 0.
class CurveModel : public IdentificationModel {
 public:
  CurveModel(Curve curve, std::vector<double> tolerances, double noise) : curve_(std::move(curve)), noise_(noise) {
    coordinates_.push_back({"x", "m", 0.0, 10.0});
    readings_.push_back({"y", "m"});
    rows_ = 1;
    for (std::size_t i = 0; i < tolerances.size(); ++i) {
      Parameter p;
      p.name = "p" + std::to_string(i);
      p.unit = "m";
      p.tolerance = tolerances[i];
      parameters_.push_back(p);
    }
  }

  VariantColumns all() const {
    VariantColumns columns;
    for (std::size_t i = 0; i < parameters_.size(); ++i) columns.selected.push_back(int(i));
    columns.parameters = parameters_;
    return columns;
  }

 private:
  bool do_linearise(const Point& at, std::span<const int> selected, Linearisation& out) const override {
    out.covariance.setConstant(1, 1, noise_ * noise_);
    out.share_readings();
    out.G.resize(1, Eigen::Index(selected.size()));
    const Eigen::VectorXd p = of(at);
    for (std::size_t j = 0; j < selected.size(); ++j) {
      const double step = 1e-6 * parameters_[std::size_t(selected[j])].tolerance;
      Eigen::VectorXd up = p, down = p;
      up[selected[j]] += step;
      down[selected[j]] -= step;
      out.G(0, Eigen::Index(j)) = (curve_(at.q[0], up) - curve_(at.q[0], down)) / (2 * step);
    }
    return true;
  }
  bool do_read(const Point& at, Eigen::VectorXd& y) const override {
    y.resize(1);
    y[0] = curve_(at.q[0], of(at));
    return std::isfinite(y[0]);
  }
  Eigen::Isometry3d do_tool_pose(const Point&) const override { return Eigen::Isometry3d::Identity(); }
  Eigen::VectorXd of(const Point& at) const {
    Eigen::VectorXd p = Eigen::VectorXd::Zero(Eigen::Index(parameters_.size()));
    for (std::size_t i = 0; i < at.correction.size(); ++i) p[Eigen::Index(i)] = at.correction[i];
    return p;
  }

  Curve curve_;
  double noise_;
};

std::vector<MeasuredPose> read(const std::vector<double>& x, const std::vector<double>& y) {
  std::vector<MeasuredPose> poses;
  for (std::size_t k = 0; k < x.size(); ++k) poses.push_back({int(k) + 1, {x[k]}, Eigen::VectorXd::Constant(1, y[k])});
  return poses;
}

double factor_of(const Fit& fit) { return interval_factor(interval_probability, fit.scale_known, fit.freedom); }

ProfileInterval interval_of(const CurveModel& model, const std::vector<MeasuredPose>& poses, const FitOptions& options,
                            const Fit& fit, int column) {
  Profile profile(model, model.all(), poses, options, fit);
  return profile.interval(column, factor_of(fit), Monitor{}).value();
}

/// Velocity of an enzyme reaction over the substrate's concentration, as Michaelis and Menten have it.
double reaction(double x, const Eigen::VectorXd& p) { return (200 + p[0]) * x / (0.05 + p[1] + x); }

// Puromycin, treated cells: Bates and Watts (1988), Table A1.3.
const std::vector<double> concentrations{0.02, 0.02, 0.06, 0.06, 0.11, 0.11, 0.22, 0.22, 0.56, 0.56, 1.10, 1.10};
const std::vector<double> velocities{76, 47, 97, 107, 123, 139, 159, 152, 191, 201, 207, 200};

TEST(Profile, IntervalsOfThePuromycinDataAreThePublishedOnesWhichABruteSearchFindsToo) {
  const CurveModel model(reaction, {50, 0.02}, 1.0);
  const auto poses = read(concentrations, velocities);
  FitOptions options;
  options.weighting = Weighting::ordinary;
  options.start = {5, 0.01};
  const Fit result = fit(model, model.all(), poses, options);
  ASSERT_TRUE(result.converged);
  EXPECT_NEAR(200 + result.change[0], 212.7, 0.05);
  EXPECT_NEAR(0.05 + result.change[1], 0.06412, 5e-5);
  // Least squares of V in closed form where K is given, and of K by a fine grid where V is.
  const auto squares = [&](double V, double K) {
    double sum = 0;
    for (std::size_t i = 0; i < velocities.size(); ++i)
      sum += std::pow(velocities[i] - V * concentrations[i] / (K + concentrations[i]), 2);
    return sum;
  };
  const auto at_K = [&](double K) {
    double gy = 0, gg = 0;
    for (std::size_t i = 0; i < velocities.size(); ++i) {
      const double g = concentrations[i] / (K + concentrations[i]);
      gy += g * velocities[i];
      gg += g * g;
    }
    return squares(gy / gg, K);
  };
  const auto at_V = [&](double V) {
    double least = 1e300;
    for (double K = 0.03; K < 0.12; K += 1e-5) least = std::min(least, squares(V, K));
    return least;
  };
  double least = 1e300;
  for (double K = 0.03; K < 0.12; K += 1e-6) least = std::min(least, at_K(K));
  const double limit = least * (1 + std::pow(student_upper_quantile(0.025, 10), 2) / 10);
  const auto crossing = [&](const std::function<double(double)>& profile, double inside, double outside) {
    for (int i = 0; i < 40; ++i) (profile((inside + outside) / 2) < limit ? inside : outside) = (inside + outside) / 2;
    return inside;
  };
  const ProfileInterval V = interval_of(model, poses, options, result, 0);
  const ProfileInterval K = interval_of(model, poses, options, result, 1);
  EXPECT_NEAR(200 + V.lower, crossing(at_V, 212.7, 180), 0.01);
  EXPECT_NEAR(200 + V.upper, crossing(at_V, 212.7, 250), 0.01);
  EXPECT_NEAR(0.05 + K.lower, crossing(at_K, 0.064, 0.03), 1e-5);
  EXPECT_NEAR(0.05 + K.upper, crossing(at_K, 0.064, 0.12), 1e-5);
  // What R's confint() gives of the same data.
  EXPECT_NEAR(200 + V.lower, 197.302, 0.02);
  EXPECT_NEAR(200 + V.upper, 229.290, 0.02);
  EXPECT_NEAR(0.05 + K.lower, 0.046925, 2e-5);
  EXPECT_NEAR(0.05 + K.upper, 0.086160, 2e-5);
}

TEST(Profile, WithTolerancesItEndsWhereTheClosedFormSays) {
  // y = θ², noise s, and θ = 0 within t: S = (y − θ²)²/s² + θ²/t², a quadratic in θ².
  constexpr double y = 1.0, s = 0.3, t = 2.0;
  const CurveModel model([](double, const Eigen::VectorXd& p) { return p[0] * p[0]; }, {t}, s);
  FitOptions options;
  options.prior = Prior::every;
  options.start = {1.2};
  const auto poses = read({1}, {y});
  const Fit result = fit(model, model.all(), poses, options);
  const double centre = y - s * s / (2 * t * t);  // of the parabola in θ²
  EXPECT_NEAR(result.change[0], std::sqrt(centre), 1e-6);
  const double half = s * factor_of(result);
  const ProfileInterval found = interval_of(model, poses, options, result, 0);
  EXPECT_NEAR(found.lower, std::sqrt(centre - half), 1e-3);
  EXPECT_NEAR(found.upper, std::sqrt(centre + half), 1e-3);
}

TEST(Profile, GoesOnWhereTheDataDoNotTellTheSign) {
  const CurveModel model([](double, const Eigen::VectorXd& p) { return p[0] * p[0]; }, {1.0}, 0.3);
  FitOptions options;
  options.start = {0.6};
  const auto poses = read({1, 2}, {0.2, 0.3});
  const Fit result = fit(model, model.all(), poses, options);
  const ProfileInterval found = interval_of(model, poses, options, result, 0);
  const double end = std::sqrt(0.25 + 0.3 / std::sqrt(2.0) * normal_upper_quantile(0.025));
  EXPECT_NEAR(found.upper, end, 1e-3);
  EXPECT_NEAR(found.lower, -end, 1e-3);
}

TEST(Curvature, IntrinsicIsWhatBendsAwayFromTheTangentWhateverTheNoiseIsFoundToBe) {
  // Readings (p + p² / 2, p² / 2): half of the bend is along the tangent (1, 0), half at right angles to it.
  const double noise = 0.1, bend = 0.5;
  const CurveModel model([=](double x, const Eigen::VectorXd& p) { return (x < 1.5 ? p[0] : 0) + bend * p[0] * p[0]; },
                         {1.0}, noise);
  const auto poses = read({1, 2}, {0, 0});
  Fit result = fit(model, model.all(), poses, FitOptions{});
  for (const double factor : {1.0, 3.0}) {
    Fit louder = result;
    louder.noise_factor = factor;
    louder.covariance.setConstant(1, 1, std::pow(factor * noise, 2));
    const Curvature found = curvature(model, model.all(), poses, louder);
    EXPECT_NEAR(found.intrinsic, bend * factor * noise, 1e-6);
    EXPECT_NEAR(found.largest, std::sqrt(2) * bend * factor * noise, 1e-6);
  }
}

TEST(Profile, HasNoEndWhereTheReadingsNeverRefuseTheParameter) {
  const CurveModel model([](double x, const Eigen::VectorXd& p) { return 1 - std::exp(-p[0] * x); }, {1.0}, 0.1);
  FitOptions options;
  options.start = {1.0};
  const auto poses = read({1}, {0.95});
  const Fit result = fit(model, model.all(), poses, options);
  const ProfileInterval found = interval_of(model, poses, options, result, 0);
  EXPECT_NEAR(found.lower, -std::log(1 - (0.95 - 0.1 * normal_upper_quantile(0.025))), 1e-3);
  EXPECT_TRUE(std::isinf(found.upper));
}

TEST(Profile, PassesABetterEstimateThanALocalMinimum) {
  // Readings of θ² and a little of θ itself: the branch that the fit began on is the wrong one.
  const CurveModel model([](double x, const Eigen::VectorXd& p) { return p[0] * p[0] + 0.2 * x * p[0]; }, {1.0}, 0.3);
  FitOptions options;
  options.start = {0.4};
  const auto poses = read({0, 1}, {0.2, 0.05});
  const Fit result = fit(model, model.all(), poses, options);
  ASSERT_GT(result.change[0], 0);
  Profile profile(model, model.all(), poses, options, result);
  ASSERT_TRUE(profile.interval(0, factor_of(result), Monitor{}));
  ASSERT_GT(profile.better(), 0);
  options.start = profile.better_estimate();
  const Fit again = fit(model, model.all(), poses, options);
  EXPECT_LT(again.change[0], 0);
  EXPECT_LE(again.chi_square, result.chi_square - profile.better() + 1e-9);
}

TEST(Profile, CoversWhereTheLinearIntervalDoesNot) {
  // Few and bad readings of a saturation: drawn by the curve itself, intervals by the fits.
  const CurveModel model([](double x, const Eigen::VectorXd& p) { return (1 + p[0]) * x / (0.5 + p[1] + x); },
                         {1.0, 0.5}, 0.12);
  const std::vector<double> x{0.1, 0.2, 0.4, 0.8, 1.6, 3.2};
  Random random(7, 1);
  int fitted = 0, linear = 0, profiled = 0;
  for (int draw = 0; draw < 2000; ++draw) {
    std::vector<double> y;
    for (const double at : x) y.push_back(at / (0.5 + at) + 0.12 * random.normal());
    const auto poses = read(x, y);
    const Fit result = fit(model, model.all(), poses, {});
    if (!result.converged) continue;
    ++fitted;
    linear += std::abs(result.change[1]) <= factor_of(result) * std::sqrt(result.covariance(1, 1)) ? 1 : 0;
    Profile profile(model, model.all(), poses, {}, result);
    const auto tau = profile.tau(1, 0.0, Monitor{});
    profiled += tau && std::abs(*tau) <= factor_of(result) ? 1 : 0;
  }
  EXPECT_GT(fitted, 1960);
  const double error = std::sqrt(0.95 * 0.05 / fitted);
  EXPECT_NEAR(double(profiled) / fitted, 0.95, 0.01 + 3 * error);
  EXPECT_LT(double(linear) / fitted, 0.95 - 4 * error);
}

/// A robot of an example with readings of a truth.
struct Robot {
  std::unique_ptr<IdentificationModel> model;
  VariantColumns columns;
  std::vector<MeasuredPose> poses;
  std::vector<double> truth;

  Robot(const std::string& file, int count, double off, std::uint64_t seed) {
    const Problem problem = example(file);
    const VariantSpec& spec = find_variant(problem, "");
    model = make_model({problem, spec});
    Random random(seed, 1);
    poses = random_poses(*model, count, random);
    columns = select_columns(*model, {problem, spec});
    truth = random_truth(*model, columns, off, random);
    read_poses_of(*model, truth, 1.0, random, poses);
  }
};

TEST(Profile, OfALinearProblemIsTheUsualInterval) {
  Robot arm("five_bar/problem.yaml", 25, 0.1, 3);
  FitOptions options;
  options.prior = Prior::every;
  const Fit result = fit(*arm.model, arm.columns, arm.poses, options);
  EXPECT_TRUE(curvature(*arm.model, arm.columns, arm.poses, result).bent.empty());
  std::vector<int> all;
  for (int j = 0; j < int(arm.columns.selected.size()); ++j) all.push_back(j);
  const double factor = factor_of(result);
  const Profiles one =
      profile_intervals(*arm.model, arm.columns, arm.poses, options, result, all, factor, 1, Monitor{});
  const Profiles two =
      profile_intervals(*arm.model, arm.columns, arm.poses, options, result, all, factor, 2, Monitor{});
  for (const int j : all) {
    const double half = factor * std::sqrt(result.covariance(j, j));
    EXPECT_NEAR(one.intervals[std::size_t(j)]->lower, result.change[j] - half, 0.02 * half);
    EXPECT_NEAR(one.intervals[std::size_t(j)]->upper, result.change[j] + half, 0.02 * half);
    EXPECT_EQ(one.intervals[std::size_t(j)]->lower, two.intervals[std::size_t(j)]->lower) << "threads";
  }
}

TEST(Profile, OfTheTelescopeHoldsTheTruthIfTheTruthsOwnTauSaysSo) {
  Robot telescope("telescope/problem.yaml", 40, 1.0, 11);
  const Fit result = fit(*telescope.model, telescope.columns, telescope.poses, {});
  ASSERT_TRUE(result.converged);
  std::vector<int> bent = curvature(*telescope.model, telescope.columns, telescope.poses, result).bent;
  ASSERT_GE(bent.size(), 4U);
  bent.resize(3);
  Profile profile(*telescope.model, telescope.columns, telescope.poses, {}, result);
  int apart = 0;
  for (const int j : bent) {
    EXPECT_NE(telescope.columns.parameters[std::size_t(j)].name.find(".u"), std::string::npos) << "a leg's direction";
    const double truth = telescope.truth[std::size_t(telescope.columns.selected[std::size_t(j)])];
    const auto interval = profile.interval(j, factor_of(result), Monitor{});
    ASSERT_TRUE(interval);
    EXPECT_LT(interval->lower, result.change[j]);
    EXPECT_GT(interval->upper, result.change[j]);
    const auto tau = profile.tau(j, truth, Monitor{});
    ASSERT_TRUE(tau);
    EXPECT_EQ(interval->lower <= truth && truth <= interval->upper, std::abs(*tau) <= factor_of(result));
    const double half = factor_of(result) * std::sqrt(result.covariance(j, j));
    apart += std::abs(interval->upper - result.change[j] - half) > 0.1 * half ? 1 : 0;
  }
  EXPECT_GT(apart, 0);
}

TEST(Profile, IsStoppedAndRefusesRobustWeights) {
  const CurveModel model(reaction, {50, 0.02}, 10.0);
  const auto poses = read(concentrations, velocities);
  const Fit result = fit(model, model.all(), poses, {});
  const std::atomic<bool> interrupted{true};
  Monitor monitor;
  monitor.interrupted = &interrupted;
  const Profiles stopped =
      profile_intervals(model, model.all(), poses, {}, result, {0, 1}, factor_of(result), 1, monitor);
  EXPECT_FALSE(stopped.intervals[0] || stopped.intervals[1]);
  FitOptions robust;
  robust.weighting = Weighting::robust;
  EXPECT_THROW(Profile(model, model.all(), poses, robust, result), CannotDo);
}

}  // namespace
}  // namespace posewright
