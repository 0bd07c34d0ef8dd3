// Backlash and temperature: what a plan states of them, what a route does, what data say.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "posewright/formats/pose_formats.hpp"
#include "posewright/lists/measured_data.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/model/variant_columns.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/results/plan.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/json.hpp"
#include "posewright/tasks/calibrate_problem.hpp"
#include "posewright/tasks/check_sequence.hpp"
#include "posewright/tasks/plan_problem.hpp"
#include "posewright/tasks/route_problem.hpp"
#include "tests/kit/design_edits.hpp"
#include "tests/kit/example_problems.hpp"
#include "tests/kit/message_of.hpp"
#include "tests/kit/pose_lists.hpp"
#include "tests/kit/temporary_folder.hpp"
#include "tests/kit/virtual_data.hpp"

namespace posewright {
namespace {

using testing::HasSubstr;

constexpr double overrun = 3 * M_PI / 180;

Problem loose_and_warm(const std::string& effects =
                           "joint_a2: {backlash: yes, overrun: 3 deg, temperature: yes}, "
                           "joint_a3: {backlash: yes, overrun: 3 deg}") {
  return parse_problem("posewright: 1\nrobot:\n  urdf: " + (examples_folder() / "kr270/kr270.urdf").string() +
                           "\n  temperature: {reference: 20, at: [18, 25]}\n  joint_effects: {" + effects +
                           "}\n"
                           "measurement:\n  type: points\n  targets: {A: [0, 0, 0.1], B: [0.1, 0, 0.1], C: [0, 0.1, "
                           "0.2]}\n  device: {type: isotropic, noise: 0.1 mm}\n"
                           "design: {poses: 14, candidates: 400}\nvariants: {all: {parameters: auto}}\n",
                       "p.yaml");
}

Plan quick_plan(const Problem& problem) {
  DesignEdits options = DesignEdits().edit("method", "greedy");
  return planned(problem, options);
}

double sigma_of(const Plan& plan, const std::string& name) {
  for (const PlannedParameter& p : plan.parameters)
    if (p.label.name == name && p.sigma) return *p.sigma;
  ADD_FAILURE() << name << " is not estimated";
  return 0.0;
}

TEST(Approach, APlanSeparatesPlayAndDriftFromGeometry) {
  const Plan plan = quick_plan(loose_and_warm());
  EXPECT_LT(sigma_of(plan, "joint_a2.backlash"), 0.2 * 2e-4);
  EXPECT_LT(sigma_of(plan, "joint_a3.backlash"), 0.3 * 2e-4);
  EXPECT_LT(sigma_of(plan, "joint_a2.temperature"), 0.6 * 1e-5);
}

TEST(Approach, EveryMotionOfARouteArrivesFromTheStatedSideByTheOverrun) {
  const Problem problem = loose_and_warm();
  const Plan plan = quick_plan(problem);
  RouteOptions options;
  options.from_home = options.closed = true;
  const Route route = route_problem(problem, planned_poses(problem, plan), options, Monitor{});
  ASSERT_EQ(route.poses.size(), plan.poses.size());
  int arrivals = 0, changes = 0;
  std::string temperature;
  for (const RouteMotion& motion : route.motions) {
    if (motion.to == 0) continue;
    const PoseChoices& choices = plan.poses[std::size_t(motion.to) - 1].choices;
    const std::vector<double>&end = motion.points.back(), &before = motion.points[motion.points.size() - 2];
    for (const auto& [name, choice] : choices) {
      if (name == "temperature") {
        changes += int(choice != temperature);
        temperature = choice;
        continue;
      }
      const std::size_t joint = name == "joint_a2.approach" ? 1 : 2;
      EXPECT_NEAR(end[joint] - before[joint], choice == "rising" ? overrun : -overrun, 1e-12) << motion.to << name;
      ++arrivals;
    }
    for (const std::size_t joint : {0, 3, 4, 5}) EXPECT_EQ(end[joint], before[joint]);
  }
  EXPECT_EQ(arrivals, 28);
  // A robot does not warm and cool between neighbours.
  EXPECT_LE(changes, 2);
  // The written file passes the check of what a robot is moved by; with one approach turned round it does not.
  const std::string text = route_json(route);
  EXPECT_NO_THROW(checked_sequence(problem, parse_sequence(text, "route.json")));
  auto turned = parse_json(text);
  EXPECT_TRUE(turned["poses"][3]["conditions"]["temperature"].is_number());
  auto& side = turned["poses"][3]["conditions"]["joint_a3.approach"];
  side = side == "rising" ? "falling" : "rising";
  EXPECT_THAT(message_of<InputError>([&] { checked_sequence(problem, parse_sequence(turned.dump(), "route.json")); }),
              HasSubstr("does not arrive from the stated side: joint_a3.approach"));
}

TEST(Approach, ARobotsProgramComesFromARouteAlone) {
  const Problem problem = loose_and_warm();
  const Plan plan = quick_plan(problem);
  const PoseFormat& format = find_pose_format("kuka-krl");
  EXPECT_THAT(message_of<CannotDo>([&] {
                export_poses(format, checked_sequence(problem, parse_sequence(plan_json(plan), "plan.json")), {});
              }),
              HasSubstr("export a route"));
  RouteOptions options;
  const PoseList poses = planned_poses(problem, plan);
  EXPECT_THROW(route_problem(problem, poses, options, Monitor{}), CannotDo);
  options.from_home = true;
  const Route route = route_problem(problem, poses, options, Monitor{});
  const Exported program =
      export_poses(format, checked_sequence(problem, parse_sequence(route_json(route), "route.json")), {});
  EXPECT_THAT(program.files.front().bytes, HasSubstr("temperature: "));
  EXPECT_THAT(program.files.front().bytes, testing::Not(HasSubstr("approach")));
}

TEST(Approach, APoseThatHasNoRoomForItIsLeftOutWithTheReason) {
  const Problem problem = loose_and_warm();
  const auto coordinates = pose_coordinates(problem);
  std::string text;
  for (const Coordinate& c : coordinates) text += (text.empty() ? "" : ",") + c.name;
  text += "\n0,-1.57,0,0,0,0,20,rising,rising\n0,-1.57," + std::to_string(coordinates[2].lower + 0.02) +
          ",0,0,0,20,rising,rising\n0,-1.57," + std::to_string(coordinates[2].lower + 0.02) +
          ",0,0,0,25,rising,falling\n";
  RouteOptions options;
  options.from_home = true;
  const Route route = route_problem(problem, read_poses_text(text, "p.csv", coordinates), options, Monitor{});
  ASSERT_EQ(route.unreachable.size(), 1U);
  EXPECT_EQ(route.unreachable.front().pose, 2);
  EXPECT_THAT(route.unreachable.front().reason, HasSubstr("no room to arrive from the stated side"));
}

TEST(Approach, WithoutAColumnTheOrderOfTheListSaysIt) {
  const auto coordinates = pose_coordinates(loose_and_warm());
  std::string text = "joint_a1,joint_a2,joint_a3,joint_a4,joint_a5,joint_a6,temperature\n";
  for (const char* row : {"0,-1,0", "0,-1.2,0.1", "0,-1.2,0", "0,-1.1,0", "0,-1.1,0.2"})
    text += std::string(row) + ",0,0,0,21.25\n";
  const PoseList list = read_poses_text(text, "p.csv", coordinates);
  const std::vector<std::pair<double, double>> sides = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}};
  for (std::size_t i = 0; i < sides.size(); ++i) {
    EXPECT_EQ(list.configurations[i][6], 21.25);
    EXPECT_EQ(list.configurations[i][7], sides[i].first) << i;
    EXPECT_EQ(list.configurations[i][8], sides[i].second) << i;
  }
  ASSERT_EQ(list.notes.size(), 2U);
  EXPECT_THAT(list.notes.front(), HasSubstr("gives the side from which joint_a2 arrived"));
  EXPECT_THROW(read_poses_text("joint_a1,joint_a2,joint_a3,joint_a4,joint_a5,joint_a6,temperature\n0,0,0,0,0,0,hot\n",
                               "p.csv", coordinates),
               InputError);
}

