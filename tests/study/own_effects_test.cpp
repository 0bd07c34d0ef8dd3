// Smooth effects that instruments of a list have for themselves. The second road is a planar arm read by two
// instruments, whose Jacobian, kernel and covariance are written down here as the definitions have them.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "posewright/problem/read_problem.hpp"
#include "posewright/results/plan.hpp"
#include "posewright/support/random.hpp"
#include "posewright/tasks/calibrate_problem.hpp"
#include "posewright/tasks/evaluate_problem.hpp"
#include "tests/kit/design_edits.hpp"
#include "tests/kit/planar_arm.hpp"
#include "tests/kit/pose_lists.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright::own_effects_test {
namespace {

using List = std::vector<std::vector<double>>;

constexpr double sigma = 1e-4, link = 1.0, tool = 0.8, of_robot = 0.2e-3, of_first = 0.5e-3;
const double length = std::acos(-1.0) / 3;

class OwnEffects : public testing::Test {
 protected:
  Problem problem(const std::string& own, const std::string& robot = "0.2 mm") {
    folder_.write("arm.urdf", planar_arm_urdf);
    const std::string device =
        "type: pose, components: [x, y], device: {type: isotropic, noise: {position: 0.1 mm, rotation: 1 deg}}";
    return read_problem(folder_.write(
        "p.yaml",
        "posewright: 1\nrobot: {urdf: arm.urdf}\nmeasurement:\n  - {name: a, " + device + own + "}\n  - {name: b, " +
            device +
            "}\nvariants: {v: {parameters: [q1.offset, q2.offset, tool.x], unmodelled: {length: 60 deg, size: " +
            robot + "}}}\ndesign: {poses: 8, criterion: o1, test_poses: {at: [[0.5, 1], [-1, 1.4]]}}\n"));
  }
  TemporaryFolder folder_;
};

Eigen::Matrix<double, 2, 3> jacobian(const std::vector<double>& q) {
  const double s1 = std::sin(q[0]), c1 = std::cos(q[0]), s12 = std::sin(q[0] + q[1]), c12 = std::cos(q[0] + q[1]);
  Eigen::Matrix<double, 2, 3> J;
  J << -link * s1 - tool * s12, -tool * s12, c12, link * c1 + tool * c12, tool * c12, s12;
  return J;
}

double kernel(const std::vector<double>& a, const std::vector<double>& b) {
  double squares = 0;
  for (std::size_t j = 0; j < 2; ++j)
    squares += std::pow(std::cos(a[j]) - std::cos(b[j]), 2) + std::pow(std::sin(a[j]) - std::sin(b[j]), 2);
  return std::exp(-squares / (2 * length * length));
}

/// Covariance of what moves the readings smoothly; a pose's last number is its instrument.
Eigen::MatrixXd smooth(const List& list, double robot) {
  const auto n = Eigen::Index(list.size());
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index k = 0; k < n; ++k) {
      const std::vector<double>&a = list[std::size_t(i)], &b = list[std::size_t(k)];
      const double own = a[2] == 0 && b[2] == 0 ? of_first * of_first : 0.0;
      K.block<2, 2>(2 * i, 2 * k) = (robot * robot + own) * kernel(a, b) * Eigen::Matrix2d::Identity();
    }
  return K;
}

const List ten = {{0.2, 1.1, 0}, {-1.3, 0.7, 1},  {1.5, -1.2, 0}, {-0.4, 1.8, 1}, {0.9, 0.5, 0},
                  {0.9, 0.5, 1}, {-1.8, -0.9, 0}, {0.25, 1, 1},   {1.1, 1.6, 0},  {-0.6, -1.4, 1}};

