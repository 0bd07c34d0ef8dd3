// Instruments that read one visit. The second roads: formulas of a planar arm with the covariance of the visit by its
// definition, two instruments of a kind, and central differences of what is read.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <numeric>

#include "posewright/model/model_factory.hpp"
#include "tests/kit/example_problems.hpp"
#include "tests/kit/message_of.hpp"
#include "tests/kit/planar_instruments.hpp"
#include "tests/kit/virtual_data.hpp"

namespace posewright {
namespace {

constexpr const char* together_example = "instruments/read_together.yaml";

std::string planar_together(const std::string& gauge_keys) {
  return replaced_once(planar_problem, "noise: 10 um}}\n",
                       "noise: 10 um}" + gauge_keys + "}\n  - {name: both, together: [tracker, gauge]}\n");
}

/// Gᵀ Σ⁻¹ G of the parameters at q.
Eigen::MatrixXd information_at(const IdentificationModel& model, const std::vector<double>& q,
                               const std::vector<int>& selected) {
  Linearisation at;
  EXPECT_TRUE(model.linearise(q, {}, selected, at));
  return at.G.transpose() * at.covariance.llt().solve(at.G);
}

std::vector<int> parameters_named(const IdentificationModel& model, const std::vector<std::string>& names) {
  std::vector<int> indices;
  for (const std::string& name : names) indices.push_back(parameter_index(model, name));
  return indices;
}

const std::vector<std::string> arm_errors = {"q1.offset", "q2.offset", "q2.x"};

TEST(ReadTogether, TheVisitsDisplacementIsCommonToAll) {
  const Planar planar(planar_together(", repeatability: 30 um"));
  const auto model = make_model(planar.problem);
  for (const auto& joints : {std::pair(0.3, 0.8), std::pair(-1.2, 1.4), std::pair(0.9, -0.7)}) {
    const double q1 = joints.first, q2 = joints.second;
    // Rows of the tracker and the gauge, m, with errors x of the arm and a displacement e of the tip.
    const auto rows = [&](const Eigen::Vector3d& x, const Eigen::Vector2d& e) {
      Eigen::Vector3d y;
      y << PlanarReadings::point(x, q1, q2, {0.05, 0.02}) + e,
          (PlanarReadings::point(x, q1, q2, {0.1, 0}) + e - Eigen::Vector2d(2, 1.5)).norm();
      return y;
    };
    constexpr double h = 1e-5;
    Eigen::Matrix3d J;
    Eigen::Matrix<double, 3, 2> A;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d step = h * Eigen::Vector3d::Unit(k);
      J.col(k) = (rows(step, {0, 0}) - rows(-step, {0, 0})) / (2 * h);
    }
    for (int k = 0; k < 2; ++k) {
      const Eigen::Vector2d step = h * Eigen::Vector2d::Unit(k);
      A.col(k) = (rows({0, 0, 0}, step) - rows({0, 0, 0}, -step)) / (2 * h);
    }
    const Eigen::Vector3d noise(20e-6, 20e-6, 10e-6);
    const Eigen::Matrix3d covariance =
        Eigen::Matrix3d(noise.array().square().matrix().asDiagonal()) + 9e-10 * A * A.transpose();
    const Eigen::Matrix3d expected = J.transpose() * covariance.inverse() * J;
    const Eigen::MatrixXd found = information_at(*model, {q1, q2, 2}, parameters_named(*model, arm_errors));
    EXPECT_LT((found - expected).norm(), 1e-8 * expected.norm());
  }
}

TEST(ReadTogether, TwoOfAKindTellNoMoreOfAVisitThanOne) {
  const std::string one =
      "type: position, target: [0.05, 0.02, 0], components: [x, y], device: {type: isotropic, noise: ";
  const auto list = [&](const std::string& noise, const std::string& repeatability) {
    const std::string kind = one + noise + "}, repeatability: " + repeatability + "}\n";
    return "posewright: 1\nrobot: {urdf: arm.urdf}\nmeasurement:\n  - {name: a, " + kind + "  - {name: b, " + kind +
           "  - {name: both, together: [a, b]}\nvariants: {arm: {parameters: [q1.offset, q2.offset]}}\n";
  };
  const auto ratio = [&](const std::string& noise, const std::string& repeatability) {
    const Planar planar(list(noise, repeatability));
    const auto model = make_model(planar.problem);
    const std::vector<int> selected = parameters_named(*model, {"q1.offset", "q2.offset"});
    return information_at(*model, {0.4, 0.9, 2}, selected).trace() /
           information_at(*model, {0.4, 0.9, 0}, selected).trace();
  };
  EXPECT_NEAR(ratio("1 nm", "30 um"), 1.0, 1e-6);  // both see the same wrong place
  EXPECT_NEAR(ratio("30 um", "0 um"), 2.0, 1e-12);
}

TEST(ReadTogether, ColumnsAreThoseOfDifferences) {
  const Problem problem = example(together_example);
  const auto model = make_model(problem);
  std::vector<int> all(model->parameters().size());
  std::iota(all.begin(), all.end(), 0);
  Random random(3, 1);
  int done = 0;
  for (int tries = 0; done < 5 && tries < 20000; ++tries) {
    std::vector<double> q = random_configuration(*model, random);
    q.back() = 2;
    if (!model->measurable(q)) continue;
    ++done;
    Linearisation at;
    ASSERT_TRUE(model->linearise(q, {}, all, at));
    Eigen::VectorXd ends[2], change;
    for (const int i : all) {
      constexpr double h = 1e-6;
      std::vector<double> correction(all.size());
      for (const int side : {0, 1}) {
        correction[std::size_t(i)] = side == 0 ? -h : h;
        ASSERT_TRUE(model->predict(q, correction, ends[side]));
      }
      model->difference(ends[1], ends[0], change);
      EXPECT_LT((change / (2 * h) - at.G.col(i)).norm(), 1e-6 * std::max(1.0, at.G.col(i).norm()))
          << model->parameters()[std::size_t(i)].name;
    }
  }
  EXPECT_EQ(done, 5);
}

TEST(ReadTogether, RowsAndParametersAreThoseOfTheMembers) {
  const Planar alone, with(planar_together(", repeatability: 30 um"));
  const auto list = make_model(alone.problem), together = make_model(with.problem);
  ASSERT_EQ(list->parameters().size(), together->parameters().size());
  for (std::size_t i = 0; i < list->parameters().size(); ++i)
    EXPECT_EQ(list->parameters()[i].name, together->parameters()[i].name);
  EXPECT_EQ(list->rows(), together->rows());
  Eigen::VectorXd y;
  ASSERT_TRUE(together->predict(std::vector<double>{0.3, 0.8, 2}, {}, y));
  EXPECT_TRUE(y.allFinite());
}

TEST(ReadTogether, ToolAndTargetsThatStandForItDoNotMix) {
  const std::string text = replaced_once(
      planar_together(", repeatability: 30 um"), "together: [tracker, gauge]",
      "type: pose, device: {type: isotropic, noise: {position: 1 um, rotation: 1 urad}}, repeatability: 30 um}\n"
      "  - {name: three, together: [tracker, both]");
  const Planar planar(text);
  EXPECT_THAT(message_of<std::runtime_error>([&] { make_model(planar.problem); }),
              testing::HasSubstr("cannot read together"));
}

}  // namespace
}  // namespace posewright
