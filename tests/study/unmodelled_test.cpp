// A smooth effect that a variant lacks, through plan and evaluate. The second road is a planar arm whose Jacobian,
// kernel and covariance are written down here as the definitions have them, for all readings at once.

#include "posewright/study/unmodelled.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <nlohmann/json.hpp>

#include "posewright/problem/read_problem.hpp"
#include "posewright/results/plan.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/json.hpp"
#include "posewright/support/random.hpp"
#include "posewright/tasks/calibrate_problem.hpp"
#include "posewright/tasks/evaluate_problem.hpp"
#include "tests/kit/design_edits.hpp"
#include "tests/kit/example_problems.hpp"
#include "tests/kit/message_of.hpp"
#include "tests/kit/planar_arm.hpp"
#include "tests/kit/pose_lists.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

using testing::HasSubstr;
using List = std::vector<std::vector<double>>;

constexpr double sigma = 1e-4, link = 1.0, tool = 0.8;
const double sixty_degrees = std::acos(-1.0) / 3;

/// 2R arm, links 1 m and 0.8 m, x and y read with 0.1 mm.
std::string arm_with(const std::string& unmodelled, const std::string& design) {
  return "posewright: 1\nrobot: {urdf: arm.urdf}\n"
         "measurement: {type: pose, components: [x, y], device: {type: isotropic, noise: {position: 0.1 mm, rotation: "
         "1 deg}}}\nvariants:\n"
         "  plain: {parameters: [q1.offset, q2.offset, tool.x]}\n"
         "  geared: {parameters: [q1.offset, q2.offset, tool.x, q1.gear], tolerance: {'*.gear': 1e-3}}\n"
         "  short: {parameters: [q1.offset, q2.offset, tool.x]" +
         unmodelled + "}\ndesign: " + design + "\n";
}

class UnmodelledEffects : public testing::Test {
 protected:
  Problem problem(const std::string& unmodelled, const std::string& design = "{variant: short, poses: 8}") {
    folder_.write("arm.urdf", planar_arm_urdf);
    return read_problem(
        folder_.write("p.yaml", arm_with(unmodelled.empty() ? "" : ", unmodelled: " + unmodelled, design)));
  }
  static Plan judged(const Problem& problem, const List& list, const std::string& criterion = "o1") {
    DesignEdits options = DesignEdits().edit("criterion", criterion).edit("candidates", 200);
    return evaluate_problem(options.of(problem), given_poses(problem, list), {}, Monitor{}).plan;
  }
  /// Random places, q1 within ±`reach`, in places.csv.
  List written_places(std::uint64_t seed, int count, double reach) const {
    List places;
    std::string file = "q1 [rad],q2 [rad]\n";
    Random random(seed, 1);
    for (int i = 0; i < count; ++i) {
      places.push_back({2 * reach * random.uniform() - reach, 0.3 + 1.5 * random.uniform()});
      file += fmt::format("{:.17g},{:.17g}\n", places.back()[0], places.back()[1]);
    }
    folder_.write("places.csv", file);
    return places;
  }
  TemporaryFolder folder_;
};

const List eight = {{0.2, 1.1}, {-1.3, 0.7},  {1.5, -1.2}, {-0.4, 1.8},
                    {0.9, 0.5}, {-1.8, -0.9}, {0.25, 1.0}, {1.1, 1.6}};

Eigen::Matrix<double, 2, 3> jacobian(const std::vector<double>& q) {
  const double s1 = std::sin(q[0]), c1 = std::cos(q[0]), s12 = std::sin(q[0] + q[1]), c12 = std::cos(q[0] + q[1]);
  Eigen::Matrix<double, 2, 3> J;
  J << -link * s1 - tool * s12, -tool * s12, c12, link * c1 + tool * c12, tool * c12, s12;
  return J;
}

double kernel(const std::vector<double>& a, const std::vector<double>& b, double length) {
  double squares = 0;
  for (int j = 0; j < 2; ++j)
    squares += std::pow(std::cos(a[j]) - std::cos(b[j]), 2) + std::pow(std::sin(a[j]) - std::sin(b[j]), 2);
  return std::exp(-squares / (2 * length * length));
}

/// Jacobians of a list, one below the other.
Eigen::MatrixXd jacobians(const List& list) {
  Eigen::MatrixXd J(2 * list.size(), 3);
  for (std::size_t i = 0; i < list.size(); ++i) J.middleRows(2 * Eigen::Index(i), 2) = jacobian(list[i]);
  return J;
}

/// Covariances of an effect of unit size between its first axes at two lists of places.
/// @param n, m  axes of a place of `from` and of `to`
Eigen::MatrixXd kernels(const List& from, const List& to, double length, Eigen::Index n = 2, Eigen::Index m = 2) {
  Eigen::MatrixXd K(n * Eigen::Index(from.size()), m * Eigen::Index(to.size()));
  for (std::size_t i = 0; i < from.size(); ++i)
    for (std::size_t k = 0; k < to.size(); ++k)
      K.block(n * Eigen::Index(i), m * Eigen::Index(k), n, m) =
          kernel(from[i], to[k], length) * Eigen::MatrixXd::Identity(n, m);
  return K;
}

