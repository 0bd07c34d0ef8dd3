// The next pose to measure and when to stop. The second road is a planar arm by definition: its derivatives, all
// candidates one by one, and calibrations that are drawn.

#include "posewright/results/next.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "posewright/lists/read_poses.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/study/accuracy_points.hpp"
#include "posewright/study/error_limits.hpp"
#include "posewright/study/expected_error.hpp"
#include "posewright/study/forecast.hpp"
#include "posewright/study/unmodelled.hpp"
#include "posewright/study/variant.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/json.hpp"
#include "posewright/support/random.hpp"
#include "posewright/tasks/calibrate_problem.hpp"
#include "posewright/tasks/next_poses.hpp"
#include "posewright/tasks/next_state.hpp"
#include "tests/kit/message_of.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

using Eigen::Vector2d, Eigen::Vector4d;
using testing::HasSubstr;
using Block = Eigen::Matrix<double, 2, 4>;

constexpr double upper = 1.2, lower = 0.8, noise = 1e-3;  // m

const char* const urdf =
    R"(<robot name="planar"><link name="l0"/><link name="l1"/><link name="l2"/><link name="tip"/>
<joint name="q1" type="revolute"><parent link="l0"/><child link="l1"/><axis xyz="0 0 1"/>
<limit lower="-3" upper="3" effort="0" velocity="1"/></joint>
<joint name="q2" type="revolute"><parent link="l1"/><child link="l2"/><origin xyz="1.2 0 0"/><axis xyz="0 0 1"/>
<limit lower="-2" upper="2" effort="0" velocity="1"/></joint>
<joint name="end" type="fixed"><parent link="l2"/><child link="tip"/><origin xyz="0.8 0 0"/></joint></robot>)";

const std::vector<Vector2d> candidates = {{0, 1.5},    {0.4, 1.1}, {-2, -1},    {0.3, 0.5},  {1.5, 0.1},  {1, 1.9},
                                          {2.5, -0.4}, {-1, 0.8},  {-2.4, 1.3}, {0.8, -1.4}, {-0.6, -0.2}};
const std::vector<Vector2d> tests = {{0.5, 1.7}, {-1.5, 1.9}, {2.0, 1.6}};
const std::vector<Vector2d> poses = {{0.2, 0.3}, {0.1, 0.4}, {1.1, -0.6}, {-0.9, 1.4}, {1.9, 0.2}};

/// Errors of both zero positions and both lengths, and the true robot that has them.
Vector2d tip(const Vector2d& q, const Vector4d& x) {
  const double a = q[0] + x[0], b = a + q[1] + x[1];
  return (upper + x[2]) * Vector2d(std::cos(a), std::sin(a)) + (lower + x[3]) * Vector2d(std::cos(b), std::sin(b));
}

Block derivative(const Vector2d& q) {
  Block J;
  for (int k = 0; k < 4; ++k) {
    const Vector4d h = 1e-6 * Vector4d::Unit(k);
    J.col(k) = (tip(q, h) - tip(q, -h)) / 2e-6;
  }
  return J;
}

Eigen::Matrix4d information(const std::vector<Vector2d>& list) {
  Eigen::Matrix4d M = Eigen::Matrix4d::Zero();
  for (const Vector2d& q : list) M += derivative(q).transpose() * derivative(q) / (noise * noise);
  return M;
}

/// Error at a test pose by that of the parameters: where the target sits on the tip is none of the robot's.
Block accuracy(const Vector2d& q) {
  Block A = derivative(q);
  A.col(3).setZero();
  return A;
}

/// By the parameters of interest alone.
double expected_error(const std::vector<Vector2d>& list) {
  const Eigen::Matrix4d V = information(list).inverse();
  double sum = 0;
  for (const Vector2d& q : tests) sum += (accuracy(q) * V * accuracy(q).transpose()).trace();
  return std::sqrt(sum / double(tests.size()));
}

double correlation(const Vector2d& a, const Vector2d& b) {
  const auto place = [](const Vector2d& q) {
    return Vector4d(std::cos(q[0]), std::cos(q[1]), std::sin(q[0]), std::sin(q[1]));
  };
  return std::exp(-(place(a) - place(b)).squaredNorm() / (2 * std::pow(std::numbers::pi / 3, 2)));
}

