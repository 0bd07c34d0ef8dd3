// Whether an estimate is to be used, told by cases whose right answer is known.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "posewright/problem/read_problem.hpp"
#include "posewright/tasks/calibrate_problem.hpp"
#include "tests/kit/example_problems.hpp"
#include "tests/kit/temporary_folder.hpp"
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
  EXPECT_THAT(one.refusals, Contains(HasSubstr("a single pose")));
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
  EXPECT_THAT(c.refusals, Contains(HasSubstr("no robot's errors do that")));
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
    if (c.verdict == Verdict::do_not_use) ++refused;
    if (c.verdict != Verdict::gain_not_shown) continue;
    ++not_shown;
    EXPECT_THAT(c.notes, Contains(HasSubstr("gain not shown")));
  }
  EXPECT_GT(not_shown, 0);
  EXPECT_GT(refused, 0);
}

TEST(Verdict, APoseWithALostTargetIsNamedBeforeAnythingIsFitted) {
  VirtualFile data("kr270/problem.yaml", 20);
  data.poses[4].y.head<3>().setZero();
  data.poses[11].y.segment<3>(3).setConstant(-9.999);
  data.write();
  try {
    calibrate_problem(data.problem, data.options(), Monitor{});
    FAIL() << "fitted";
  } catch (const CannotDo& error) {
    EXPECT_THAT(error.what(), testing::ContainsRegex("gross errors at poses (5|12) .*(5|12) "));
    EXPECT_THAT(error.what(), HasSubstr("data.csv:6: a target is read as 0"));
    EXPECT_THAT(error.what(), HasSubstr("data.csv:13: 9999 stands for no reading"));
  }
  CalibrateOptions robust = data.options();
  robust.weighting = Weighting::robust;
  const Calibration c = calibrate_problem(data.problem, robust, Monitor{});
  EXPECT_TRUE(c.fit.converged);
  EXPECT_LT(*std::min_element(c.fit.weights[4].begin(), c.fit.weights[4].end()), 0.01);
}

TEST(Verdict, RowsThatLookLikeNoReadingAreNoted) {
  VirtualFile data("kr270/problem.yaml", 12);
  data.poses[7].y = data.poses[6].y;
  data.poses[9].id = data.poses[2].id;
  data.write();
  const MeasuredData read = read_measured_data(data.options().data, data.problem, *data.model);
  EXPECT_THAT(read.notes, testing::UnorderedElementsAre(HasSubstr("data.csv:9: the readings of the row before"),
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
    const VariantColumns columns = select_columns(*model, problem, problem.variants.front());
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
  for (int draw = 0; draw < 20; ++draw) {
    const Calibration c = arm.calibrated(random, Prior::manufactured);
    ASSERT_TRUE(c.fit.converged);
    EXPECT_EQ(c.verdict, Verdict::do_not_use);
    EXPECT_THAT(c.refusals, Contains(testing::AllOf(HasSubstr("base.z"), HasSubstr("target.P.z"))));
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

}  // namespace
}  // namespace posewright
