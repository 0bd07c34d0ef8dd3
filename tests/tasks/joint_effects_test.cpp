// What joints do beside what they read: by its definition, shifted readings of the plain arm.

#include "posewright/model/joint_effects.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "posewright/lists/measured_data.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/model/variant_columns.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/support/error.hpp"
#include "posewright/tasks/calibrate_problem.hpp"
#include "tests/kit/example_problems.hpp"
#include "tests/kit/message_of.hpp"
#include "tests/kit/temporary_folder.hpp"
#include "tests/kit/virtual_data.hpp"

namespace posewright {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr double ratio = 100;

JointEffectsSpec all_effects(const std::string& joint, const std::string& other) {
  return {{joint, 1}, true, ratio, {{other, 1}}, true, {}, true};
}

Problem with_effects(Problem problem, const std::vector<JointEffectsSpec>& effects) {
  std::get<SerialArmSpec>(problem.robot).joint_effects = effects;
  if (effects.front().temperature)
    std::get<SerialArmSpec>(problem.robot).temperature = TemperatureSpec{20.0, {18.0, 20.0, 25.0}};
  return problem;
}

/// What all_effects("joint_a2", "joint_a1") and their coefficients add to joint 2, by hand.
double added(const std::vector<double>& c, double q2, double q1, bool rising, double temperature) {
  return (rising ? -c[7] / 2 : c[7] / 2) + c[8] * (temperature - 20) + c[0] * std::cos(q2) + c[1] * std::sin(q2) +
         c[2] * std::cos(2 * q2) + c[3] * std::sin(2 * q2) + c[4] * std::cos(ratio * q2) + c[5] * std::sin(ratio * q2) +
         c[6] * q1;
}

const std::vector<std::string> names = {"joint_a2.cos1",
                                        "joint_a2.sin1",
                                        "joint_a2.cos2",
                                        "joint_a2.sin2",
                                        "joint_a2.cos_g",
                                        "joint_a2.sin_g",
                                        "joint_a2.coupling.joint_a1",
                                        "joint_a2.backlash",
                                        "joint_a2.temperature"};

TEST(JointEffects, ReadingsAreThoseOfThePlainArmWithTheJointTurnedByHand) {
  for (const char* variant : {"geometric", "denavit_hartenberg"}) {
    const Problem plain = example("kr270/problem.yaml");
    const auto without = make_model({plain, find_variant(plain, variant)});
    const Problem effects = with_effects(plain, {all_effects("joint_a2", "joint_a1")});
    const auto with = make_model({effects, find_variant(effects, variant)});
    ASSERT_EQ(with->parameters().size(), without->parameters().size() + names.size());
    const std::vector<double> c = {2e-3, -1e-3, 5e-4, 7e-4, 3e-4, -2e-4, 1e-3, 4e-4, 2e-5};
    std::vector<double> correction(with->parameters().size(), 0.0);
    for (std::size_t k = 0; k < c.size(); ++k) correction[std::size_t(parameter_index(*with, names[k]))] = c[k];
    Random random(3, 1);
    for (int i = 0; i < 20; ++i) {
      std::vector<double> q = random_configuration(*with, random);
      Eigen::VectorXd expected, found;
      ASSERT_TRUE(with->predict(q, correction, found));
      ASSERT_EQ(with->coordinates()[6].name, "temperature");
      ASSERT_EQ(with->coordinates()[7].name, "joint_a2.approach");
      q[1] += added(c, q[1], q[0], with->coordinates()[7].label_at(q[7]) == "rising", q[6]);
      q.resize(6);
      ASSERT_TRUE(without->predict(q, {}, expected));
      EXPECT_LT((found - expected).norm(), 1e-12 * expected.norm()) << variant;
    }
  }
}

std::vector<Problem> arms() {
  return {with_effects(example("kr270/problem.yaml"), {all_effects("joint_a2", "joint_a1")}),
          with_effects(example("kr270/elastostatic.yaml"), {all_effects("joint_a2", "joint_a1")})};
}

TEST(JointEffects, ColumnsAreTheDifferencesOfReadings) {
  for (const Problem& problem : arms()) {
    const auto model = make_model(problem);
    const std::size_t count = model->parameters().size();
    std::vector<int> all(count);
    std::iota(all.begin(), all.end(), 0);
    Random random(5, 1);
    Linearisation out;
    Eigen::VectorXd above, below;
    for (int i = 0; i < 5; ++i) {
      const std::vector<double> q = random_configuration(*model, random);
      std::vector<double> correction(count);
      for (std::size_t j = 0; j < count; ++j) correction[j] = model->parameters()[j].tolerance * random.normal();
      ASSERT_TRUE(model->linearise(q, correction, all, out));
      for (std::size_t j = 0; j < count; ++j) {
        // A drift of a hundredth of its tolerance drowns in the rounding of metres.
        const double share = model->parameters()[j].name.ends_with(".temperature") ? 0.2 : 1e-2;
        const double h = share * model->parameters()[j].tolerance;
        std::vector<double> moved = correction;
        moved[j] += h;
        ASSERT_TRUE(model->predict(q, moved, above));
        moved[j] -= 2 * h;
        ASSERT_TRUE(model->predict(q, moved, below));
        const Eigen::VectorXd expected = (above - below) / (2 * h);
        EXPECT_LT((out.G.col(Eigen::Index(j)) - expected).norm(), 1e-6 * (1e-3 + expected.norm()))
            << model->parameters()[j].name;
      }
    }
  }
}

TEST(JointEffects, ReadingsMoveTheTipWithWhatTheirEffectsAdd) {
  Problem problem = arms().front();
  const auto model = make_model(problem);
  for (const std::string& name : names) model->set_nominal(parameter_index(*model, name), 0.02);
  Random random(7, 1);
  Eigen::Matrix<double, 6, Eigen::Dynamic> twists;
  for (int i = 0; i < 5; ++i) {
    const std::vector<double> q = random_configuration(*model, random);
    ASSERT_TRUE(model->reading_twists(q, twists));
    for (std::size_t j = 0; j < 6; ++j) {
      constexpr double h = 1e-6;
      std::vector<double> a = q, b = q;
      a[j] += h;
      b[j] -= h;
      const Eigen::Isometry3d X = model->tool_pose(q), A = model->tool_pose(a), B = model->tool_pose(b);
      const Eigen::Vector3d moved = (A.translation() - B.translation()) / (2 * h);
      const Eigen::Vector3d w = twists.col(Eigen::Index(j)).tail<3>();
      EXPECT_LT((twists.col(Eigen::Index(j)).head<3>() + w.cross(X.translation()) - moved).norm(), 1e-6);
      const Eigen::Matrix3d W = (A.linear() - B.linear()) * X.linear().transpose() / (2 * h);
      EXPECT_LT((Eigen::Vector3d(W(2, 1), W(0, 2), W(1, 0)) - w).norm(), 1e-6);
    }
  }
}

TEST(JointEffects, EccentricityAndHarmonicGearAreFoundInReadingsOfAnArmThatHasThem) {
  // 30 arc seconds at 1:100, and an encoder 20 µm off its axis at 50 mm.
  constexpr double gear = 30.0 / 3600 * M_PI / 180, eccentric = 4e-4;
  const Problem plain = example("kr270/problem.yaml");
  const auto arm = make_model(plain);
  Random random(11, 1);
  std::vector<MeasuredPose> poses = random_poses(*arm, 60, random);
  const std::vector<MeasuredPose> read = poses;
  for (MeasuredPose& pose : poses) pose.q[1] += eccentric * std::cos(pose.q[1]) + gear * std::sin(ratio * pose.q[1]);
  read_poses_of(*arm, std::vector<double>(arm->parameters().size(), 0.0), 1.0, random, poses);
  for (std::size_t i = 0; i < poses.size(); ++i) poses[i].q = read[i].q;

  JointEffectsSpec periodic = all_effects("joint_a2", "joint_a1");
  periodic.backlash = periodic.temperature = false;
  Problem problem = with_effects(plain, {periodic});
  VariantSpec& fitted = problem.variants.front();
  for (const char* name : {"joint_a2.cos1", "joint_a2.sin1", "joint_a2.cos_g", "joint_a2.sin_g"})
    fitted.parameters.push_back({name, 1});
  TemporaryFolder folder;
  CalibrateOptions options;
  options.data = folder.write("data.csv", measured_data_csv(*arm, poses));
  options.prior = Prior::none;
  const Calibration found = calibrate_problem(problem, options, Monitor{});
  ASSERT_TRUE(found.fit.converged);
  const std::vector<std::pair<std::string, double>> truth = {
      {"joint_a2.cos1", eccentric}, {"joint_a2.sin1", 0.0}, {"joint_a2.cos_g", 0.0}, {"joint_a2.sin_g", gear}};
  for (const auto& [name, value] : truth) {
    const auto p = std::find_if(found.parameters.begin(), found.parameters.end(),
                                [&, &n = name](const auto& estimate) { return estimate.label.name == n; });
    ASSERT_NE(p, found.parameters.end()) << name;
    EXPECT_NEAR(p->value, value, 4 * p->sigma) << name;
    EXPECT_LT(p->sigma, 0.3 * gear) << name;
  }
  // Without them the residuals say that something is missing.
  const Calibration plain_fit = calibrate_problem(plain, options, Monitor{});
  EXPECT_GT(plain_fit.fit.noise_factor, 1.3 * found.fit.noise_factor);
  // … and which: the larger one first, with nothing said of joints in the file; then, where that is fitted, the gear.
  ASSERT_FALSE(plain_fit.effects.empty());
  EXPECT_EQ(plain_fit.effects.front().name, "joint_a2.cos1, joint_a2.sin1");
  EXPECT_LT(plain_fit.effects.front().corrected, 1e-6);
  for (int k = 0; k < 2; ++k) fitted.parameters.pop_back();
  const Calibration without_gear = calibrate_problem(problem, options, Monitor{});
  EXPECT_EQ(without_gear.effects.front().name, "joint_a2.cos_g, joint_a2.sin_g");
  EXPECT_LT(without_gear.effects.front().corrected, 1e-6);
  // What fitting both leaves is noise.
  EXPECT_GT(found.effects.front().corrected, 0.01);
}

// A rail under a turning arm; readings by formulas of this test with the second joint 2 mrad off.
TEST(JointEffects, AnArmWithASlidingJointIsCalibratedByDefault) {
  const TemporaryFolder folder;
  folder.write("rail.urdf", R"(<robot name="rail"><link name="b"/><link name="c"/><link name="d"/><link name="e"/>
<joint name="rail" type="prismatic"><parent link="b"/><child link="c"/><axis xyz="1 0 0"/>
<limit lower="0" upper="2" effort="1" velocity="1"/></joint>
<joint name="j1" type="revolute"><parent link="c"/><child link="d"/><origin xyz="0 0 0.5"/><axis xyz="0 0 1"/>
<limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
<joint name="j2" type="revolute"><parent link="d"/><child link="e"/><origin xyz="0.1 0 0.3"/><axis xyz="0 1 0"/>
<limit lower="-2" upper="2" effort="1" velocity="1"/></joint></robot>)");
  const Problem problem = read_problem(folder.write(
      "p.yaml",
      "posewright: 1\nrobot: {urdf: rail.urdf}\nmeasurement: {type: position, target: [0.4, 0.1, 0.1], "
      "device: {type: isotropic, noise: \"0.1 mm\"}}\nvariants: {v: {parameters: auto, nuisance: [\"base.*\"]}}\n"));
  Random random(5, 1);
  std::string data = "id,rail [m],j1 [rad],j2 [rad],target.x [m],target.y [m],target.z [m]\n";
  for (int id = 1; id <= 25; ++id) {
    const double rail = random.uniform(0, 2), j1 = random.uniform(-2, 2), j2 = random.uniform(-2, 2);
    const Eigen::Vector3d on_arm =
        Eigen::Vector3d(0.1, 0, 0.3) +
        Eigen::AngleAxisd(j2 + 2e-3, Eigen::Vector3d::UnitY()) * Eigen::Vector3d(0.4, 0.1, 0.1);
    Eigen::Vector3d at = Eigen::Vector3d(rail, 0, 0.5) + Eigen::AngleAxisd(j1, Eigen::Vector3d::UnitZ()) * on_arm;
    for (double& x : at) x += 1e-4 * random.normal();
    data += fmt::format("{},{},{},{},{},{},{}\n", id, rail, j1, j2, at.x(), at.y(), at.z());
  }
  CalibrateOptions options;
  options.data = folder.write("data.csv", data);
  const Calibration found = calibrate_problem(problem, options, Monitor{});
  EXPECT_TRUE(found.fit.converged);
  EXPECT_NEAR(found.fit.scale, 1.0, 0.35);
  ASSERT_FALSE(found.effects.empty());
  for (const auto& effect : found.effects) EXPECT_THAT(effect.name, Not(HasSubstr("rail.cos")));
}

TEST(JointEffects, APatternGivesEccentricityToTheJointsThatTurn) {
  const std::vector<Coordinate> joints = {{"rail", "m", 0, 2}, {"j1", "rad", -2, 2}};
  const std::vector<JointEffectsSpec> each = with_eccentricity({}, joints);
  ASSERT_EQ(each.size(), 2U);
  EXPECT_FALSE(each[0].eccentricity);
  EXPECT_TRUE(each[1].eccentricity);
}

std::string refusal(const std::string& effects) {
  const std::string text = "posewright: 1\nrobot:\n  urdf: " + (examples_folder() / "kr270/kr270.urdf").string() +
                           "\n  joint_effects: " + effects +
                           "\nmeasurement: {type: points, targets: {A: [0, 0, 0.1]}, device: {type: isotropic, noise: "
                           "0.1 mm}}\nvariants: {v: {parameters: auto}}\n";
  return message_of<InputError>([&] {
    const Problem problem = parse_problem(text, "p.yaml");
    make_model(problem);
  });
}

TEST(JointEffects, WhatMakesNoSenseIsRefusedWithItsLine) {
  EXPECT_EQ(refusal("{joint_a2: {eccentricity: yes}}"), "");
  EXPECT_THAT(refusal("{elbow: {eccentricity: yes}}"), HasSubstr("p.yaml:4: 'elbow' is not a coordinate"));
  EXPECT_THAT(refusal("{joint_a2: {}}"), HasSubstr("has no effect"));
  EXPECT_THAT(refusal("{joint_a2: {eccentricity: no}}"), HasSubstr("has no effect"));
  EXPECT_THAT(refusal("{joint_a2: {gear_ratio: -3}}"), HasSubstr("gear_ratio"));
  EXPECT_THAT(refusal("{joint_a2: {eccentricity: yes, gear_ratio: 2}}"), HasSubstr("harmonic of eccentricity"));
  EXPECT_THAT(refusal("{joint_a2: {coupling: [joint_a2]}}"), HasSubstr("coupled with itself"));
  EXPECT_THAT(refusal("{joint_a2: {coupling: [elbow]}}"), HasSubstr("'elbow' is not a coordinate"));
  EXPECT_THAT(refusal("{joint_a2: {eccentricity: yes}, \"*\": {gear_ratio: 100}}"), HasSubstr("is there twice"));
  EXPECT_THAT(refusal("{joint_a2: {overrun: 1 deg}}"), HasSubstr("overrun needs backlash"));
  EXPECT_THAT(refusal("{joint_a2: {backlash: yes, overrun: 1 mm}}"), HasSubstr("wrong unit"));
  EXPECT_THAT(refusal("{joint_a2: {temperature: yes}}"), HasSubstr("but no temperature is given"));
  EXPECT_THAT(refusal("{joint_a2: {eccentricity: yes}}\n  temperature: {at: [20]}"), HasSubstr("is used by no joint"));
  EXPECT_THAT(refusal("{joint_a2: {temperature: yes}}\n  temperature: {at: [20, 20]}"), HasSubstr("twice"));
}

}  // namespace
}  // namespace posewright