/// What generalised least squares of all readings gives, from definitions.
struct Whole {
  Eigen::MatrixXd J, inverse, V;
  double length, size;

  Whole(const List& list, double size_, double length_) : J(jacobians(list)), length(length_), size(size_) {
    inverse =
        (sigma * sigma * Eigen::MatrixXd::Identity(J.rows(), J.rows()) + size * size * kernels(list, list, length))
            .inverse();
    V = (J.transpose() * inverse * J).inverse();
  }

  /// E‖J_x(θ̂ − θ) − δ(x)‖²; the arm's plane, and the effect across it that no parameter follows.
  double square_at(const std::vector<double>& x, const List& list) const {
    const Eigen::MatrixXd cross = size * size * kernels(list, {x}, length);
    const Eigen::MatrixXd A = jacobian(x), B = A * V * J.transpose() * inverse;
    return (A * V * A.transpose()).trace() - 2 * (B * cross).trace() + 3 * size * size;
  }
};

TEST_F(UnmodelledEffects, FiguresAreThoseOfGeneralisedLeastSquaresOfAllReadings) {
  for (const auto& [text, length] :
       {std::pair{"{size: 0.2 mm}", sixty_degrees}, {"{size: 0.2 mm, length: 0.4 rad}", 0.4}}) {
    const Plan plan =
        judged(problem(text, "{variant: short, poses: 8, test_poses: {at: [[0.5, 1], [-1, 1.4]]}}"), eight);
    const Whole whole(eight, 2e-4, length);
    EXPECT_NEAR(plan.log_det, -std::log(whole.V.determinant()), 1e-7);
    for (std::size_t j = 0; j < 3; ++j)
      EXPECT_NEAR(*plan.parameters[j].sigma / std::sqrt(whole.V(Eigen::Index(j), Eigen::Index(j))), 1, 1e-6);
    const double a = whole.square_at({0.5, 1}, eight), b = whole.square_at({-1, 1.4}, eight);
    ASSERT_EQ(plan.test_errors.size(), 2u);
    EXPECT_NEAR(plan.test_errors[0] / std::sqrt(a), 1, 1e-6);
    EXPECT_NEAR(plan.test_errors[1] / std::sqrt(b), 1, 1e-6);
    ASSERT_TRUE(plan.unmodelled);
    EXPECT_NEAR(std::hypot(*plan.unmodelled->by_noise, *plan.unmodelled->by_effect) / *plan.rho0, 1, 1e-9);
    EXPECT_LT(*plan.unmodelled->interpolated, *plan.rho0);
    double sum = 0;
    for (const PlannedPose& pose : plan.poses) sum += pose.contribution;
    EXPECT_NEAR(sum, 1, 1e-9);
  }
}

TEST_F(UnmodelledEffects, ErrorByRepeatabilityIsWhatRandomVisitsMakeOfTheEstimate) {
  constexpr double visit = 3e-4, size = 2e-4;
  Problem loose = problem("{size: 0.2 mm}", "{variant: short, poses: 8, test_poses: {at: [[0.5, 1]]}}");
  loose.measurement.repeatability.translation = visit;
  const Plan plan = judged(loose, eight);
  // The estimator of all readings: weights are those of instrument, visits and effect together.
  const Whole whole(eight, size, sixty_degrees);
  const Eigen::MatrixXd covariance =
      whole.inverse.inverse() + visit * visit * Eigen::MatrixXd::Identity(whole.J.rows(), whole.J.rows());
  const Eigen::MatrixXd weights = covariance.inverse() * whole.J;
  const Eigen::MatrixXd gain = (whole.J.transpose() * weights).inverse() * weights.transpose();
  Random random(5, 1);
  double squares = 0;
  constexpr int draws = 20000;
  for (int k = 0; k < draws; ++k) {
    Eigen::VectorXd moved(whole.J.rows());
    for (double& value : moved) value = visit * random.normal();
    squares += (jacobian({0.5, 1}) * (gain * moved)).squaredNorm();
  }
  ASSERT_TRUE(plan.unmodelled);
  EXPECT_NEAR(*plan.unmodelled->by_repeatability / std::sqrt(squares / draws), 1, 0.02);
  EXPECT_LT(*plan.unmodelled->by_repeatability, *plan.unmodelled->by_noise);
  EXPECT_THAT(plan_summary(plan), testing::HasSubstr("from repeatability"));
}

TEST_F(UnmodelledEffects, InterpolationAddsNothingAtAMeasuredPoseOfANoiselessInstrumentAndMissesTheRestFarAway) {
  // An effect a thousand times the noise: at a measured pose what is read there is known, across the plane it is not.
  const Plan plan = judged(
      problem("{size: 100 mm, length: 0.3 rad}", "{variant: short, poses: 8, test_poses: {at: [[0.2, 1.1]]}}"), eight);
  EXPECT_NEAR(*plan.unmodelled->interpolated, std::sqrt(1e-2 + 2 * sigma * sigma), 1e-5);
}

