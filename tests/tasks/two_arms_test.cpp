// A left hand that sees the right one: a way up one arm and down the other.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "posewright/cell/cell.hpp"
#include "posewright/model/corrected_urdf.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/file.hpp"
#include "posewright/tasks/observe_problem.hpp"
#include "src/tasks/init/init_text.hpp"
#include "tests/kit/plain_urdf.hpp"
#include "tests/kit/virtual_file.hpp"

namespace posewright {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr const char* file = "two_arms/left_sees_right.yaml";

TEST(TwoArms, ThatSeeEachOtherAreCalibratedAndTheirUrdfHasTheOffsets) {
  VirtualFile data(file, 60);
  data.write();
  const Calibration result = calibrate_problem(data.problem, data.options(), Monitor{});
  const SerialArmSpec& arm = std::get<SerialArmSpec>(data.problem.robot);
  std::map<std::string, double> truth, estimate, sigma;
  for (std::size_t j = 0; j < data.columns.selected.size(); ++j)
    truth[data.columns.parameters[j].name] = data.truth[std::size_t(data.columns.selected[j])];
  std::vector<CalibratedValue> values;
  int offsets = 0;
  for (const CalibratedParameter& p : result.parameters) {
    ASSERT_TRUE(p.estimated) << p.label.name;
    EXPECT_NEAR(p.value, p.label.nominal + truth.at(p.label.name), 5 * p.sigma) << p.label.name;
    values.push_back({p.label.name, p.label.unit, p.label.nominal, p.value});
    offsets += p.label.name.ends_with(".offset") ? 1 : 0;
  }
  EXPECT_EQ(offsets, 10);

  // In the file each joint is turned by its own offset, whichever way the chain passes it.
  const TemporaryFolder folder;
  const CorrectedUrdf corrected = corrected_urdf(arm, {}, VariantSpec::Convention::frames, values);
  const PlainUrdf before(arm.urdf), after(folder.write("after.urdf", corrected.text));
  for (const auto& [link, joint] : before.above) {
    const auto value = std::ranges::find(values, joint.name + ".offset", &CalibratedValue::name);
    Eigen::Isometry3d X = joint.X_ParentJoint;
    if (value != values.end()) X.rotate(Eigen::AngleAxisd(value->correction(), joint.axis));
    EXPECT_TRUE(after.above.at(link).X_ParentJoint.isApprox(X, 1e-12)) << joint.name;
  }
  EXPECT_THAT(corrected.left_out, Not(Contains(HasSubstr(".offset"))));
}

TEST(TwoArms, HaveAsManyParametersAsAChainOfTheirJoints) {
  ObserveOptions options;
  options.variant = "arms";
  options.candidates = 200;
  const Observation o = observe_problem(example(file), options, Monitor{}).front();
  // Four of each joint that turns, six of each end; nine of the lens and the board's scale.
  EXPECT_EQ(o.identifiability.rank, 4 * 12 + 6 + 9);
}

TEST(TwoArms, AreProposedWithoutAFloorWhichWouldMoveWithTheBase) {
  InitFacts facts;
  facts.robot = examples_folder() / "two_arms/two_arms.urdf";
  facts.base = "left_hand";
  facts.tip = "right_hand";
  EXPECT_FALSE(floor_of(facts, look_at_robot(facts, "problem.yaml")));
  facts.floor = 0.1;
  EXPECT_EQ(floor_of(facts, look_at_robot(facts, "problem.yaml")), 0.1) << "somebody wants one";
  facts.floor.reset();
  facts.base = "torso";
  const InitRobot robot = look_at_robot(facts, "problem.yaml");
  EXPECT_TRUE(floor_of(facts, robot));
  EXPECT_THAT(robot.links.other_tips, ElementsAre("right_wrist_link")) << "not those of the other arm";
}

TEST(TwoArms, RefuseObstaclesThatWouldMoveWithTheBase) {
  const TemporaryFolder folder;
  std::string text = read_file(examples_folder() / file);
  const std::string urdf = (examples_folder() / "two_arms/two_arms.urdf").string(), clearance = "clearance: \"10 mm\"";
  text.replace(text.find("two_arms.urdf"), 13, urdf);
  text.replace(text.find(clearance), clearance.size(), clearance + ", obstacles: [{name: floor, plane: [0, 0, 1]}]");
  try {
    make_cell(read_problem(folder.write("p.yaml", text)));
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("p.yaml:27: obstacles need a base that stands"));
  }
}

}  // namespace
}  // namespace posewright