TEST(Approach, PlayAndDriftAreFoundInReadingsOfAnArmThatHasThem) {
  constexpr double play = 3e-4, drift = 2e-5;
  const Problem plain = example("kr270/problem.yaml");
  const auto arm = make_model(plain);
  Random random(11, 1);
  std::vector<MeasuredPose> poses = random_poses(*arm, 60, random);
  const std::vector<MeasuredPose> read = poses;
  std::vector<double> temperatures;
  double before = poses.front().q[1];
  for (MeasuredPose& pose : poses) {
    temperatures.push_back(random.uniform(15, 30));
    const double q = pose.q[1];
    pose.q[1] += (q >= before ? -play : play) / 2 + drift * (temperatures.back() - 20);
    before = q;
  }
  read_poses_of(*arm, std::vector<double>(arm->parameters().size(), 0.0), 1.0, random, poses);
  for (std::size_t i = 0; i < poses.size(); ++i) poses[i].q = read[i].q;
  // The file as an instrument's software writes it, with a column more.
  std::string data;
  std::istringstream lines(measured_data_csv(*arm, poses));
  std::string line;
  for (int i = -1; std::getline(lines, line); ++i)
    data += line + (i < 0 ? ",temperature" : "," + std::to_string(temperatures[std::size_t(i)])) + "\n";

  Problem problem = plain;
  auto& robot = std::get<SerialArmSpec>(problem.robot);
  robot.joint_effects = {{{"joint_a2", 1}, false, std::nullopt, {}, true, {}, true}};
  robot.temperature = TemperatureSpec{20.0, {20.0}};
  TemporaryFolder folder;
  CalibrateOptions options;
  options.data = folder.write("data.csv", data);
  options.prior = Prior::none;
  const Calibration left_out = calibrate_problem(problem, options, Monitor{});
  std::vector<std::string> first;
  for (const ScoreTest& effect : left_out.effects)
    if (!effect.name.starts_with("variant ") && first.size() < 2) first.push_back(effect.name);
  EXPECT_THAT(first, testing::UnorderedElementsAre("joint_a2.backlash", "joint_a2.temperature"));
  for (const char* name : {"joint_a2.backlash", "joint_a2.temperature"})
    problem.variants.front().parameters.push_back({name, 1});
  const Calibration found = calibrate_problem(problem, options, Monitor{});
  for (const auto& [name, value] : {std::pair{"joint_a2.backlash", play}, {"joint_a2.temperature", drift}}) {
    const auto p = std::find_if(found.parameters.begin(), found.parameters.end(),
                                [&, &n = name](const auto& estimate) { return estimate.label.name == n; });
    ASSERT_NE(p, found.parameters.end()) << name;
    EXPECT_NEAR(p->value, value, 4 * p->sigma) << name;
    EXPECT_LT(p->sigma, 0.2 * value) << name;
  }
}

}  // namespace
}  // namespace posewright