/// E‖J_x(θ̂ − θ) − δ(x)‖² of plain least squares with this effect there.
double plain_square_at(const std::vector<double>& x, const List& list, double size) {
  const Whole whole(list, size, sixty_degrees);
  const Eigen::MatrixXd& J = whole.J;
  const Eigen::MatrixXd cross = size * size * kernels(list, {x}, sixty_degrees);
  const Eigen::MatrixXd B = jacobian(x) * (J.transpose() * J).inverse() * J.transpose();
  return (B * whole.inverse.inverse() * B.transpose()).trace() - 2 * (B * cross).trace() + 3 * size * size;
}

TEST_F(UnmodelledEffects, PlanWithoutOneTellsWhatAPlainFitWouldMakeOfOne) {
  const std::string places = "test_poses: {at: [[0.5, 1], [-1, 1.4]]}}";
  const Plan plan = judged(problem("", "{variant: short, poses: 8, " + places), eight);
  ASSERT_TRUE(plan.expected);
  const ExpectedError& r = *plan.expected;
  EXPECT_EQ(r.at, ExpectedError::At::test_poses);
  EXPECT_EQ(r.places, 2);
  EXPECT_FALSE(r.base_out || r.tool_out);
  EXPECT_NEAR(r.by_noise / *plan.rho0, 1, 1e-9);
  // x and y are read, z is not: as little as three axes read with √1.5 times the noise.
  EXPECT_NEAR(r.noise / (sigma * std::sqrt(1.5)), 1, 1e-9);
  ASSERT_EQ(r.with.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const double size = ExpectedError::robots[i] * r.noise;
    EXPECT_NEAR(r.with[i].size / size, 1, 1e-12);
    const double square = plain_square_at({0.5, 1}, eight, size) + plain_square_at({-1, 1.4}, eight, size);
    EXPECT_NEAR(r.with[i].error / std::sqrt(square / 2), 1, 1e-6);
  }
  EXPECT_THAT(plan_summary(plan), HasSubstr("with the effects that robots have, "));
}

TEST_F(UnmodelledEffects, FirstFigureOfAVariantWithAnEffectCountsThatOne) {
  const Plan plan =
      judged(problem("{size: 0.2 mm}", "{variant: short, poses: 8, test_poses: {at: [[0.5, 1], [-1, 1.4]]}}"), eight);
  ASSERT_TRUE(plan.expected);
  ASSERT_EQ(plan.expected->with.size(), 1u);
  EXPECT_NEAR(plan.expected->with[0].size, 2e-4, 1e-12);
  EXPECT_NEAR(plan.expected->with[0].error / *plan.rho0, 1, 1e-6);
  EXPECT_NEAR(plan.expected->by_noise / *plan.unmodelled->by_noise, 1, 1e-6);
  EXPECT_THAT(plan_summary(plan), HasSubstr("Predicted σ: from the stated noise and the unmodelled effect.\n"));
}

TEST_F(UnmodelledEffects, FirstFigureNamesTheRequiredAccuracy) {
  Plan plan = judged(problem("",
                             "{variant: short, poses: 8, require: {accuracy: 0.3 mm}, test_poses: {at: [[0.5, "
                             "1], [-1, 1.4]]}}"),
                     eight);
  EXPECT_THAT(plan_summary(plan), HasSubstr("from noise alone; required 0.3 mm\n"));
  EXPECT_THAT(plan_summary(plan), HasSubstr("Predicted σ: from the stated noise alone, for a complete model.\n"));
  plan.prior = true;
  EXPECT_THAT(plan_summary(plan),
              HasSubstr("Predicted σ: from the stated noise with tolerances as prior knowledge.\n"));
}

/// What the best base does to the places: shifts and turns about the origin, each place's share of the weight.
Eigen::MatrixXd by_base(const List& places) {
  Eigen::MatrixXd S(3 * Eigen::Index(places.size()), 6);
  for (std::size_t t = 0; t < places.size(); ++t) {
    const std::vector<double>& q = places[t];
    const Eigen::Vector3d p(link * std::cos(q[0]) + tool * std::cos(q[0] + q[1]),
                            link * std::sin(q[0]) + tool * std::sin(q[0] + q[1]), 0);
    for (int k = 0; k < 3; ++k) {
      S.block<3, 1>(3 * Eigen::Index(t), k) = Eigen::Vector3d::Unit(k);
      S.block<3, 1>(3 * Eigen::Index(t), 3 + k) = Eigen::Vector3d::Unit(k).cross(p);
    }
  }
  return S / std::sqrt(double(places.size()));
}

