// Whether an estimate is to be used, told by cases whose right answer is known.

#include "src/tasks/calibrate/calibration_verdict.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "posewright/problem/read_problem.hpp"
#include "posewright/tasks/calibrate_problem.hpp"
#include "posewright/tasks/observe_problem.hpp"
#include "tests/kit/example_problems.hpp"
#include "tests/kit/message_of.hpp"
#include "tests/kit/temporary_folder.hpp"
#include "tests/kit/urdf_text.hpp"
#include "tests/kit/virtual_data.hpp"
#include "tests/kit/virtual_file.hpp"

namespace posewright {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::HasSubstr;

const fs::path cases = fs::path(POSEWRIGHT_SHARED_DIR) / "cases";

Calibration calibrated_case(const std::string& problem, const std::string& data) {
  CalibrateOptions options;
  options.data = cases / data;
  return calibrate_problem(read_problem(cases / problem), options, Monitor{});
}

TEST(Verdict, OnePoseReadFifteenTimesIsRefused) {
  if (!fs::exists(cases)) GTEST_SKIP() << "../shared/cases is absent";
  const Calibration one = calibrated_case("one_pose/problem.yaml", "one_pose/same_pose.csv");
  EXPECT_EQ(one.verdict, Verdict::do_not_use);
  EXPECT_THAT(one.refusals, Contains(HasSubstr("only one pose is fitted")));
}

TEST(Verdict, ResidualsThatNoRobotHasAreRefusedAndRightOnesAreNot) {
  if (!fs::exists(cases)) GTEST_SKIP() << "../shared/cases is absent";
  EXPECT_EQ(calibrated_case("conventions/problem.yaml", "conventions/ok.csv").verdict, Verdict::use_it);
  EXPECT_EQ(calibrated_case("coupling/told.yaml", "coupling/controller.csv").verdict, Verdict::use_it);
  EXPECT_EQ(calibrated_case("prismatic/p.yaml", "prismatic/m.csv").verdict, Verdict::use_it);
  // Columns that belong to no robot and keep no convention.
  VirtualFile data("kr270/problem.yaml", 20);
  for (MeasuredPose& pose : data.poses)
    for (double& value : pose.y) value = data.random.normal();
  data.write();
  const Calibration c = calibrate_problem(data.problem, data.options(), Monitor{});
  EXPECT_EQ(c.verdict, Verdict::do_not_use);
  EXPECT_THAT(c.refusals, Contains(HasSubstr("Check units, signs and zeros")));
}

TEST(Verdict, AZeroThatIsFortyTolerancesOffIsFoundWithinItsInterval) {
  if (!fs::exists(cases)) GTEST_SKIP() << "../shared/cases is absent";
  const Calibration c = calibrated_case("assumed_prior/problem.yaml", "assumed_prior/two_degrees.csv");
  EXPECT_EQ(c.verdict, Verdict::use_it);
  EXPECT_EQ(c.fit.noise_factor, 1.0) << "the noise is as stated; the tolerance was at fault";
  for (const CalibratedParameter& p : c.parameters) {
    if (!p.estimated || !p.label.name.ends_with(".offset")) continue;
    const bool off = p.label.name == "joint_4.offset";
    const double truth = off ? 2.0 * std::numbers::pi / 180 : 0.0;
    EXPECT_NEAR(p.value, truth, p.half_width) << p.label.name;
    EXPECT_EQ(p.spread > 10, off) << p.label.name << ": one zero that is off does not widen the others";
  }
}

TEST(Verdict, AGainThatChanceExplainsIsNoRefusalAndALossBeyondChanceIsOne) {
  // A robot so near to nominal that its noisy readings hardly tell its parameters.
  VirtualFile data("kr270/problem.yaml", 20);
  int not_shown = 0, refused = 0;
  for (const double share : {0.0, 0.04, 0.05, 0.06, 0.07, 0.08}) {
    std::vector<double> truth(data.truth.size(), 0.0);
    if (share > 0) truth = random_truth(*data.model, data.columns, share, data.random);
    read_poses_of(*data.model, truth, share > 0 ? 2.0 : 1.0, data.random, data.poses);
    data.write();
    const Calibration c = calibrate_problem(data.problem, data.options(), Monitor{});
    ASSERT_GT(c.left_out.groups, 0);
    EXPECT_EQ(c.verdict == Verdict::use_it, c.left_out.gain > 2) << share;
    EXPECT_EQ(c.verdict == Verdict::do_not_use, c.left_out.gain < -2) << share;
    EXPECT_EQ(c.refusals.empty(), c.verdict != Verdict::do_not_use) << share;
    if (c.verdict == Verdict::do_not_use) {
      ++refused;
      EXPECT_THAT(c.refusals, Contains(HasSubstr("times uncalibrated, significantly worse")));
    }
    if (c.verdict != Verdict::gain_not_shown) continue;
    ++not_shown;
    EXPECT_THAT(c.notes, Contains(HasSubstr("gain not shown")));
  }
  EXPECT_GT(not_shown, 0);
  EXPECT_GT(refused, 0);
}

TEST(Verdict, ALossBeyondChanceThatIsSmallIsNoRefusalAndNotCalledChance) {
  VirtualFile data("kr270/problem.yaml", 20);
  data.write();
  Calibration c = calibrate_problem(data.problem, data.options(), Monitor{});
  ASSERT_EQ(c.columns.size(), data.columns.selected.size());
  const std::vector<double> placed(data.model->parameters().size(), 0.0);
  const std::vector<MeasuredPose> none;
  const auto judged = [&](double gain, double estimated) {
    Calibration other = c;
    other.notes.clear();
    other.refusals.clear();
    other.left_out.gain = gain;
    other.left_out.estimated = estimated;
    other.left_out.placed = 1.0;
    judge_calibration({data.problem.measurement, *data.model, data.columns, data.poses, none, placed}, other);
    return other;
  };
  EXPECT_THAT(judged(-3, 1.01).notes, Contains(HasSubstr("uncalibrated, significantly worse")));
  EXPECT_THAT(judged(-3, 1.01).refusals, testing::IsEmpty());
  EXPECT_THAT(judged(-1, 1.01).notes, Contains(HasSubstr("uncalibrated, not significant")));
  EXPECT_THAT(judged(-3, 1.5).refusals, Contains(HasSubstr("uncalibrated, significantly worse")));
}

TEST(Verdict, APoseWithALostTargetIsNamedBeforeAnythingIsFitted) {
  VirtualFile data("kr270/problem.yaml", 20);
  data.poses[4].y.head<3>().setZero();
  data.poses[11].y.segment<3>(3).setConstant(-9.999);
  data.write();
  EXPECT_THAT(message_of<CannotDo>([&] { calibrate_problem(data.problem, data.options(), Monitor{}); }),
              testing::AllOf(testing::ContainsRegex("gross errors at poses (5|12) .*(5|12) "),
                             HasSubstr("data.csv:6: a target is read as 0"),
                             HasSubstr("data.csv:13: 9999 stands for no reading")));
  CalibrateOptions robust = data.options();
  robust.weighting = Weighting::robust;
  const Calibration c = calibrate_problem(data.problem, robust, Monitor{});
  EXPECT_TRUE(c.fit.converged);
  EXPECT_LT(*std::min_element(c.fit.weights[4].begin(), c.fit.weights[4].end()), 0.01);
}

TEST(Verdict, TargetsThatWereReadAsEachOtherAreNamed) {
  VirtualFile data("kr270/problem.yaml", 20);
  const auto exchange = [&](std::size_t k, Eigen::Index a, Eigen::Index b) {
    const Eigen::Vector3d kept = data.poses[k].y.segment<3>(3 * a);
    data.poses[k].y.segment<3>(3 * a) = data.poses[k].y.segment<3>(3 * b);
    data.poses[k].y.segment<3>(3 * b) = kept;
  };
  exchange(4, 0, 1);
  exchange(11, 0, 1);
  exchange(11, 1, 2);
  data.write();
  EXPECT_THAT(message_of<CannotDo>([&] { calibrate_problem(data.problem, data.options(), Monitor{}); }),
              testing::AllOf(HasSubstr("mixed up at poses 5 (P1, P2, P3 are P2, P1, P3), "
                                       "12 (P1, P2, P3 are P2, P3, P1): only so")));
  CalibrateOptions robust = data.options();
  robust.weighting = Weighting::robust;
  EXPECT_TRUE(calibrate_problem(data.problem, robust, Monitor{}).fit.converged);
}

TEST(Verdict, RowsThatLookLikeNoReadingAreNoted) {
  VirtualFile data("kr270/problem.yaml", 12);
  data.poses[7].y = data.poses[4].y;
  data.poses[9].id = data.poses[2].id;
  data.poses.push_back(data.poses[1]);
  data.write();
  const MeasuredData read = read_measured_data(data.options().data, data.problem, *data.model);
  EXPECT_THAT(read.notes,
              testing::UnorderedElementsAre(HasSubstr("data.csv:9: the readings of an earlier row"),
                                            HasSubstr("data.csv:14: the readings of an earlier row, to the last digit"),
                                            HasSubstr("data.csv:11: an id that another configuration")));
}

/// A column with an arm whose axes are all vertical but for the digits of 3.1416: base.z and target.P.z are one.
struct ColumnArm {
  TemporaryFolder folder;
  Problem problem;
  std::unique_ptr<IdentificationModel> model;
  double base_z = 0;

