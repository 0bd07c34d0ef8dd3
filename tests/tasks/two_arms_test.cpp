// A left hand that sees the right one: a way up one arm and down the other.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "posewright/cell/cell.hpp"
#include "posewright/model/corrected_urdf.hpp"
#include "posewright/model/whitening.hpp"
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

TEST(TwoArms, InformAlikeWhicheverHandIsTheBase) {
  const Problem left = example(file);
  Problem right = left;
  auto& arm = std::get<SerialArmSpec>(right.robot);
  std::swap(arm.base, arm.tip);
  std::get<CameraMeasurement>(right.measurement.instrument).on_hand = true;
  const auto one = make_model(left), other = make_model(right);
  Random random(3, 0);
  Linearisation scratch;
  for (const MeasuredPose& pose : random_poses(*one, 100, random)) {
    const auto information = [&](const IdentificationModel& model, const std::vector<double>& q,
                                 std::vector<int>& selected, std::map<std::string, int>& columns) {
      for (int i = 0; i < int(model.parameters().size()); ++i) {
        const std::string& name = model.parameters()[std::size_t(i)].name;
        if (name.starts_with("base.") || name.starts_with("tool.")) continue;
        columns[name] = int(selected.size());
        selected.push_back(i);
      }
      BlockArray::RowMatrix J(model.block_rows(selected), Eigen::Index(selected.size()));
      EXPECT_TRUE(whitened_block(model, q, {}, selected, scratch, J.data(), int(selected.size())));
      return Eigen::MatrixXd(J.transpose() * J);
    };
    std::vector<double> q;
    for (const Coordinate& c : other->coordinates())
      for (std::size_t i = 0; i < pose.q.size(); ++i)
        if (one->coordinates()[i].name == c.name) q.push_back(pose.q[i]);
    std::vector<int> selected, reversed;
    std::map<std::string, int> columns, same;
    const Eigen::MatrixXd M = information(*one, pose.q, selected, columns);
    const Eigen::MatrixXd N = information(*other, q, reversed, same);
    ASSERT_EQ(columns.size(), same.size());
    for (const auto& [a, i] : columns)
      for (const auto& [b, j] : columns)
        ASSERT_NEAR(M(i, j), N(same.at(a), same.at(b)), 1e-9 * std::sqrt(M(i, i) * M(j, j))) << a << " " << b;
  }
}

TEST(TwoArms, AreProposedOnAFloorOfTheirRootIfTheirBaseMoves) {
  const TemporaryFolder folder;
  std::string urdf = read_file(examples_folder() / "two_arms/two_arms.urdf");
  // The stand from 0.51 m below its frame to 1 cm below the torso.
  const std::string before = R"(<origin xyz="0 0 0.3"/><geometry><cylinder radius="0.12" length="0.6"/>)";
  const std::string after = R"(<origin xyz="0 0 0.05"/><geometry><cylinder radius="0.12" length="1.12"/>)";
  for (std::size_t at; (at = urdf.find(before)) != std::string::npos;) urdf.replace(at, before.size(), after);
  const std::filesystem::path file = folder.write("robot.urdf", urdf);
  const auto floor = [&](const char* base) {
    InitFacts facts;
    facts.robot = file;
    facts.base = base;
    facts.tips = {"right_hand"};
    InitRobot robot = look_at_robot(facts, "problem.yaml").front();
    facts.no_floor = true;
    add_bodies(robot, parse_problem(init_text(facts, {robot}, {.position = {100, 0, 100}}), "problem.yaml", {}));
    facts.no_floor = false;
    return floor_of(facts, robot).value();
  };
  EXPECT_NEAR(floor("left_hand"), -0.51, 1.5e-3);
  EXPECT_NEAR(floor("torso"), -1.13, 1.5e-3);
}

}  // namespace
}  // namespace posewright