TEST_F(UnmodelledEffects, FirstFigureLeavesOutWhatTheBestBaseTakesUp) {
  const List places = {{0.5, 1}, {-1, 1.4}, {1.2, -0.6}, {0.1, 0.3}, {-0.7, -1.1}, {1.7, 0.2}, {-1.5, 1.9}};
  std::string at;
  for (const auto& q : places) at += fmt::format("{}[{}, {}]", at.empty() ? "" : ", ", q[0], q[1]);
  std::string text = arm_with("", "{variant: placed, poses: 8, test_poses: {at: [" + at + "]}}");
  text.insert(text.find("design:"),
              "  placed: {parameters: [q2.offset, tool.x], nuisance: [base.x, base.y, base.rz]}\n");
  folder_.write("arm.urdf", planar_arm_urdf);
  const Plan plan = judged(read_problem(folder_.write("p.yaml", text)), eight);

  const auto n = Eigen::Index(eight.size()), T = Eigen::Index(places.size());
  const double unit = sigma * std::sqrt(1.5);
  Eigen::MatrixXd J(2 * n, 5), A = Eigen::MatrixXd::Zero(3 * T, 2);
  // The first joint turns as the base does.
  J << Eigen::Matrix2d::Identity().replicate(n, 1), jacobians(eight);
  for (Eigen::Index t = 0; t < T; ++t)
    A.block<2, 2>(3 * t, 0) = jacobian(places[std::size_t(t)]).rightCols<2>() / std::sqrt(double(T));
  J /= sigma;
  const Eigen::MatrixXd V = (J.transpose() * J).inverse();
  const Eigen::MatrixXd G = (V * J.transpose()).bottomRows(2) / sigma;
  const Eigen::MatrixXd of_poses = kernels(eight, eight, sixty_degrees);
  const Eigen::MatrixXd between = kernels(eight, places, sixty_degrees, 2, 3) / std::sqrt(double(T));
  const Eigen::MatrixXd there = kernels(places, places, sixty_degrees, 3, 3) / double(T);
  const Eigen::MatrixXd S = by_base(places);
  const Eigen::MatrixXd P =
      Eigen::MatrixXd::Identity(3 * T, 3 * T) - S * S.completeOrthogonalDecomposition().pseudoInverse();
  const Eigen::MatrixXd cross = A * G * between;
  const Eigen::MatrixXd E = A * G * of_poses * G.transpose() * A.transpose() - cross - cross.transpose() + there;
  const double noise = (P * A * V.bottomRightCorner(2, 2) * A.transpose()).trace(), effect = (P * E).trace();
  ASSERT_TRUE(plan.expected);
  EXPECT_TRUE(plan.expected->base_out);
  EXPECT_NEAR(plan.expected->by_noise / std::sqrt(noise), 1, 1e-6);
  EXPECT_LT(plan.expected->by_noise, 0.9 * *plan.rho0);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(plan.expected->with[i].error / std::sqrt(noise + std::pow(ExpectedError::robots[i] * unit, 2) * effect),
                1, 1e-5);
}

TEST_F(UnmodelledEffects, CalibrationPredictsTheErrorAtNewPosesByItsResiduals) {
  // The robot is nominal but for an effect of another form than the assumed one, four times the noise.
  const Problem p = problem("", "{variant: short, poses: 8}");
  const auto effect = [](double q1, double q2) {
    return Eigen::Vector3d(4 * sigma * std::sin(q1 + 2 * q2), 4 * sigma * std::cos(2 * q1 - q2), 0);
  };
  Random random(3, 1);
  const auto place = [&] { return std::vector<double>{3.8 * random.uniform() - 1.9, 3.8 * random.uniform() - 1.9}; };
  std::string data = "id,q1 [rad],q2 [rad],pose.x [m],pose.y [m]\n";
  for (int i = 0; i < 40; ++i) {
    const std::vector<double> q = place();
    const Eigen::Vector3d moved = effect(q[0], q[1]);
    data += fmt::format("{},{:.17g},{:.17g},{:.17g},{:.17g}\n", i + 1, q[0], q[1],
                        link * std::cos(q[0]) + tool * std::cos(q[0] + q[1]) + moved.x() + sigma * random.normal(),
                        link * std::sin(q[0]) + tool * std::sin(q[0] + q[1]) + moved.y() + sigma * random.normal());
  }
  CalibrateOptions options;
  options.data = folder_.write("data.csv", data);
  options.prior = Prior::none;
  const Calibration found = calibrate_problem(p, options, Monitor{});
  const Eigen::Vector3d change = found.fit.change;
  double squares = 0;
  constexpr int judged_at = 500;
  for (int k = 0; k < judged_at; ++k) {
    const std::vector<double> q = place();
    squares += (jacobian(q) * change - effect(q[0], q[1]).head<2>()).squaredNorm();
  }
  const double observed = std::sqrt(squares / judged_at);
  ASSERT_TRUE(found.expected);
  const ExpectedError& e = *found.expected;
  EXPECT_EQ(e.size, ExpectedError::Size::measured);
  // The reading has two axes, and the effect is counted along three.
  EXPECT_NEAR(observed / (e.usual().error * std::sqrt(2.0 / 3)), 1, 0.25);
  EXPECT_LT(e.with.front().error, observed);
  EXPECT_GT(e.with.back().error, observed);
  EXPECT_LT(e.by_noise, 0.3 * observed);
}