  ColumnArm() {
    const auto joint = [](const char* name, const char* type, const char* parent, const char* child, const char* origin,
                          const char* limit) {
      return std::string("<joint name=\"") + name + "\" type=\"" + type + "\"><parent link=\"" + parent +
             "\"/><child link=\"" + child + "\"/><origin " + origin + "/><axis xyz=\"0 0 1\"/><limit " + limit +
             " velocity=\"1\" effort=\"1\"/></joint>";
    };
    const char* turn = "lower=\"-2.4\" upper=\"2.4\"";
    std::string urdf = "<robot name=\"column\">";
    for (const char* link : {"base_link", "l1", "l2", "l3", "tip"})
      urdf += std::string("<link name=\"") + link + "\"/>";
    urdf += joint("column", "prismatic", "base_link", "l1", "xyz=\"0 0 0.3\"", "lower=\"0\" upper=\"0.5\"") +
            joint("j1", "revolute", "l1", "l2", "xyz=\"0 0 0\"", turn) +
            joint("j2", "revolute", "l2", "l3", "xyz=\"0.35 0 0\" rpy=\"3.1416 0 0\"", turn) +
            joint("j3", "revolute", "l3", "tip", "xyz=\"0.3 0 0\" rpy=\"3.1416 0 0\"", turn) + "</robot>";
    folder.write("arm.urdf", urdf);
    problem = read_problem(folder.write("problem.yaml", R"(posewright: 1
robot: {urdf: arm.urdf, base: base_link, tip: tip}
measurement:
  type: points
  targets: {P: [0.05, 0, 0.02]}
  device: {type: isotropic, noise: "0.1 mm"}
variants: {geometric: {parameters: ["j*.offset"], nuisance: ["base.*", "target.*"]}}
design: {poses: 20, candidates: 500}
)"));
    model = make_model(problem);
  }
  Calibration calibrated(Random& random, Prior prior) {
    const VariantColumns columns = select_columns(*model, {problem, problem.variants.front()});
    std::vector<MeasuredPose> poses = random_poses(*model, 20, random);
    std::vector<double> truth = random_truth(*model, columns, 0.3, random);
    for (std::size_t i = 0; i < truth.size(); ++i)
      if (model->parameters()[i].name == "base.z") base_z = truth[i] = 0.03 * random.normal();
    read_poses_of(*model, truth, 1.0, random, poses);
    CalibrateOptions options;
    options.data = folder.write("data.csv", measured_data_csv(*model, poses));
    options.prior = prior;
    return calibrate_problem(problem, options, Monitor{});
  }
};

TEST(Verdict, AnArmOnAColumnIsNeverMetresOffAndItsOpenDirectionIsNamed) {
  ColumnArm arm;
  Random random(3, 1);
  for (int draw = 0; draw < 40; ++draw) {
    const Calibration c = arm.calibrated(random, Prior::manufactured);
    ASSERT_TRUE(c.fit.converged);
    EXPECT_EQ(c.verdict, Verdict::do_not_use);
    EXPECT_THAT(c.refusals, Contains(testing::AllOf(HasSubstr("base.z"), HasSubstr("target.P.z"),
                                                    HasSubstr("determine the position of frames"),
                                                    HasSubstr("more than the size of the robot"))));
    for (const CalibratedParameter& p : c.parameters)
      if (p.label.name == "base.z") {
        EXPECT_NEAR(p.value, arm.base_z, 0.1) << draw;
      }
    // Plain least squares have no limit: what is estimated and runs away is refused.
    const Calibration plain = arm.calibrated(random, Prior::none);
    for (const CalibratedParameter& p : plain.parameters)
      if (p.label.name == "base.z" && plain.verdict != Verdict::do_not_use) {
        EXPECT_NEAR(p.value, arm.base_z, 0.1) << draw;
      }
  }
}

const CalibratedParameter& parameter(const Calibration& c, const std::string& name) {
  return *std::ranges::find_if(c.parameters, [&](const CalibratedParameter& p) { return p.label.name == name; });
}

/// Those that hang on something left out have no interval, are written without σ, and the rest is right.
void expect_given(const Calibration& c, const std::vector<std::string>& names, const std::string& left_out) {
  for (const CalibratedParameter& p : c.parameters) {
    const bool hangs = std::ranges::find(names, p.label.name) != names.end();
    if (p.estimated) {
      EXPECT_EQ(p.given, hangs ? std::vector{left_out} : std::vector<std::string>{}) << p.label.name;
      EXPECT_EQ(std::isfinite(p.lower) && std::isfinite(p.upper), !hangs) << p.label.name;
    } else {
      EXPECT_EQ(p.label.name, left_out);
    }
  }
  for (const EstimatedValue& value : c.values) {
    if (std::ranges::find(names, value.value.name) != names.end()) {
      EXPECT_FALSE(value.sigma) << value.value.name;
    }
  }
  EXPECT_THAT(c.notes, Contains(HasSubstr("only if " + left_out + " is nominal")));
}

TEST(Verdict, AWideToleranceThatWasStatedDoesNotExcuseALostTarget) {
  if (!fs::exists(cases)) GTEST_SKIP() << "../shared/cases is absent";
  const Problem problem = read_problem(cases / "coupling/told.yaml");  // states 1 for the coupling
  const auto model = make_model({problem, problem.variants.front()});
  std::vector<MeasuredPose> poses = read_measured_data(cases / "coupling/controller.csv", problem, *model).poses;
  poses[4].y.setZero();
  const TemporaryFolder folder;
  CalibrateOptions options;
  options.data = folder.write("lost.csv", measured_data_csv(*model, poses));
  const Calibration c = calibrate_problem(problem, options, Monitor{});
  EXPECT_EQ(c.verdict, Verdict::do_not_use);
  EXPECT_THAT(c.refusals, Contains(HasSubstr("Check units, signs and zeros")));
  EXPECT_THAT(c.notes, Contains(HasSubstr("lost.csv:6: a target is read as 0")));
}

TEST(Verdict, WhatHangsOnSomethingLeftOutHasNoSigmaAndIsNotCountedAsIdentified) {
  if (!fs::exists(cases)) GTEST_SKIP() << "../shared/cases is absent";
  const Calibration confounded = calibrated_case("confounded/problem.yaml", "confounded/measured.csv");
  expect_given(confounded, {"base.x", "base.y", "base.z"}, "tool.z");
  const Calibration one_axis = calibrated_case("one_axis/problem.yaml", "one_axis/one_axis.csv");
  expect_given(one_axis, {"base.x", "base.y", "tool.x", "tool.y", "tool.z"}, "base.z");
  const Observation o = observe_problem(read_problem(cases / "confounded/problem.yaml"), {}, Monitor{}).front();
  for (std::size_t j = 0; j < o.parameters.size(); ++j)
    EXPECT_EQ(o.given[j].empty(), o.parameters[j].name != "base.z") << o.parameters[j].name;
}

TEST(Verdict, OfOneAxisOnlyWhatDoesNotHangOnTheToolsHeightIsKnown) {
  TemporaryFolder folder;
  folder.write("robot.urdf", urdf_text({{'P', "0 0 0", "0 0 0", "1 0 0"},
                                        {'P', "0 0 0", "0 0 0", "0 1 0"},
                                        {'P', "0 0 0", "0 0 0", "0 0 1"},
                                        {'R', "0 0 0", "0 0 0", "0 0 1"}}));
  const Problem problem = read_problem(folder.write("problem.yaml", R"(posewright: 1
robot: {urdf: robot.urdf, placement: {position: [0.1, 0.2, 0.9], rpy: ["180 deg", 0, 0]}}
measurement: {type: pose, device: {type: isotropic, noise: {position: "1 mm", rotation: "5 mrad"}}}
variants: {hand_eye: {parameters: ["base.*"], nuisance: ["tool.*"]}}
design: {poses: 20, candidates: 500}
)"));
  const auto model = make_model({problem, problem.variants.front()});
  Random random(11, 0);
  for (int draw = 0; draw < 10; ++draw) {
    std::vector<MeasuredPose> poses = random_poses(*model, 20, random);
    std::vector<double> truth(model->parameters().size(), 0.0);
    for (std::size_t i = 0; i < truth.size(); ++i)
      if (model->parameters()[i].places) truth[i] = 0.05 * random.normal();
    read_poses_of(*model, truth, 1.0, random, poses);
    CalibrateOptions options;
    options.data = folder.write("data.csv", measured_data_csv(*model, poses));
    const Calibration c = calibrate_problem(problem, options, Monitor{});
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const std::string& name = model->parameters()[i].name;
      if (truth[i] == 0 || (!name.ends_with(".x") && !name.ends_with(".y") && !name.ends_with(".z"))) continue;
      const CalibratedParameter& p = parameter(c, name);
      if (p.estimated && p.given.empty()) {
        EXPECT_NEAR(p.value, p.label.nominal + truth[i], 5 * p.sigma) << name << " of draw " << draw;
      }
    }
    EXPECT_FALSE(parameter(c, "base.z").given.empty());
  }
}

TEST(Verdict, AnEffectThatMostOfTheResidualsAreLeavesNoIntervalToWhatItMoves) {
  VirtualFile data("instruments/camera_on_hand.yaml", 15);
  std::vector<double> truth(data.truth.size(), 0.0);
  for (std::size_t i = 0; i < truth.size(); ++i)
    if (const std::string& name = data.model->parameters()[i].name; name == "camera.fx" || name == "camera.fy")
      truth[i] = 0.03 * data.model->parameters()[i].nominal;
  read_poses_of(*data.model, truth, 1.0, data.random, data.poses);
  data.write();
  CalibrateOptions options = data.options();
  options.variant = "hand_eye";
  const Calibration c = calibrate_problem(data.problem, options, Monitor{});
  ASSERT_FALSE(c.effects.empty());
  EXPECT_EQ(c.effects.front().name, "camera.fx, camera.fy");
  EXPECT_TRUE(c.effects.front().dominates());
  int given = 0;
  for (const CalibratedParameter& p : c.parameters) {
    // Truth is nominal for all that is estimated.
    if (p.given.empty() && turned_frame(c, p) == nullptr) {
      EXPECT_NEAR(p.value, p.label.nominal, 2 * p.half_width) << p.label.name;
    }
    given += p.given.empty() ? 0 : 1;
  }
  EXPECT_GT(given, 0);
}

/// Verdict of a camera's place from these columns, and what was named.
std::string told_of(VirtualFile& data) {
  data.write();
  CalibrateOptions options = data.options();
  options.variant = "hand_eye";
  try {
    const Calibration c = calibrate_problem(data.problem, options, Monitor{});
    return c.verdict == Verdict::use_it ? "use it" : "not used";
  } catch (const CannotDo& error) {
    return error.what();
  }
}

/// Wrong columns put the board behind the camera, where derivatives have no limit and seem to explain any residual.
TEST(Verdict, NoPlaceOfACameraComesFromJointsThatAreMixedUp) {
  const auto told = [](auto&& mix_up) {
    VirtualFile data("instruments/camera_on_hand.yaml", 10);
    for (MeasuredPose& pose : data.poses) mix_up(pose.q);
    return told_of(data);
  };
  EXPECT_EQ(told([](auto&) {}), "use it");
  EXPECT_THAT(told([](auto& q) {
                for (double& value : q) value *= 180 / std::numbers::pi;
              }),
              HasSubstr("are degrees"));
  EXPECT_NE(told([](auto& q) { std::swap(q[1], q[3]); }), "use it");
  EXPECT_NE(told([](auto& q) { q[2] = -q[2]; }), "use it");
}

TEST(Verdict, ReadingsWithoutNoiseAreUsed) {
  VirtualFile data("instruments/camera_on_hand.yaml", 15, 0.0);
  read_poses_of(*data.model, std::vector<double>(data.truth.size(), 0.0), 0.0, data.random, data.poses);
  EXPECT_EQ(told_of(data), "use it");
}

TEST(Verdict, ABoardOfAnotherSizeIsToldFromAFocalLength) {
  const std::pair scale{"pattern.scale", "pattern.scale"}, focal{"camera.f", "camera.fx, camera.fy"};
  for (const auto& [is, other] : {std::pair(scale, focal), std::pair(focal, scale)}) {
    VirtualFile data("instruments/camera_on_hand.yaml", 15);
    std::vector<double> truth(data.truth.size(), 0.0);
    for (std::size_t i = 0; i < truth.size(); ++i)
      if (data.model->parameters()[i].name.starts_with(is.first)) truth[i] = 3e-3 * data.model->parameters()[i].nominal;
    read_poses_of(*data.model, truth, 1.0, data.random, data.poses);
    data.write();
    CalibrateOptions options = data.options();
    options.variant = "hand_eye";
    const Calibration c = calibrate_problem(data.problem, options, Monitor{});
    ASSERT_FALSE(c.effects.empty());
    EXPECT_EQ(c.effects.front().name, is.second);
    EXPECT_LT(c.effects.front().corrected, 1e-6);
    const auto mistaken = std::ranges::find(c.effects, other.second, &ScoreTest::name);
    EXPECT_GT(c.effects.front().share, mistaken->share + 0.1);
  }
}

TEST(Verdict, AFocalLengthOrABoardOfAnotherSizeLeavesNoIntervalOfTheCamerasPlace) {
  if (!fs::exists(cases)) GTEST_SKIP() << "../shared/cases is absent";
  for (const auto& [name, effect] : {std::pair("foc", "camera.fx, camera.fy"), std::pair("sq", "pattern.scale")}) {
    const Calibration c =
        calibrated_case(std::string("focal/") + name + ".yaml", std::string("focal/") + name + ".csv");
    EXPECT_EQ(parameter(c, "camera.z").given, std::vector<std::string>{effect}) << name;
  }
}

TEST(Verdict, ABoardOfOnePercentMoreIsNamedAndEstimatedWithTheCamerasPlace) {
  if (!fs::exists(cases)) GTEST_SKIP() << "../shared/cases is absent";
  CalibrateOptions options;
  options.data = cases / "focal/sq.csv";
  for (const double size : {0.99, 1.01}) {
    Problem problem = read_problem(cases / "focal/sq.yaml");
    std::get<CameraMeasurement>(problem.measurement.instrument).spacing = 0.03 * size;
    const Calibration without = calibrate_problem(problem, options, Monitor{});
    EXPECT_EQ(without.effects.front().name, "pattern.scale");
    EXPECT_EQ(parameter(without, "camera.z").given, std::vector<std::string>{"pattern.scale"});
    problem.variants.front().parameters.push_back({"pattern.scale"});
    const Calibration with = calibrate_problem(problem, options, Monitor{});
    for (const auto& [name, truth] : {std::pair("pattern.scale", 1 / size), std::pair("camera.z", 0.13)}) {
      const CalibratedParameter& p = parameter(with, name);
      EXPECT_NEAR(p.value, truth, 2 * p.half_width) << name << " " << size;
      EXPECT_LT(p.half_width, 0.01 * truth);
    }
  }
}

}  // namespace
}  // namespace posewright