/// Errors that the program states after a list, eq. (68) and (69) of theory.md. No parameter is nuisance, so that
/// neither base nor tool is taken out.
class StatedError {
 public:
  explicit StatedError(const std::vector<Vector2d>& list) : n_(Eigen::Index(list.size())) {
    Eigen::MatrixXd J(2 * n_, 4), between = Eigen::MatrixXd::Zero(2 * n_, 3 * places_), there(3 * places_, 3 * places_);
    K_.resize(2 * n_, 2 * n_);
    const double share = 1 / std::sqrt(double(places_));
    for (Eigen::Index i = 0; i < n_; ++i) {
      const Vector2d& q = list[std::size_t(i)];
      J.middleRows<2>(2 * i) = derivative(q) / noise;
      for (Eigen::Index k = 0; k < n_; ++k)
        K_.block<2, 2>(2 * i, 2 * k) = correlation(q, list[std::size_t(k)]) * Eigen::Matrix2d::Identity();
      for (Eigen::Index t = 0; t < places_; ++t)
        between.block<2, 2>(2 * i, 3 * t) = share * correlation(q, tests[std::size_t(t)]) * Eigen::Matrix2d::Identity();
    }
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(3 * places_, 4);
    for (Eigen::Index t = 0; t < places_; ++t) {
      const Vector2d& q = tests[std::size_t(t)];
      A.middleRows<2>(3 * t) = share * accuracy(q);
      for (Eigen::Index u = 0; u < places_; ++u)
        there.block<3, 3>(3 * t, 3 * u) =
            share * share * correlation(q, tests[std::size_t(u)]) * Eigen::Matrix3d::Identity();
    }
    const Eigen::MatrixXd V = (J.transpose() * J).inverse(), G = A * V * J.transpose() / noise;
    by_noise_ = (A * V * A.transpose()).trace();
    by_effect_ = (G * K_ * G.transpose() - G * between - (G * between).transpose() + there).trace();
    beside_ = Eigen::MatrixXd::Identity(2 * n_, 2 * n_) - J * V * J.transpose();
  }

  double by_noise() const { return std::sqrt(by_noise_); }
  /// @param ratio  of the residuals' sum of squares to its expectation ν
  double size(double ratio) const {
    const double open = (beside_ * K_ * beside_).trace() / (noise * noise);
    return std::sqrt(std::max(0.0, ratio - 1) * double(2 * n_ - 4) / open);
  }
  double error(double ratio, double size) const {
    return std::sqrt(std::min(1.0, ratio) * by_noise_ + size * size * by_effect_);
  }

 private:
  static constexpr Eigen::Index places_ = 3;
  Eigen::Index n_;
  Eigen::MatrixXd K_, beside_;
  double by_noise_ = 0, by_effect_ = 0;
};

std::vector<Vector2d> with(std::vector<Vector2d> list, const Vector2d& more) {
  list.push_back(more);
  return list;
}

std::string row(int id, const Vector2d& q, const Vector2d& y) {
  return fmt::format("{},{},{},{},{}\n", id, q[0], q[1], y[0], y[1]);
}

const std::string header = "id,q1 [rad],q2 [rad],T1.x [m],T1.y [m]\n";
const Vector4d truth(1e-4, -2e-4, 1e-4, 2e-4);

/// Readings with so many times the noise that the problem states.
std::string readings(const std::vector<Vector2d>& list, double times = 1, std::uint64_t seed = 1) {
  Random random(seed, 1);
  std::string text = header;
  for (std::size_t i = 0; i < list.size(); ++i)
    text += row(int(i) + 1, list[i], tip(list[i], truth) + times * noise * Vector2d(random.normal(), random.normal()));
  return text;
}