TEST_F(UnmodelledEffects, PlanOfFewPosesSaysThatItReliesOnTheModel) {
  // Two poses that nearly look alike determine three parameters, badly.
  const Problem p = problem("", "{variant: short, poses: 2}");
  const Plan plan = judged(p, {{0.2, 1.1}, {0.3, 1.2}});
  ASSERT_TRUE(plan.expected);
  EXPECT_EQ(plan.expected->at, ExpectedError::At::candidates);
  EXPECT_GT(plan.expected->amplification, 1.5);
  EXPECT_THAT(plan_summary(plan), HasSubstr("relies on a complete model"));
  EXPECT_THAT(plan_summary(judged(p, eight)), testing::Not(HasSubstr("relies on a complete model")));
}

/// log det of the covariance that readings at `at` are predicted with from those of `list`.
double predictive_log_det(const List& at, const List& list, double size, double length) {
  const Whole known(list, size, length), there(at, size, length);
  const Eigen::MatrixXd cross = size * size * kernels(at, list, length);
  const Eigen::MatrixXd A = there.J - cross * known.inverse * known.J;
  return std::log((there.inverse.inverse() - cross * known.inverse * cross.transpose() + A * known.V * A.transpose())
                      .determinant());
}

TEST_F(UnmodelledEffects, ValidationPosesLieWhereTheFieldIsLeastCertain) {
  // An effect much larger than the noise, measured in one corner: what the plan says nothing of is elsewhere.
  const Problem p = problem("{size: 2 mm, length: 0.5 rad}", "{variant: short, poses: 8, candidates: 300}");
  List corner;
  for (int i = 0; i < 8; ++i) corner.push_back({1.0 + 0.12 * i, 1.9 - 0.1 * i});
  const Plan plan = judged(p, corner);
  const Plan validation = plan_validation(p, {}, plan, 3, Monitor{});
  List found;
  for (const PlannedPose& pose : validation.poses)
    if (!pose.measured) found.push_back({pose.configuration[0].value, pose.configuration[1].value});
  EXPECT_EQ(found.size(), 3u);
  for (const std::vector<double>& place : found)
    for (const std::vector<double>& q : corner) EXPECT_GT(std::hypot(place[0] - q[0], place[1] - q[1]), 1.0);
  EXPECT_EQ(validation.criterion, "ds");
  const double best = predictive_log_det(found, corner, 2e-3, 0.5);
  Random random(3, 1);
  for (int i = 0; i < 300; ++i) {
    List any;
    for (int k = 0; k < 3; ++k) any.push_back({random.uniform(-2, 2), random.uniform(-2, 2)});
    EXPECT_GT(best, predictive_log_det(any, corner, 2e-3, 0.5) - 0.3);
  }
}

TEST_F(UnmodelledEffects, OfNoSizeChangesNothing) {
  const std::string design = "{variant: short, poses: 8, test_poses: {at: [[0.5, 1]]}}";
  const Plan none = judged(problem("", design), eight), tiny = judged(problem("{size: 1 nm}", design), eight);
  EXPECT_FALSE(none.unmodelled);
  EXPECT_NEAR(tiny.log_det, none.log_det, 1e-7);
  EXPECT_NEAR(*tiny.rho0 / *none.rho0, 1, 1e-6);
}

TEST_F(UnmodelledEffects, BoundHoldsForEverySetOfCandidates) {
  // Seven poses of ten: all sets judged one by one, by what the search counts.
  const Problem p = problem("{size: 0.3 mm}", "{variant: short, poses: 7}");
  List ten = eight;
  ten.push_back({-0.2, -1.5});
  ten.push_back({1.9, 0.3});
  DesignEdits options;
  options.candidates_from = given_poses(p, ten);
  for (const char* criterion : {"o1", "test_pose"}) {
    options.edit("criterion", criterion);
    options.edit("method", "branch_and_bound");
    const Plan best = planned(p, options);
    options.edit("method", "auto");
    const Plan found = planned(p, options);
    EXPECT_TRUE(best.proved_optimal) << criterion;
    EXPECT_NEAR(found.criterion_value / best.criterion_value, 1, 1e-6) << criterion;
    EXPECT_TRUE(found.certificate.proved);
    EXPECT_LE(found.certificate.efficiency, 1.0);
  }
}

