// A robot that is known by its poses: Jacobians of a fixed instrument and of one on the hand against automatic
// differentiation of X_MeasureTip = base · Δbase · pose · tool · Δtool.

#include "posewright/model/given_poses.hpp"

#include <gtest/gtest.h>

#include "posewright/model/model_factory.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/support/error.hpp"
#include "tests/kit/jets.hpp"

namespace posewright {
namespace {

template <class T>
using Matrix4 = Eigen::Matrix<T, 4, 4>;

/// Trans(x, y, z) Rz(rz) Ry(ry) Rx(rx), written out.
template <class T>
Matrix4<T> displacement(const std::array<T, 6>& d) {
  using std::cos, std::sin;
  const T cx = cos(d[3]), sx = sin(d[3]), cy = cos(d[4]), sy = sin(d[4]), cz = cos(d[5]), sz = sin(d[5]);
  Matrix4<T> X;
  X << cz * cy, cz * sy * sx - sz * cx, cz * sy * cx + sz * sx, d[0],  //
      sz * cy, sz * sy * sx + cz * cx, sz * sy * cx - cz * sx, d[1],   //
      -sy, cy * sx, cy * cx, d[2],                                     //
      T(0.0), T(0.0), T(0.0), T(1.0);
  return X;
}

template <class T>
Matrix4<T> inverse(const Matrix4<T>& X) {
  Matrix4<T> Y = X;
  Y.template block<3, 3>(0, 0) = X.template block<3, 3>(0, 0).transpose();
  Y.template block<3, 1>(0, 3) = -Y.template block<3, 3>(0, 0) * X.template block<3, 1>(0, 3);
  return Y;
}

std::string problem_text(const std::string& mount) {
  return "posewright: 1\n"
         "robot: {poses: yes, placement: {position: [0.4, -0.2, 0.1], rpy: [0.3, -0.5, 2]},\n"
         "  tool: {position: [0.05, 0.02, 0.11], rpy: [-1, 0.4, 0.2]}}\n"
         "measurement: {type: pose, mount: " +
         mount +
         ", device: {type: isotropic, noise: {position: 1 mm, rotation: 1 mrad}}}\n"
         "variants: {all: {parameters: [\"base.*\", \"tool.*\"]}}\n"
         "workspace: {pose: {x: [0, 1], y: [-1, 1], z: [0, 1], roll: [2, 4], pitch: [-1.4, 1.4], yaw: [-3, 3]}}\n";
}

class Mount : public testing::TestWithParam<bool> {};

TEST_P(Mount, JacobianEqualsAutomaticDifferentiation) {
  const bool on_hand = GetParam();
  const auto model = make_model(parse_problem(problem_text(on_hand ? "hand" : "fixed"), "p.yaml"));
  const auto base = displacement<double>({0.4, -0.2, 0.1, 0.3, -0.5, 2});
  const auto tool = displacement<double>({0.05, 0.02, 0.11, -1, 0.4, 0.2});
  const auto rows_at = [&](const std::vector<double>& q, const std::vector<Jet>& correction) {
    std::array<Jet, 6> of_base, of_tool, pose;
    for (std::size_t k = 0; k < 6; ++k) of_base[k] = correction[k], of_tool[k] = correction[k + 6], pose[k] = Jet(q[k]);
    const Matrix4<Jet> X =
        base.cast<Jet>() * displacement(of_base) * displacement(pose) * tool.cast<Jet>() * displacement(of_tool);
    const Matrix4<Jet> Y = on_hand ? inverse(X) : X;
    Eigen::Matrix<Jet, 3, 3> R;
    for (int i = 0; i < 9; ++i) R(i / 3, i % 3) = Jet(Y(i / 3, i % 3).a);
    // The antisymmetric part of R R₀ᵀ has the rotation vector as its derivative.
    const Eigen::Matrix<Jet, 3, 3> D = Y.block<3, 3>(0, 0) * R.transpose();
    return std::vector<Jet>{
        Y(0, 3), Y(1, 3), Y(2, 3), 0.5 * (D(2, 1) - D(1, 2)), 0.5 * (D(0, 2) - D(2, 0)), 0.5 * (D(1, 0) - D(0, 1))};
  };
  for (const double size : {0.0, 5.0}) EXPECT_LT(worst_model_error(*model, 1000, size, 7, rows_at), 1e-9) << size;
  Eigen::VectorXd y;
  const std::vector<double> q{0.3, 0.1, 0.5, 3.3, 0.2, -1};
  ASSERT_TRUE(model->predict(q, {}, y));
  const std::vector<Jet> rows = rows_at(q, std::vector<Jet>(12, Jet(0.0)));
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(y[k], rows[std::size_t(k)].a, 1e-14);
}

INSTANTIATE_TEST_SUITE_P(GivenPoses, Mount, testing::Bool(),
                         [](const auto& info) { return info.param ? "hand" : "fixed"; });

TEST(GivenPoses, NeedTheRangesThatPosesAreProposedIn) {
  const std::string text = problem_text("hand");
  try {
    parse_problem(text.substr(0, text.find("workspace")), "p.yaml");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).substr(0, 51), "p.yaml:2: robot with poses alone has no limits; wor");
  }
}

}  // namespace
}  // namespace posewright