class NextPosesOfAnArm : public testing::Test {
 protected:
  Problem problem(const std::string& more = "", const std::string& variant = "") {
    folder_.write("planar.urdf", urdf);
    std::string at;
    for (const Vector2d& q : tests) at += fmt::format("{}[{}, {}]", at.empty() ? "" : ", ", q[0], q[1]);
    return read_problem(folder_.write(
        "p.yaml",
        "posewright: 1\nrobot: {urdf: planar.urdf}\nmeasurement: {type: points, targets: {T1: [0, 0, 0]}, components: "
        "[x, y], device: {type: isotropic, noise: 1 mm}}\nvariants: {all: {parameters: [q1.offset, q2.offset, q2.x, "
        "target.T1.x]" +
            variant + "}}\ndesign: {test_poses: {at: [" + at + "]}" + more + "}\n"));
  }
  NextOptions options(const std::string& text) const {
    NextOptions next;
    next.data = "measured.csv";
    if (!text.empty()) next.text = text;
    next.prior = Prior::none;
    return next;
  }
  NextOptions among(const Problem& problem, const std::string& text, const std::string& criterion) {
    std::string list = "q1,q2\n";
    for (const Vector2d& q : candidates) list += fmt::format("{},{}\n", q[0], q[1]);
    NextOptions next = options(text);
    next.candidates_from = read_poses(folder_.write("list.csv", list), pose_coordinates(problem));
    next.criterion = criterion;
    return next;
  }
  TemporaryFolder folder_;
};

Vector2d configuration(const PlannedPose& pose) { return {pose.configuration[0].value, pose.configuration[1].value}; }

TEST_F(NextPosesOfAnArm, TheNextPoseIsTheBestOfAllCandidates) {
  const Problem p = problem();
  const NextPoses least_error = next_poses(p, among(p, readings(poses), "test_pose"), Monitor{});
  const NextPoses most_told = next_poses(p, among(p, readings(poses), "o1"), Monitor{});
  const auto best_error = std::min_element(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) {
    return expected_error(with(poses, a)) < expected_error(with(poses, b));
  });
  const auto best_det = std::max_element(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) {
    return information(with(poses, a)).determinant() < information(with(poses, b)).determinant();
  });
  ASSERT_TRUE(least_error.fitted);
  EXPECT_EQ(configuration(least_error.poses.front()), *best_error);
  EXPECT_EQ(configuration(most_told.poses.front()), *best_det);
  EXPECT_NE(*best_error, *best_det) << "else one of both would do for the other";
  EXPECT_EQ(least_error.poses.front().id, 6);
}

TEST_F(NextPosesOfAnArm, TheCriterionAutoGoesByTheNumberOfPosesWhateverTheFileNames) {
  const auto criterion = [&](const char* file, const char* named, std::size_t count) {
    const Problem p = problem(file);
    const std::vector<Vector2d> measured(poses.begin(), poses.begin() + std::ptrdiff_t(count));
    return next_poses(p, among(p, readings(measured), named), Monitor{}).criterion;
  };
  // Four parameters, two readings a pose: two poses determine them.
  EXPECT_EQ(criterion("", "", 2), "o1");
  EXPECT_EQ(criterion("", "", 5), "test_pose");
  EXPECT_EQ(criterion(", criterion: a", "", 5), "a");
  EXPECT_EQ(criterion(", criterion: a", "auto", 5), "test_pose");
  EXPECT_EQ(criterion(", criterion: auto", "a", 5), "a");
}

TEST_F(NextPosesOfAnArm, TheErrorIsThatOfTheDefinitionBeforeAndAfter) {
  const Problem p = problem();
  NextOptions next = among(p, readings(poses, 3), "test_pose");
  next.poses = 2;
  const NextPoses result = next_poses(p, next, Monitor{});
  ASSERT_EQ(result.curve.size(), poses.size() + 1);
  ASSERT_TRUE(result.expected);
  EXPECT_EQ(result.expected->size, ExpectedError::Size::measured);
  const double ratio = result.noise * result.noise, size = StatedError(poses).size(ratio);
  ASSERT_GT(ratio, 2);
  EXPECT_NEAR(result.expected->usual().size / size, 1, 4e-3);
  EXPECT_NEAR(result.expected->by_noise / StatedError(poses).by_noise(), 1, 2e-3);
  EXPECT_FALSE(result.curve[1].expected) << "one pose tells two of four";
  const auto stated = [&](const std::vector<Vector2d>& list) { return StatedError(list).error(ratio, size); };
  for (std::size_t n = 2; n <= poses.size(); ++n)
    EXPECT_NEAR(*result.curve[n].expected / stated({poses.begin(), poses.begin() + std::ptrdiff_t(n)}), 1, 4e-3) << n;
  std::vector<Vector2d> all = poses;
  for (std::size_t k = 0; k < 2; ++k) {
    all.push_back(configuration(result.poses[k]));
    EXPECT_NEAR(*result.ahead[k].expected / stated(all), 1, 4e-3) << k;
  }
  double least = INFINITY, three = INFINITY;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    for (std::size_t j = i + 1; j < candidates.size(); ++j)
      for (std::size_t k = j + 1; k < candidates.size(); ++k)
        if (const auto list = with(with(with(poses, candidates[i]), candidates[j]), candidates[k]);
            expected_error(list) < least) {
          least = expected_error(list);
          three = stated(list);
        }
  EXPECT_NEAR(*result.with_three->expected / three, 1, 4e-3) << "the best three of all";
}