TEST_F(UnmodelledEffects, BiasWithoutATruthIsTheErrorOfAPlainFitAtTheCandidates) {
  const List places = written_places(7, 60, 1.0);
  const Problem p = problem("{size: 0.2 mm}", "{variant: short, poses: 8, candidates_from: places.csv}");
  DesignEdits bias = DesignEdits().edit("criterion", "bias");
  const Plan plan = evaluate_problem(bias.of(p), given_poses(p, eight), {}, Monitor{}).plan;

  constexpr double size = 2e-4;
  const Eigen::MatrixXd J = jacobians(eight), K = size * size * kernels(eight, eight, sixty_degrees);
  const Eigen::MatrixXd V = (J.transpose() * J).inverse(), takes = V * J.transpose();
  double noise = 0, all = 0;
  for (const std::vector<double>& place : places) {
    const Eigen::MatrixXd A = jacobian(place), at = size * size * kernels(eight, {place}, sixty_degrees);
    noise += sigma * sigma * (A * V * A.transpose()).trace();
    all += sigma * sigma * (A * V * A.transpose()).trace() +
           (A * takes * K * takes.transpose() * A.transpose()).trace() - 2 * (A * takes * at).trace() + 2 * size * size;
  }
  const double expected = all / 60 / (sigma * sigma);
  EXPECT_GT(all, 2 * noise) << "noise alone would do";
  // The features leave 1.4 % of the effect's variance, here 0.055 of the noise's, which is in the unit of the value.
  EXPECT_NEAR(-plan.criterion_value / expected, 1 / 1.055, 0.01);
}

TEST_F(UnmodelledEffects, BiasWithoutATruthPlansForOneThatNobodyStated) {
  const Problem p = problem("", "{variant: plain, poses: 8, candidates: 200}");
  const auto best_by = [&](const std::string& criterion) {
    DesignEdits options = DesignEdits().edit("criterion", criterion);
    options.candidates_alone = true;
    return planned(p, options);
  };
  const Plan best = best_by("bias"), determinant = best_by("o1");
  EXPECT_FALSE(best.certificate.proved);
  const auto value = [&](const Plan& plan) {
    DesignEdits bias = DesignEdits().edit("criterion", "bias");
    return evaluate_problem(bias.of(p), planned_poses(p, plan), {}, Monitor{}).plan.criterion_value;
  };
  const double here = value(best), there = value(determinant);
  EXPECT_NEAR(here / best.criterion_value, 1, 1e-6);
  EXPECT_GT(here, there);
}

TEST_F(UnmodelledEffects, BiasAddsToAListThePoseThatHelpsMostWithWhatIsMeasuredCountedOnce) {
  const List places = written_places(11, 15, 2.0);
  const Problem p = problem("{size: 1 mm}", "{variant: short, poses: 5, candidates_from: places.csv, criterion: bias}");
  EvaluateOptions options;
  options.run.measured = given_poses(p, {{1.9, 0.4}, {1.8, 0.5}, {1.7, 1.7}, {1.6, 0.6}});
  const List list(eight.begin(), eight.begin() + 4);
  const auto value_with = [&](const std::vector<double>& q) {
    List longer = list;
    longer.push_back(q);
    return evaluate_problem(p, given_poses(p, longer), options, Monitor{}).plan.criterion_value;
  };
  EvaluateOptions adding = options;
  adding.add = 1;
  const auto added = evaluate_problem(p, given_poses(p, list), adding, Monitor{}).add;
  ASSERT_TRUE(added && added->added.size() == 1);
  const auto& chosen = added->added[0].configuration;
  const double found = value_with({chosen[0].value, chosen[1].value});
  for (const std::vector<double>& place : places) EXPECT_LE(value_with(place), found + 1e-6 * std::abs(found));
}

TEST_F(UnmodelledEffects, SpreadsPosesThatADeterminantPutsIntoACorner) {
  // Without the effect poses crowd where the parameters show best; with it the second of two near ones tells little.
  const std::string design = "{variant: short, poses: 9, candidates: 300, restarts: 3, criterion: o1}";
  DesignEdits options;
  const auto nearest = [&](const Plan& plan) {
    double sum = 0;
    for (const PlannedPose& a : plan.poses) {
      double least = 10;
      for (const PlannedPose& b : plan.poses)
        if (a.id != b.id)
          least = std::min(least, std::hypot(a.configuration[0].value - b.configuration[0].value,
                                             a.configuration[1].value - b.configuration[1].value));
      sum += least;
    }
    return sum / double(plan.poses.size());
  };
  const Plan without = planned(problem("", design), options);
  const Plan with = planned(problem("{size: 0.3 mm}", design), options);
  EXPECT_GT(nearest(with), 1.5 * nearest(without));
}