TEST_F(OwnEffects, FiguresAreThoseOfGeneralisedLeastSquaresOfAllReadings) {
  DesignEdits options = DesignEdits().edit("candidates", 200);
  const Problem p = problem(", unmodelled: 0.5 mm");
  const Plan plan = evaluate_problem(options.of(p), given_poses(p, ten), {}, Monitor{}).plan;
  const auto n = Eigen::Index(ten.size());
  Eigen::MatrixXd J(2 * n, 3), covariance = smooth(ten, of_robot);
  covariance.diagonal().array() += sigma * sigma;
  for (Eigen::Index i = 0; i < n; ++i) J.middleRows(2 * i, 2) = jacobian(ten[std::size_t(i)]);
  const Eigen::MatrixXd inverse = covariance.inverse(), V = (J.transpose() * inverse * J).inverse();
  EXPECT_NEAR(plan.log_det, -std::log(V.determinant()), 1e-7);
  for (std::size_t j = 0; j < 3; ++j)
    EXPECT_NEAR(*plan.parameters[j].sigma / std::sqrt(V(Eigen::Index(j), Eigen::Index(j))), 1, 1e-6);
  // The robot misses a place by its own effect alone, which is in the readings of both.
  const auto error_at = [&](const std::vector<double>& x) {
    Eigen::MatrixXd cross(J.rows(), 2);
    for (std::size_t i = 0; i < ten.size(); ++i)
      cross.middleRows(2 * Eigen::Index(i), 2) = of_robot * of_robot * kernel(ten[i], x) * Eigen::Matrix2d::Identity();
    const Eigen::MatrixXd A = jacobian(x), B = A * V * J.transpose() * inverse;
    return std::sqrt((A * V * A.transpose()).trace() - 2 * (B * cross).trace() + 3 * of_robot * of_robot);
  };
  ASSERT_EQ(plan.test_errors.size(), 2U);
  EXPECT_NEAR(plan.test_errors[0] / error_at({0.5, 1}), 1, 1e-6);
  EXPECT_NEAR(plan.test_errors[1] / error_at({-1, 1.4}), 1, 1e-6);
}

/// Over drawn effects of the robot and of instrument a.
TEST_F(OwnEffects, CalibrationIsByTheCovarianceOfAllReadingsAndItsIntervalsCoverTheTruth) {
  constexpr int runs = 80;
  Random random(8, 2);
  List list;
  for (int i = 0; i < 24; ++i)
    list.push_back({3.6 * random.uniform() - 1.8, 3.6 * random.uniform() - 1.8, double(i % 2)});
  Eigen::MatrixXd K = smooth(list, of_robot);
  K.diagonal().array() += sigma * sigma;
  const Eigen::MatrixXd L = K.llt().matrixL();
  Eigen::MatrixXd J(L.rows(), 3);
  for (std::size_t i = 0; i < list.size(); ++i) J.middleRows(2 * Eigen::Index(i), 2) = jacobian(list[i]);
  const Eigen::MatrixXd V = (J.transpose() * K.ldlt().solve(J)).inverse(),
                        estimator = V * (K.ldlt().solve(J)).transpose();
  const Problem stated = problem(", unmodelled: 0.5 mm");
  int covered = 0, all = 0;
  for (int run = 0; run < runs; ++run) {
    Eigen::VectorXd off(L.rows());
    for (double& value : off) value = random.normal();
    off = L * off;
    std::string data = "id,instrument,q1 [rad],q2 [rad],a.pose.x [m],a.pose.y [m],b.pose.x [m],b.pose.y [m]\n";
    for (std::size_t i = 0; i < list.size(); ++i) {
      const std::vector<double>& q = list[i];
      const std::string read = fmt::format(
          "{:.17g},{:.17g}", link * std::cos(q[0]) + tool * std::cos(q[0] + q[1]) + off[2 * Eigen::Index(i)],
          link * std::sin(q[0]) + tool * std::sin(q[0] + q[1]) + off[2 * Eigen::Index(i) + 1]);
      data += fmt::format("{},{},{:.17g},{:.17g},{},{}\n", i + 1, q[2] == 0 ? "a" : "b", q[0], q[1],
                          q[2] == 0 ? read : ",", q[2] == 0 ? "," : read);
    }
    CalibrateOptions options;
    options.data = folder_.write("data.csv", data);
    options.prior = Prior::none;
    const Calibration found = calibrate_problem(stated, options, Monitor{});
    const Eigen::Vector3d expected = estimator * off;
    ASSERT_EQ(found.parameters.size(), 3U);
    for (Eigen::Index j = 0; j < 3; ++j) {
      const CalibratedParameter& one = found.parameters[std::size_t(j)];
      EXPECT_NEAR(one.value - one.label.nominal, expected[j], 0.02 * std::sqrt(V(j, j))) << one.label.name;
    }
    for (const CalibratedParameter& one : found.parameters)
      covered += int(std::abs(one.value - one.label.nominal) <= 1.96 * one.sigma);
    all += 3;
  }
  EXPECT_GT(double(covered) / all, 0.90);
  EXPECT_LT(double(covered) / all, 0.99);
}

}  // namespace
}  // namespace posewright::own_effects_test