TEST_F(NextPosesOfAnArm, TheFirstFigureIsThatOfACalibrationAndNamesWhatIsRequired) {
  const Problem p = problem(", candidates: 150");
  NextOptions next = options(readings(poses, 3));
  next.required = 1e-6;
  const NextPoses result = next_poses(p, next, Monitor{});
  CalibrateOptions calibrate;
  calibrate.data = next.data;
  calibrate.text = next.text;
  calibrate.prior = Prior::none;
  const Calibration found = calibrate_problem(p, calibrate, Monitor{});
  ASSERT_TRUE(result.expected && found.expected);
  ASSERT_EQ(result.expected->with.size(), found.expected->with.size());
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(result.expected->with[i].error / found.expected->with[i].error, 1, 1e-6) << i;
  EXPECT_NEAR(result.expected->by_noise / found.expected->by_noise, 1, 1e-6);
  EXPECT_EQ(result.expected->required, next.required);
  EXPECT_THAT(next_reason(result), HasSubstr("with the effect that calibration found, "));
  EXPECT_THAT(next_text(result), HasSubstr("Root mean square at 3 test poses. The effect"));
  const NextPoses first = next_poses(p, options(""), Monitor{});
  ASSERT_FALSE(first.expected) << "one pose";
  NextOptions some = options("");
  some.poses = 4;
  EXPECT_THAT(next_reason(next_poses(p, some, Monitor{})), HasSubstr("with the effects that robots have, "));
}

/// Two shapes of an effect, each of three sizes, with noise as stated and larger.
std::vector<PossibleEffects> drawn_possibilities(Random& random) {
  std::vector<PossibleEffects> effects(2);
  double sum = 0;
  for (PossibleEffects& one : effects)
    for (const double effect : {0.0, 0.5, 3.0})
      for (const double noise : {1.0, 1.7})
        sum += one.sizes.emplace_back(PossibleSize{effect, noise, random.uniform(0.1, 1)}).probability;
  for (PossibleEffects& one : effects)
    for (PossibleSize& size : one.sizes) size.probability /= sum;
  return effects;
}

TEST(UpperError, IsTheQuantileOfErrorsWhoseNoiseAndEffectAreDrawn) {
  Random random(3, 7);
  const std::vector<double> noise = {1, 0.5, 0.2, 0.1, 0.05};
  const std::vector<std::vector<double>> effect = {{0.3, 0.9, 0.6, 0.4, 0.2}, {2, 0.1, 0, 0, 0}};
  const std::vector<PossibleEffects> effects = drawn_possibilities(random);
  std::vector<ErrorParts> parts(2);
  for (std::size_t shape = 0; shape < 2; ++shape)
    for (std::size_t i = 0; i < noise.size(); ++i) {
      parts[shape].noise += noise[i];
      parts[shape].effect += effect[shape][i];
      parts[shape].noise_squared += noise[i] * noise[i];
      parts[shape].both += noise[i] * effect[shape][i];
      parts[shape].effect_squared += effect[shape][i] * effect[shape][i];
    }
  const double limit = upper_error(effects, parts), along = upper_normal(effects, noise[0], {0.3, 2});
  const double sigma = upper_sigma(effects, noise[0], {0.3, 2});
  constexpr int draws = 20000;
  double above = 0, beyond = 0, larger = 0;
  for (int i = 0; i < draws; ++i)
    for (std::size_t shape = 0; shape < 2; ++shape)
      for (const PossibleSize& size : effects[shape].sizes) {
        const auto variance = [&](std::size_t k) {
          return std::pow(size.noise, 2) * noise[k] + std::pow(size.effect, 2) * effect[shape][k];
        };
        double error = 0;
        for (std::size_t k = 0; k < noise.size(); ++k) error += variance(k) * std::pow(random.normal(), 2);
        above += error > limit * limit ? size.probability : 0.0;
        beyond += std::abs(random.normal()) * std::sqrt(variance(0)) > along ? size.probability : 0.0;
        larger += std::sqrt(variance(0)) > sigma ? size.probability : 0.0;
      }
  EXPECT_NEAR(above / draws, 0.05, 0.006);
  EXPECT_NEAR(beyond / draws, 0.05, 0.003);
  EXPECT_LE(larger / draws, 0.05 + 1e-9);
  EXPECT_GT(sigma, 1.0) << "an effect is possible";
}