TEST_F(UnmodelledEffects, FormFollowsTheNumberOfPosesUnlessACriterionIsNamed) {
  const auto criterion_of = [&](const std::string& design, const std::string& named) {
    DesignEdits options = DesignEdits().edit("criterion", named);
    const Plan plan = planned(problem("auto", design), options);
    const std::vector<std::string>& notes = plan.statistics.notes;
    return plan.criterion + (notes.empty() || !notes.back().starts_with("Criterion") ? "" : " " + notes.back());
  };
  // Three parameters, two readings a pose: two poses determine them.
  EXPECT_THAT(criterion_of("{variant: short, poses: 2, candidates: 200}", ""), HasSubstr("o1 Criterion o1, since 2"));
  EXPECT_THAT(criterion_of("{variant: short, poses: 3, candidates: 200}", ""), HasSubstr("test_pose Criterion"));
  EXPECT_EQ(criterion_of("{variant: short, poses: 3, candidates: 200}", "o1"), "o1");
  EXPECT_EQ(criterion_of("{variant: short, poses: 3, candidates: 200, criterion: o1}", ""), "o1");
}

TEST_F(UnmodelledEffects, AutoPlansByBiasFromHalfAsMuchAgainAsTheSmallestNumberAndByTheDeterminantElse) {
  const auto last_note = [](const Plan& plan) {
    return plan.statistics.notes.empty() ? "" : plan.criterion + ": " + plan.statistics.notes.back();
  };
  const auto chosen = [&](const std::string& design) {
    return last_note(planned(problem("", "{variant: plain, candidates: 100, criterion: auto, " + design + "}"), {}));
  };
  // Three parameters, two readings a pose: two poses determine them.
  EXPECT_EQ(chosen("poses: 2"), "o1: Criterion o1, since 2 poses are few where 2 determine the parameters.");
  EXPECT_THAT(chosen("poses: 3"), HasSubstr("bias: Criterion bias, since 3 poses are enough where 2 determine"));
  EXPECT_THAT(chosen("poses: 3, method: branch_and_bound"), HasSubstr("o1: Criterion o1, since method branch_and_bou"));
  EXPECT_THAT(chosen("poses: 3, truth: geared"), HasSubstr("o1: Criterion o1, since a truth is named"));
  EXPECT_THAT(chosen("poses: 3, robust: 3"), HasSubstr("o1: Criterion o1, since plans over drawn robots"));
  EXPECT_THAT(chosen("poses: auto, require: {sigma: {tool.x: 1 mm}}"), HasSubstr("o1: Criterion o1, since the number"));
  const Plan stated = planned(problem("auto", "{variant: short, candidates: 100, criterion: auto, poses: 4}"), {});
  EXPECT_THAT(last_note(stated), HasSubstr("test_pose: Criterion test_pose"));
  const Plan obeyed = planned(problem("", "{variant: plain, candidates: 100, criterion: bias, poses: 2}"), {});
  EXPECT_EQ(obeyed.criterion, "bias");
}

TEST_F(UnmodelledEffects, WithoutACriterionThePlanIsTheAutomaticOne) {
  const auto plan_of = [&](const std::string& criterion) {
    const Problem p = problem("", "{variant: plain, poses: 8, candidates: 100" + criterion + "}");
    return plan_json(planned(p, {}));
  };
  const auto poses = [&](const std::string& criterion) { return parse_json(plan_of(criterion))["poses"].dump(); };
  EXPECT_EQ(poses(""), poses(", criterion: auto"));
  EXPECT_THAT(plan_of(""), HasSubstr("Criterion bias, since 8 poses are enough where 2 determine"));
}

TEST_F(UnmodelledEffects, AnEffectOfNoSizeIsPlannedForByTheDeterminantWhichIsSaid) {
  const std::string design = "{variant: short, poses: 8, candidates: 100, restarts: 2, method: exchange}";
  Problem none = problem("{size: 1 mm}", design);
  std::find_if(none.variants.begin(), none.variants.end(), [](const VariantSpec& v) {
    return v.name == "short";
  })->unmodelled->size = 0.0;
  DesignEdits o1 = DesignEdits().edit("criterion", "o1");
  const Problem plain = problem("", design);
  const Plan chosen = planned(none, {}), plan = planned(plain, o1);
  EXPECT_EQ(chosen.statistics.notes.back(), "Criterion o1, since the unmodelled effect has size 0.");
  EXPECT_GT(judged(plain, planned_poses(plain, chosen).configurations).log_det, plan.log_det - 0.05);
}

TEST_F(UnmodelledEffects, AutoIsThePlanOfTheCriterionThatItNames) {
  const auto values = [&](const std::string& criterion, int poses) {
    DesignEdits options = DesignEdits().edit("criterion", criterion).edit("poses", poses);
    const Problem p = problem("", "{variant: plain, poses: 8, candidates: 100, restarts: 2, method: exchange}");
    return planned_poses(p, planned(p, options)).configurations;
  };
  EXPECT_EQ(values("auto", 8), values("bias", 8));
  EXPECT_EQ(values("auto", 2), values("o1", 2));
  EXPECT_NE(values("o1", 8), values("bias", 8));
}