TEST_F(NextPosesOfAnArm, ReachedIsNotSaidBeforeAnEffectCouldBeSeen) {
  // Robots that miss at each pose by an effect four times as large as the noise.
  const Problem p = problem(", candidates: 150");
  constexpr int robots = 60;
  int wrong = 0;
  for (int i = 0; i < robots; ++i) {
    const std::uint64_t seed = 100 + std::uint64_t(i);
    Random random(seed, 2);
    std::string text = header;
    std::vector<Vector2d> list;
    for (int k = 0; k < (i % 2 == 0 ? 3 : 8); ++k) list.emplace_back(random.uniform(-3, 3), random.uniform(-2, 2));
    for (std::size_t k = 0; k < list.size(); ++k)
      text += row(int(k) + 1, list[k],
                  tip(list[k], truth) + std::sqrt(17) * noise * Vector2d(random.normal(), random.normal()));
    NextOptions next = options(text);
    next.seed = seed;
    next.required = 4 * noise;  // the effect alone is 4 √2 of it
    const NextPoses result = next_poses(p, next, Monitor{});
    wrong += result.verdict == NextVerdict::reached ? 1 : 0;
  }
  EXPECT_LE(wrong, 0.05 * robots);
}

TEST_F(NextPosesOfAnArm, ReachedIsSaidOfARobotWithoutAnEffectOnceReadingsShowThatThereIsNone) {
  const Problem p = problem(", candidates: 150");
  Random random(4, 1);
  std::vector<Vector2d> list;
  for (int i = 0; i < 40; ++i) list.emplace_back(random.uniform(-3, 3), random.uniform(-2, 2));
  NextOptions next = options(readings({list.begin(), list.begin() + 3}));
  next.required = 3 * noise;
  const NextPoses few = next_poses(p, next, Monitor{});
  EXPECT_EQ(few.verdict, NextVerdict::go_on);
  EXPECT_GT(*few.effect_below, 2 * noise) << "six readings and four parameters exclude no effect";
  next.text = readings(list);
  const NextPoses many = next_poses(p, next, Monitor{});
  EXPECT_EQ(many.verdict, NextVerdict::reached);
  EXPECT_LT(*many.effect_below, 3 * noise) << "the required error";
  EXPECT_THAT(next_text(many), HasSubstr("The limit includes a missing effect: these readings leave errors up to"));
}

TEST_F(NextPosesOfAnArm, DrawnCalibrationsMissByWhatIsPredicted) {
  const Problem p = problem();
  const NextPoses result = next_poses(p, options(readings(poses)), Monitor{});
  const Eigen::Matrix4d M = information(poses);
  Random random(5, 9);
  double sum = 0;
  int below = 0;
  constexpr int draws = 5000;
  for (int d = 0; d < draws; ++d) {
    Vector4d right = Vector4d::Zero();
    for (const Vector2d& q : poses)
      right += derivative(q).transpose() * Vector2d(random.normal(), random.normal()) / noise;
    const Vector4d off = M.ldlt().solve(right);
    double mean = 0;
    Eigen::Matrix<double, 6, 1> missed;
    for (std::size_t t = 0; t < tests.size(); ++t) {
      const Vector2d& q = tests[t];
      missed.segment<2>(2 * Eigen::Index(t)) = accuracy(q) * off / std::sqrt(double(tests.size()));
    }
    mean = missed.squaredNorm();
    sum += mean;
    below += std::sqrt(mean) <= *result.curve.back().upper ? 1 : 0;
  }
  EXPECT_NEAR(std::sqrt(sum / draws) / (result.expected->by_noise / std::min(1.0, result.noise)), 1, 0.03);
  EXPECT_GE(below, 0.95 * draws) << "the noise is not known to the program, so it allows for more";
}

TEST_F(NextPosesOfAnArm, AnEffectCountsAsAPlanOfTheSamePosesCountsIt) {
  const Problem p = problem(", poses: 5", ", unmodelled: {size: 2 mm, length: 40 deg}");
  NextOptions next = options(readings(poses));
  const NextPoses result = next_poses(p, next, Monitor{});
  VariantOptions wanted;
  Variant variant = make_variant(p, wanted, Monitor{});
  Configurations list;
  list.dimension = 2;
  for (const Vector2d& q : poses) list.values.insert(list.values.end(), q.begin(), q.end());
  variant.scale = Eigen::VectorXd::Ones(Eigen::Index(variant.columns.selected.size()));
  variant.test_points = test_points_of(variant, variant.columns, 0, &variant.test_places);
  allow_for_unmodelled(list, 1, variant);
  std::vector<double> each;
  const double planned =
      predicted_error(variant.test_points, effect_adjusted_evaluation(variant, list, Prior::none, 1).errors, each);
  const auto forecast = ForecastOfError(variant, {Prior::none}).after_each(rows_of(variant, list, 1));
  EXPECT_NEAR(*forecast.back() / planned, 1, 1e-9) << "the same covariance by another factorisation";
  const Eigen::MatrixXd covariance = effect_adjusted_evaluation(variant, list, Prior::none, 1).evaluation.covariance;
  const auto stated = posewright::expected_error(list, variant, list, covariance, 1);
  ASSERT_TRUE(stated && result.expected);
  EXPECT_EQ(result.expected->size, ExpectedError::Size::counted);
  EXPECT_GT(result.expected->usual().error, 1.2 * result.expected->by_noise) << "what the model lacks stays";
  EXPECT_NEAR(result.expected->usual().error / stated->usual().error, 1, 0.02) << "at the estimated values";
  EXPECT_NEAR(result.expected->by_noise / stated->by_noise, 1, 0.02);
}

TEST_F(NextPosesOfAnArm, TooFewPosesAreSaidToBeFewAndNothingMeasuredGivesTheFirst) {
  const Problem p = problem(", candidates: 200");
  NextOptions next = options("");
  next.poses = 3;
  const NextPoses first = next_poses(p, next, Monitor{});
  EXPECT_EQ(first.verdict, NextVerdict::not_determined);
  EXPECT_EQ(first.measured, 0);
  ASSERT_EQ(first.poses.size(), 3U);
  EXPECT_THAT(next_reason(first), HasSubstr("no pose is measured yet"));
  const NextPoses one = next_poses(p, options(readings({poses[0]})), Monitor{});
  EXPECT_FALSE(one.fitted);
  EXPECT_EQ(one.told, 2);
  EXPECT_EQ(*one.smallest, 2);
  EXPECT_THAT(next_reason(one), HasSubstr("1 pose is too few for a fit, 2 of 4 parameters are determined"));
}

TEST_F(NextPosesOfAnArm, ItStopsWhereTheLimitIsRequiredAndWhereTheCurveIsFlat) {
  const Problem p = problem(", candidates: 300");
  NextOptions next = options(readings(poses));
  const NextPoses open = next_poses(p, next, Monitor{});
  EXPECT_EQ(open.verdict, NextVerdict::go_on);
  next.required = 1.001 * *open.curve.back().upper;
  EXPECT_EQ(next_poses(p, next, Monitor{}).verdict, NextVerdict::reached);
  next.required = 0.999 * *open.curve.back().upper;
  EXPECT_EQ(next_poses(p, next, Monitor{}).verdict, NextVerdict::go_on) << "the expected error alone is not enough";
  // Many poses: three more are few of them.
  std::vector<Vector2d> many;
  Random random(8, 1);
  for (int i = 0; i < 250; ++i) many.emplace_back(random.uniform(-3, 3), random.uniform(-2, 2));
  const NextPoses flat = next_poses(p, options(readings(many)), Monitor{});
  EXPECT_EQ(flat.verdict, NextVerdict::flat);
  EXPECT_GT(*flat.with_three->expected, 0.98 * *flat.curve.back().expected);
}