TEST_F(UnmodelledEffects, SizeAutoIsTheNoiseOrWhatOtherVariantsEstimate) {
  // Of q1.gear 1e-3, what offsets and the tool leave; a file without that variant has nothing but the noise.
  const Plan geared = judged(problem("auto"), eight);
  EXPECT_TRUE(geared.unmodelled->size_assumed);
  EXPECT_GT(geared.unmodelled->size, 1e-4);
  EXPECT_LT(geared.unmodelled->size, 2e-3);
  Problem alone = problem("auto");
  std::erase_if(alone.variants, [](const VariantSpec& v) { return v.name == "geared"; });
  // x and y are read, z is not: √(3/2) of the noise as a displacement in three directions.
  EXPECT_NEAR(judged(alone, eight).unmodelled->size, std::sqrt(1.5) * sigma, 1e-12);
}

TEST_F(UnmodelledEffects, FilesStateThemAndTheEvaluationOfAPlanRepeatsThem) {
  const Problem p = problem("{size: 0.3 mm}", "{variant: short, poses: 6, candidates: 200, restarts: 2}");
  const Plan plan = plan_problem(p, {}, Monitor{});
  EvaluateOptions options;
  const Plan again = evaluate_problem(p, planned_poses(p, plan), options, Monitor{}).plan;
  EXPECT_NEAR(again.log_det, plan.log_det, 1e-9);
  EXPECT_NEAR(*again.rho0 / *plan.rho0, 1, 1e-9);
  EXPECT_NEAR(again.criterion_value / plan.criterion_value, 1, 1e-9);
  const auto json = parse_json(plan_json(plan));
  EXPECT_EQ(json["unmodelled"]["size"], 3e-4);
  EXPECT_EQ(json["unmodelled"]["features"], plan.unmodelled->features);
}

TEST_F(UnmodelledEffects, WhatCannotBeIsToldInOneLine) {
  const auto message = [&](const std::string& unmodelled) -> std::string {
    return message_of([&] { judged(problem(unmodelled), eight); });
  };
  EXPECT_THAT(message("{size: 0 mm}"), HasSubstr("p.yaml:7: variants.short.unmodelled.size"));
  EXPECT_THAT(message("{size: -1 mm}"), HasSubstr("unmodelled.size"));
  EXPECT_THAT(message("{length: 0 deg}"), HasSubstr("unmodelled.length"));
  EXPECT_THAT(message("{size: 0.1 deg}"), HasSubstr("unmodelled.size"));
  EXPECT_THAT(message("smooth"), HasSubstr("auto, or {size"));
  EXPECT_THAT(message("{width: 1 mm}"), HasSubstr("width"));
}

TEST(UnmodelledEffect, OfAllLengthsThatTheParametersTakeUpIsRefused) {
  // Base and tool of an arm whose pose is read follow what is the same everywhere.
  Problem problem = example("real_data/rosi_positioner/problem.yaml");
  problem.variants.front().unmodelled = UnmodelledSpec{1e-3, 100.0, 0.0, 7};
  problem.design.candidates.value = 200;
  EXPECT_THAT(message_of<InputError>(
                  [&] { evaluate_problem(problem, given_poses(problem, list_of(problem, 10)), {}, Monitor{}); }),
              HasSubstr("problem.yaml:7: an unmodelled effect with a length of"));
}

TEST(UnmodelledEffect, WithoutATipInTheReadingsIsNoneThatAutoPlansFor) {
  Problem problem = example("kr270/compensator_geometry.yaml");
  DesignEdits options = DesignEdits().edit("criterion", "auto").edit("candidates", 100);
  const Plan plan = planned(problem, options);
  EXPECT_EQ(plan.criterion, "o1");
  EXPECT_EQ(plan.statistics.notes.back(),
            "Criterion o1, since the readings contain no tip position that an effect could move.");
}

TEST(UnmodelledEffect, IsRefusedWhereNoTipIsSeen) {
  Problem problem = example("kr270/compensator_geometry.yaml");
  problem.variants.front().unmodelled = UnmodelledSpec{};
  DesignEdits options = DesignEdits().edit("candidates", 100);
  EXPECT_THROW(planned(problem, options), CannotDo);
}

TEST(UnmodelledEffect, OfAnglesAloneIsNeitherExpectedNorAccepted) {
  Problem problem = example("instruments/level.yaml");
  DesignEdits options = DesignEdits().edit("candidates", 60).edit("method", "exchange");
  const Plan plan = planned(problem, options);
  // Effects come in multiples of the noise of a position, which no reading has.
  EXPECT_FALSE(plan.expected.has_value());
  EXPECT_EQ(plan_json(plan).find("nan"), std::string::npos);
  for (const UnmodelledSpec& spec : {UnmodelledSpec{{}, {}, 0.0, 14}, UnmodelledSpec{1e-4, 0.5, 0.0, 14}}) {
    problem.variants.front().unmodelled = spec;
    EXPECT_THAT(message_of<InputError>([&] { planned(problem, options); }),
                HasSubstr("level.yaml:14: an unmodelled effect displaces the tip"));
  }
}

}  // namespace
}  // namespace posewright