TEST_F(NextPosesOfAnArm, EveryRequirementIsJudgedByTheDefinitionAndAllMustBeMet) {
  const Eigen::Matrix4d V = information(poses).inverse();
  Eigen::Vector2d axes = Eigen::Vector2d::Zero();
  for (const Vector2d& q : tests)
    axes = axes.cwiseMax((accuracy(q) * V * accuracy(q).transpose()).diagonal().cwiseSqrt());
  const Vector4d turn(1, 1, 0, 0);  // the tip turns by the sum of both zero positions
  const std::vector<double> expected = {axes[0], axes[1], std::sqrt(turn.dot(V * turn)), std::sqrt(V(0, 0)),
                                        std::sqrt(V(2, 2))};
  // Each larger than its limit by a thousandth, but for one that is smaller.
  std::vector<double> limits(5, 1.0);
  const auto judged = [&](std::size_t too_small) {
    std::vector<double> at = limits;
    for (std::size_t k = 0; k < at.size(); ++k) at[k] *= k == too_small ? 0.999 : 1.001;
    const Problem p =
        problem(fmt::format(", candidates: 300, require: {{position: {{x: \"{} m\", y: \"{} m\"}}, rotation: "
                            "{{z: \"{} rad\"}}, sigma: {{q1.offset: \"{} rad\", q2.x: \"{} m\"}}}}",
                            at[0], at[1], at[2], at[3], at[4]));
    return next_poses(p, options(readings(poses)), Monitor{});
  };
  const NextPoses first = judged(5);
  ASSERT_EQ(first.requirements.size(), 5U);
  const std::vector<std::string> names = {"position x", "position y", "rotation z", "sigma q1.offset", "sigma q2.x"};
  ASSERT_EQ(first.freedom, 6);
  for (std::size_t k = 0; k < 5; ++k) {
    const NextRequirement& one = first.requirements[k];
    EXPECT_EQ(one.what, names[k]);
    EXPECT_NEAR(*one.expected / expected[k], 1, 3e-3) << names[k];
    EXPECT_GT(*one.upper / *one.expected, k < 3 ? 1.96 : 1) << names[k];
    limits[k] = *one.upper;
  }
  EXPECT_EQ(judged(5).verdict, NextVerdict::reached);
  EXPECT_THAT(next_reason(judged(5)), HasSubstr("5 requirements met with 95 % confidence"));
  for (std::size_t k = 0; k < 5; ++k) {
    const NextPoses open = judged(k);
    EXPECT_EQ(open.verdict, NextVerdict::go_on) << names[k];
    EXPECT_THAT(next_reason(open), HasSubstr("1 of 5 requirements not met with 95 % confidence, worst: " + names[k]));
    EXPECT_THAT(next_text(open), HasSubstr("below with 95 %"));
  }
}

TEST_F(NextPosesOfAnArm, ARowOfAnotherRobotIsNamedByItsLine) {
  const Problem p = problem(", candidates: 200");
  std::vector<Vector2d> list = poses;
  list.insert(list.end(), candidates.begin(), candidates.end());
  std::string text = readings(list);
  EXPECT_NO_THROW(next_poses(p, options(text), Monitor{}));
  const Vector4d other(0.1, -0.2, 0.15, 0.1);
  text += row(17, {0.7, 0.9}, tip({0.7, 0.9}, other)) + row(18, {-1.2, 0.1}, tip({-1.2, 0.1}, other));
  EXPECT_THAT(message_of<InputError>([&] { next_poses(p, options(text), Monitor{}); }),
              testing::AllOf(HasSubstr("measured.csv:18: T1."), HasSubstr("from its estimate by the 16 poses before"),
                             HasSubstr("a row of another robot")));
}

TEST(WholeLines, HalfALineIsLeftUntilItHasAnEnd) {
  EXPECT_EQ(whole_lines("id,q\n1,2\n2,3").text, "id,q\n1,2\n");
  EXPECT_EQ(whole_lines("id,q\n1,2\n2,3").rest, "2,3");
  EXPECT_EQ(whole_lines("id,q\n1,2\n2,3").next_line, 3);
  EXPECT_TRUE(whole_lines("id,q\n1,2\n").has_rows);
  EXPECT_FALSE(whole_lines("# day 1\n\nid,q\n1,2").has_rows) << "the only row is half a line";
  EXPECT_EQ(whole_lines("id").text, "");
}

class NextStates : public NextPosesOfAnArm {
 protected:
  std::string refusal(const NextState& state, const Problem& p, const std::string& text) const {
    return message_of<InputError>([&] { require_continues(state, "s.json", p, "measured.csv", text); }, "accepted");
  }
};

TEST_F(NextStates, AStateComesBackFromItsFileAndSavesDrawingCandidatesAgain) {
  const Problem p = problem(", candidates: 150");
  NextOptions next = options(readings(poses));
  const NextPoses result = next_poses(p, next, Monitor{});
  const NextState state = state_after(p, next, result, std::nullopt);
  const auto file = folder_.write("s.json", next_state_text(state));
  const NextState again = *read_next_state(file);
  EXPECT_EQ(next_state_text(again), next_state_text(state));
  EXPECT_EQ(again.kept->configurations.values, result.kept->configurations.values);
  EXPECT_EQ(*again.history.back().expected, *result.curve.back().expected);
  reuse(again, p, next);
  ASSERT_EQ(next.kept, again.kept);
  const NextPoses second = next_poses(p, next, Monitor{});
  EXPECT_EQ(second.kept, again.kept) << "drawn anew";
  EXPECT_EQ(configuration(second.poses.front()), configuration(result.poses.front()));
  EXPECT_EQ(read_next_state(folder_ / "none.json"), std::nullopt);
}

TEST_F(NextStates, DataThatGrowAreGoneOnWithAndReplacedOnesRefused) {
  const Problem p = problem(", candidates: 150");
  const std::string text = readings(poses);
  NextOptions next = options(text);
  const NextState state = state_after(p, next, next_poses(p, next, Monitor{}), std::nullopt);
  EXPECT_EQ(refusal(state, p, text), "accepted");
  EXPECT_EQ(refusal(state, p, text + "6,0.1,0.2,1.9,0.4\n"), "accepted");
  EXPECT_THAT(refusal(state, p, readings(poses, 1, 2) + text),
              HasSubstr("measured.csv: differs from the file of s.json"));
  EXPECT_THAT(refusal(state, p, header), HasSubstr("it was replaced or cut"));
  const Problem other = problem(", candidates: 151");
  EXPECT_THAT(refusal(state, other, text), HasSubstr("changed"));
  Problem elsewhere = other;
  elsewhere.file = "other.yaml";
  EXPECT_THAT(refusal(state, elsewhere, text), HasSubstr("s.json: belongs to another problem"));
}

TEST_F(NextStates, ADamagedFileIsOneLine) {
  for (const char* bytes : {"{", "{\"schema\": \"posewright/next-state/1\"}", "[]", ""})
    EXPECT_THROW(read_next_state(folder_.write("s.json", bytes)), InputError) << bytes;
  std::filesystem::create_symlink("/dev/zero", folder_.path() / "device.json");
  EXPECT_THROW(read_next_state(folder_.path() / "device.json"), InputError);
  ASSERT_EQ(::mkfifo((folder_.path() / "pipe.json").c_str(), 0600), 0);
  EXPECT_THROW(read_next_state(folder_.path() / "pipe.json"), InputError) << "a pipe cannot be written anew";
}

TEST_F(NextStates, AStateWithoutCandidatesIsDamagedAndOneOfAnotherRobotIsNotUsed) {
  const Problem p = problem();
  NextState state;
  state.problem_sha256 = p.sha256;
  state.variant = p.variants.front().name;
  KeptCandidates kept;
  kept.asked = 60;
  kept.configurations.dimension = 3;
  state.kept = std::make_shared<KeptCandidates>(kept);
  EXPECT_THROW(read_next_state(folder_.write("s.json", next_state_text(state))), InputError);
  kept.configurations.values = {0.1, 0.2, 0.3};
  state.kept = std::make_shared<KeptCandidates>(kept);
  const NextState again = *read_next_state(folder_.write("s.json", next_state_text(state)));
  NextOptions next;
  next.seed = state.seed;
  reuse(again, p, next);
  EXPECT_EQ(next.kept, nullptr) << "the robot has other than three coordinates";
}

}  // namespace
}  // namespace posewright
