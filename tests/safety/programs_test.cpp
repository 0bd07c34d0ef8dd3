// Programs as a controller would run them: planned, routed, written, read back by other code, and asked of the robot's
// own limits and surroundings, by other code again.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <utility>

#include "posewright/formats/pose_formats.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/results/plan.hpp"
#include "posewright/support/error.hpp"
#include "posewright/tasks/check_sequence.hpp"
#include "posewright/tasks/plan_problem.hpp"
#include "posewright/tasks/route_problem.hpp"
#include "tests/formats/program_readers.hpp"
#include "tests/kit/plain_urdf.hpp"
#include "tests/kit/pose_lists.hpp"
#include "tests/kit/temporary_folder.hpp"
#include "tests/kit/verify_cell.hpp"

namespace posewright {
namespace {

namespace fs = std::filesystem;
using Moves = std::vector<std::vector<double>>;

constexpr double degree = std::numbers::pi / 180;

/// One controller: its settings, and its values back to joints by what docs/export.md says of it.
struct Controller {
  const char* format;
  double coupling = 0.0;
  std::vector<double> sign, zero;  // deg
  double tolerance = 1e-6;         // rad, of its decimals
};

std::string settings_of(const Controller& controller, std::size_t joints) {
  std::string text = fmt::format("coupling: {}\nsign: [{}]\nzero_deg: [{}]\n", controller.coupling,
                                 fmt::join(controller.sign, ", "), fmt::join(controller.zero, ", "));
  if (std::string(controller.format) == "urscript") text.erase(0, text.find('\n') + 1);
  if (std::string(controller.format) == "yaskawa-inform")
    text += fmt::format("pulses_per_degree: [{}]\n", fmt::join(std::vector<double>(joints, 1000.0), ", "));
  return text;
}

Moves moves_of(const Controller& controller, const Exported& exported) {
  const std::string format = controller.format;
  const auto& files = exported.files;
  if (format == "kuka-krl") return readers::read_krl(files[0].bytes, files[1].bytes, "CALPOSES").moves;
  if (format == "abb-rapid") return readers::read_rapid(files[0].bytes).moves;
  if (format == "fanuc-tp") return readers::read_tp(files[0].bytes).moves;
  if (format == "urscript") return readers::read_urscript(files[0].bytes).moves;
  if (format == "yaskawa-inform") return readers::read_inform(files[0].bytes).moves;
  std::map<std::string, std::string> by_name;
  for (const ExportedFile& file : files) by_name[fs::path(file.name).filename().string()] = file.bytes;
  return readers::read_val3(by_name, "CALPOSES").moves;
}

std::vector<double> joints_of(const Controller& controller, const std::vector<double>& values) {
  const std::string format = controller.format;
  std::vector<double> q;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double shown = format == "urscript"         ? values[i] / degree
                         : format == "yaskawa-inform" ? values[i] / 1000
                                                      : values[i];
    q.push_back((shown - controller.zero[i]) / controller.sign[i] * degree);
  }
  q[2] += controller.coupling * q[1];
  return q;
}

const std::vector<Controller> controllers = {
    {"kuka-krl", 0, {1, -1, 1, 1, 1, -1}, {0, -90, 90, 0, 0, 0}, 1e-6},
    {"abb-rapid", -1, {1, 1, 1, 1, 1, 1}, {0, 0, 0, 0, 0, 0}, 2e-6},
    {"fanuc-tp", 1, {1, 1, -1, -1, -1, -1}, {0, 0, 0, 0, 0, 0}, 2e-5},
    {"urscript", 0, {1, 1, 1, 1, 1, 1}, {0, 0, 0, 0, 0, 0}, 2e-6},
    {"yaskawa-inform", 0, {1, 1, -1, 1, 1, 1}, {0, 10, 0, 0, 0, 0}, 2e-5},
    {"staubli-val3", 0, {1, 1, 1, 1, 1, 1}, {0, -90, 90, 0, 0, 0}, 2e-6},
};

/// What a route's program must do: stop by stop, via point by via point.
Moves wanted(const Route& route) {
  Moves moves{route.home};
  for (const RouteMotion& motion : route.motions)
    moves.insert(moves.end(), motion.points.begin() + 1, motion.points.end());
  return moves;
}

struct Arm {
  const char *name, *urdf, *base, *tip;
  double scale;  ///< m, of its reach
  const char *home = "{}", *limits = "{}";
};
void PrintTo(const Arm& arm, std::ostream* out) { *out << arm.name; }

struct Routed {
  Plan plan;
  Route route;
  PoseSequence sequence;
};

/// Planned, routed from home, and asked of the robot, as a program would take it.
Routed routed(const Problem& problem, const TemporaryFolder& folder) {
  Routed result;
  result.plan = plan_problem(problem, {}, Monitor{});
  RouteOptions options;
  options.from_home = true;
  const PoseList poses = poses_in(problem, folder.write("plan.json", plan_json(result.plan)));
  result.route = route_problem(problem, poses, options, Monitor{});
  result.sequence = checked_sequence(problem, parse_sequence(route_json(result.route), "route.json"));
  return result;
}

/// States that are asked of in each arm's motions; POSEWRIGHT_SCAN sets it.
long states_asked() {
  const char* const given = std::getenv("POSEWRIGHT_SCAN");
  return given != nullptr ? std::atol(given) : 4000;
}

/// Asks other code of a motion, a millimetre of the arm's farthest point at a time; returns the states asked of: all
/// or, of a longer way, so many in its middle.
long scan(const CellVerifier& judge, const std::vector<std::string>& names, const std::vector<double>& a,
          const std::vector<double>& b, double scale, double clearance) {
  double way = 0;
  for (std::size_t i = 0; i < a.size(); ++i) way += (i < 3 ? 1.5 : 0.5) * scale * std::abs(b[i] - a[i]);
  const long count = std::max(1L, long(way / 1e-3)), asked = std::min(count + 1, states_asked());
  for (long step = (count + 1 - asked) / 2, end = step + asked; step < end; ++step) {
    std::map<std::string, double> joints;
    for (std::size_t i = 0; i < a.size(); ++i) joints[names[i]] = a[i] + double(step) / double(count) * (b[i] - a[i]);
    const std::string violation = judge.violation(joints, clearance);
    EXPECT_EQ(violation, "") << "after " << step << " of " << count;
    if (!violation.empty()) break;
  }
  return asked;
}

class ProgramsOfRealArms : public testing::TestWithParam<Arm> {
 protected:
  const fs::path robots_ = fs::path(POSEWRIGHT_SHARED_DIR) / "robots";
  fs::path urdf() const { return robots_ / GetParam().name / GetParam().urdf; }

  Problem problem(const TemporaryFolder& folder) const {
    const double s = GetParam().scale;
    return read_problem(folder.write(
        "p.yaml",
        fmt::format(
            "posewright: 1\nrobot: {{urdf: \"{}\", base: {}, tip: {}}}\n"
            "measurement: {{type: pose, device: {{type: isotropic, noise: {{position: 0.1 mm, rotation: "
            "0.2 mrad}}}}}}\nvariants: {{all: {{parameters: auto}}}}\n"
            "workspace: {{joints: {{limits: {}}}, collision: {{clearance: 0.02, obstacles: [{{name: table, box: [{}, "
            "{}, 0.1], "
            "at: [{}, 0, -0.1]}}, {{name: post, box: [{}, {}, {}], at: [{}, {}, {}]}}]}}, motion: {{home: {}}}}}\n"
            "design: {{poses: 9, candidates: 60, restarts: 1, method: greedy}}\n",
            urdf().string(), GetParam().base, GetParam().tip, GetParam().limits, 1.2 * s, 1.6 * s, 0.2 * s, 0.3 * s,
            0.3 * s, s, 0.6 * s, 0.7 * s, 0.4 * s, GetParam().home)));
  }

  CellVerifier verifier(const Plan& plan) const {
    const double s = GetParam().scale;
    CellVerifier verifier(urdf(), robots_ / GetParam().name);
    verifier.skip(plan.statistics.cell.always_touching);
    verifier.add(CellVerifier::Box{{1.2 * s, 1.6 * s, 0.1}, {0.2 * s, 0, -0.1}});
    verifier.add(CellVerifier::Box{{0.3 * s, 0.3 * s, s}, {0.6 * s, 0.7 * s, 0.4 * s}});
    return verifier;
  }
};

TEST_P(ProgramsOfRealArms, DoWhatTheRouteDoesAndNothingComesNearOnTheWay) {
  if (!fs::exists(robots_)) GTEST_SKIP() << "the folder of shared robots is absent";
  const TemporaryFolder folder;
  const Problem problem = this->problem(folder);
  const auto [plan, route, sequence] = routed(problem, folder);
  const Moves planned = wanted(route);
  for (const Controller& controller : controllers) {
    ExportOptions words;
    words.controller = parse_controller_settings(settings_of(controller, 6), "c.yaml");
    if (std::string(controller.format) == "abb-rapid" || std::string(controller.format) == "fanuc-tp")
      words.coupling = controller.coupling;
    words.name = "CALPOSES";
    const bool turns_more = std::any_of(planned.begin(), planned.end(), [](const std::vector<double>& q) {
      return std::any_of(q.begin(), q.end(), [](double x) { return std::abs(x) > 2 * std::numbers::pi; });
    });
    if (turns_more && std::string(controller.format) == "urscript") {
      EXPECT_THROW(export_poses(find_pose_format(controller.format), sequence, words), CannotDo);
      continue;
    }
    const Moves moves = moves_of(controller, export_poses(find_pose_format(controller.format), sequence, words));
    ASSERT_EQ(moves.size(), planned.size()) << controller.format;
    for (std::size_t k = 0; k < moves.size(); ++k) {
      const std::vector<double> q = joints_of(controller, moves[k]);
      for (std::size_t i = 0; i < q.size(); ++i)
        ASSERT_NEAR(q[i], planned[k][i], controller.tolerance) << controller.format << " move " << k;
    }
  }
  // What the first program does, a millimetre of the farthest point at a time, judged by other code.
  ExportOptions words;
  words.controller = parse_controller_settings(settings_of(controllers.front(), 6), "c.yaml");
  const Moves moves = moves_of(controllers.front(), export_poses(find_pose_format("kuka-krl"), sequence, words));
  const CellVerifier judge = verifier(plan);
  long states = 0;
  for (std::size_t k = 1; k < moves.size() && states < states_asked(); ++k)
    states += scan(judge, route.names, joints_of(controllers.front(), moves[k - 1]),
                   joints_of(controllers.front(), moves[k]), GetParam().scale, 0.02);
  EXPECT_GT(states, 1000);
}

INSTANTIATE_TEST_SUITE_P(
    All, ProgramsOfRealArms,
    testing::Values(Arm{"abb_irb120_3_58", "abb_irb120_support/urdf/irb120_3_58.urdf", "base_link", "tool0", 0.6},
                    Arm{"staubli_tx2_90", "staubli_tx2_90_support/urdf/tx2_90.urdf", "base_link", "tool0", 1.0},
                    Arm{"fanuc_m10ia", "moveit_resources_fanuc_description/urdf/fanuc.urdf", "base_link", "tool0", 1.4},
                    Arm{"kuka_kr300_r2700_2", "kuka_quantec_support/urdf/kr300_r2700_2.urdf", "base_link", "tool0",
                        2.7},
                    Arm{"ur10", "example-robot-data/robots/ur_description/urdf/ur10_robot.urdf", "base_link", "tool0",
                        1.3, "{shoulder_lift_joint: -90 deg}",
                        "{shoulder_pan_joint: [-180 deg, 180 deg], shoulder_lift_joint: [-180 deg, 0 deg], "
                        "elbow_joint: [-150 deg, 150 deg], wrist_1_joint: [-180 "
                        "deg, 180 deg], wrist_2_joint: [-180 deg, 180 deg], wrist_3_joint: [-180 deg, 180 deg]}"}),
    [](const auto& instance) { return std::string(instance.param.name); });

class TrajectoriesOfRealArms : public ProgramsOfRealArms {};

/// Positions and times of a trajectory file.
std::pair<Moves, std::vector<double>> points_of(const Exported& exported) {
  std::pair<Moves, std::vector<double>> points;
  for (const auto& point : YAML::Load(exported.files.front().bytes)["points"]) {
    points.first.push_back(point["positions"].as<std::vector<double>>());
    points.second.push_back(point["time_from_start"]["sec"].as<double>() +
                            1e-9 * point["time_from_start"]["nanosec"].as<double>());
  }
  return points;
}

TEST_P(TrajectoriesOfRealArms, OfSevenAxesKeepSoftLimitsSpeedsAndTheCell) {
  if (!fs::exists(robots_)) GTEST_SKIP() << "the folder of shared robots is absent";
  const TemporaryFolder folder;
  const Problem problem = this->problem(folder);
  const auto [plan, route, sequence] = routed(problem, folder);
  const auto [points, times] = points_of(export_poses(find_pose_format("joint-trajectory"), sequence, {}));
  const Moves planned = wanted(route);
  // Between stops a trajectory has points of its own: those of the route come in their order.
  std::size_t next = 0;
  std::map<std::string, PlainUrdf::Joint> joints;
  for (const auto& [link, joint] : PlainUrdf(urdf()).above) joints.emplace(joint.name, joint);
  const CellVerifier judge = verifier(plan);
  long states = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (next < planned.size() &&
        testing::Matches(testing::Pointwise(testing::DoubleNear(1e-6), planned[next]))(points[k]))
      ++next;
    for (std::size_t i = 0; i < route.names.size(); ++i) {
      const PlainUrdf::Joint& joint = joints.at(route.names[i]);
      EXPECT_GE(points[k][i], std::max(joint.lower, joint.soft_lower)) << joint.name;
      EXPECT_LE(points[k][i], std::min(joint.upper, joint.soft_upper)) << joint.name;
      if (k == 0) continue;
      EXPECT_GT(times[k], times[k - 1]);
      EXPECT_LE(std::abs(points[k][i] - points[k - 1][i]) / (times[k] - times[k - 1]), joint.velocity * 1.0001);
    }
    if (k > 0 && states < states_asked())
      states += scan(judge, route.names, points[k - 1], points[k], GetParam().scale, 0.02);
  }
  EXPECT_EQ(next, planned.size());
  EXPECT_GT(states, 1000);
}

INSTANTIATE_TEST_SUITE_P(All, TrajectoriesOfRealArms,
                         testing::Values(Arm{"franka_panda", "moveit_resources_panda_description/urdf/panda.urdf",
                                             "panda_link0", "panda_link8", 0.9,
                                             "{panda_joint4: -90 deg, panda_joint6: 90 deg}"}),
                         [](const auto& instance) { return std::string(instance.param.name); });

/// Dimensions of an ABB IRB 2400 (ROS-Industrial's irb2400_macro.xacro at 04df6ec), links as boxes. Axis 3 as a serial
/// joint: its own limits are wide, the controller's are those of the lower arm's parallelogram.
const char* const parallelogram = R"(<robot name="irb2400"><link name="base"/>
<link name="l1"><collision><origin xyz="0 0 -0.3"/><geometry><box size="0.3 0.3 0.5"/></geometry></collision></link>
<link name="l2"><collision><origin xyz="0 0 0.35"/><geometry><box size="0.15 0.12 0.55"/></geometry></collision></link>
<link name="l3"><collision><origin xyz="0.25 0 0.135"/><geometry><box size="0.6 0.12 0.12"/></geometry></collision></link>
<link name="l4"/><link name="l5"/>
<link name="l6"><collision><origin xyz="0.04 0 0"/><geometry><box size="0.04 0.08 0.08"/></geometry></collision></link>
<joint name="j1" type="revolute"><parent link="base"/><child link="l1"/><origin xyz="0 0 0.615"/><axis xyz="0 0 1"/>
<limit lower="-3.1416" upper="3.1416" velocity="2.6" effort="1"/></joint>
<joint name="j2" type="revolute"><parent link="l1"/><child link="l2"/><origin xyz="0.1 0 0"/><axis xyz="0 1 0"/>
<limit lower="-1.7453" upper="1.9199" velocity="2.6" effort="1"/></joint>
<joint name="j3" type="revolute"><parent link="l2"/><child link="l3"/><origin xyz="0 0 0.705"/><axis xyz="0 1 0"/>
<limit lower="-2.6" upper="1.7" velocity="2.6" effort="1"/></joint>
<joint name="j4" type="revolute"><parent link="l3"/><child link="l4"/><origin xyz="0.258 0 0.135"/><axis xyz="1 0 0"/>
<limit lower="-3.49" upper="3.49" velocity="6.2" effort="1"/></joint>
<joint name="j5" type="revolute"><parent link="l4"/><child link="l5"/><origin xyz="0.497 0 0"/><axis xyz="0 1 0"/>
<limit lower="-2.09" upper="2.09" velocity="6.2" effort="1"/></joint>
<joint name="j6" type="revolute"><parent link="l5"/><child link="l6"/><origin xyz="0.085 0 0"/><axis xyz="1 0 0"/>
<limit lower="-6.98" upper="6.98" velocity="7.8" effort="1"/></joint></robot>)";

TEST(Programs, OfAParallelogramKeepTheControllersRangesAndTheCellOnEveryWay) {
  const TemporaryFolder folder;
  const fs::path arm = folder.write("arm.urdf", parallelogram);
  const fs::path settings = fs::path(POSEWRIGHT_SOURCE_DIR) / "controllers/abb_irb2400.yaml";
  const Problem problem = read_problem(folder.write(
      "p.yaml", fmt::format("posewright: 1\nrobot: {{urdf: arm.urdf, tip: l6}}\n"
                            "measurement: {{type: position, target: [0.1, 0, 0.05], device: {{type: isotropic, noise: "
                            "0.1 mm}}}}\nvariants: {{all: {{parameters: auto}}}}\n"
                            "workspace: {{joints: {{controller: \"{}\"}}, collision: {{clearance: 0.02, obstacles: ["
                            "{{name: post, box: [0.3, 0.3, 1.6], at: [0.7, 0.9, 0.8]}}, {{name: table, box: [2, 2, "
                            "0.1], at: [0, 0, -0.1]}}]}}}}\n"
                            "design: {{poses: 14, candidates: 100, restarts: 1, method: greedy}}\n",
                            settings.string())));
  const auto [plan, route, sequence] = routed(problem, folder);
  ExportOptions words;
  words.controller = parse_controller_settings(
      "coupling: -1\nrange_deg: [[-180, 180], [-100, 110], [-60, 65], [-200, 200], [-120, 120], [-400, 400]]\n", "c");
  words.coupling = -1;
  const Moves moves =
      readers::read_rapid(export_poses(find_pose_format("abb-rapid"), sequence, words).files[0].bytes).moves;
  ASSERT_EQ(moves.size(), wanted(route).size());
  const double range[6][2] = {{-180, 180}, {-100, 110}, {-60, 65}, {-200, 200}, {-120, 120}, {-400, 400}};
  CellVerifier judge(arm, folder.path());
  judge.skip(plan.statistics.cell.always_touching);
  judge.add(CellVerifier::Box{{0.3, 0.3, 1.6}, {0.7, 0.9, 0.8}});
  judge.add(CellVerifier::Box{{2, 2, 0.1}, {0, 0, -0.1}});
  const Controller abb{"abb-rapid", -1, std::vector<double>(6, 1), std::vector<double>(6, 0), 2e-6};
  double beyond_serial = 0;
  for (std::size_t k = 0; k < moves.size(); ++k) {
    for (std::size_t i = 0; i < 6; ++i) {
      EXPECT_GE(moves[k][i], range[i][0]) << "axis " << i + 1 << " at move " << k;
      EXPECT_LE(moves[k][i], range[i][1]) << "axis " << i + 1 << " at move " << k;
    }
    const std::vector<double> q = joints_of(abb, moves[k]);
    beyond_serial = std::max(beyond_serial, std::abs(q[2]) / degree);
    if (k > 0) scan(judge, route.names, joints_of(abb, moves[k - 1]), q, 1.5, 0.02);
  }
  // The ranges are those of the controller's axis, not of the joint.
  EXPECT_GT(beyond_serial, 65);
}

/// Seven joints: a rail and six axes.
const char* const on_a_rail =
    R"(<robot name="railed"><link name="base"/><link name="l0"/><link name="l1"/><link name="l2"/>
<link name="l3"/><link name="l4"/><link name="l5"/><link name="l6"/>
<joint name="rail" type="prismatic"><parent link="base"/><child link="l0"/><axis xyz="1 0 0"/>
<limit lower="-1.2" upper="2.6" velocity="1" effort="1"/></joint>
<joint name="a1" type="revolute"><parent link="l0"/><child link="l1"/><axis xyz="0 0 1"/>
<limit lower="-2.9" upper="2.9" velocity="2" effort="1"/></joint>
<joint name="a2" type="revolute"><parent link="l1"/><child link="l2"/><origin xyz="0.1 0 0.4"/><axis xyz="0 1 0"/>
<limit lower="-1.7" upper="1.7" velocity="2" effort="1"/></joint>
<joint name="a3" type="revolute"><parent link="l2"/><child link="l3"/><origin xyz="0 0 0.5"/><axis xyz="0 1 0"/>
<limit lower="-1.7" upper="1.7" velocity="2" effort="1"/></joint>
<joint name="a4" type="revolute"><parent link="l3"/><child link="l4"/><origin xyz="0.4 0 0.1"/><axis xyz="1 0 0"/>
<limit lower="-2.9" upper="2.9" velocity="3" effort="1"/></joint>
<joint name="a5" type="revolute"><parent link="l4"/><child link="l5"/><origin xyz="0.2 0 0"/><axis xyz="0 1 0"/>
<limit lower="-2.0" upper="2.0" velocity="3" effort="1"/></joint>
<joint name="a6" type="revolute"><parent link="l5"/><child link="l6"/><origin xyz="0.1 0 0"/><axis xyz="1 0 0"/>
<limit lower="-2.9" upper="2.9" velocity="3" effort="1"/></joint></robot>)";

/// A quick plan of the arm, as a program would take it.
std::pair<Plan, PoseSequence> planned(const std::string& urdf, const std::string& workspace = "") {
  const TemporaryFolder folder;
  folder.write("arm.urdf", urdf);
  const Problem problem = read_problem(folder.write(
      "p.yaml",
      "posewright: 1\nrobot: {urdf: arm.urdf, tip: l6}\nmeasurement: {type: position, target: [0.1, 0, 0.05], "
      "device: {type: isotropic, noise: 0.1 mm}}\nvariants: {all: {parameters: [\"a?.offset\"]}}\n"
      "design: {poses: 6, candidates: 60, restarts: 1, method: greedy}\n" +
          workspace));
  Plan plan = plan_problem(problem, {}, Monitor{});
  PoseSequence sequence = checked_sequence(problem, parse_sequence(plan_json(plan), "plan.json"));
  return {std::move(plan), std::move(sequence)};
}

TEST(Programs, OfARailHaveItInMillimetresAndTheOthersInDegrees) {
  const auto [plan, sequence] = planned(on_a_rail);
  ExportOptions words;
  words.controller = parse_controller_settings("axes: [E1, A1, A2, A3, A4, A5, A6]\n", "c.yaml");
  const Exported exported = export_poses(find_pose_format("kuka-krl"), sequence, words);
  const Moves moves = readers::read_krl(exported.files[0].bytes, exported.files[1].bytes, "CALPOSES").moves;
  ASSERT_EQ(moves.size(), 6U);
  for (std::size_t k = 0; k < 6; ++k) {
    // KRL has the six axes first, then what is outside of the arm.
    EXPECT_NEAR(moves[k][6], 1e3 * plan.poses[k].configuration[0].value, 1e-4);
    EXPECT_TRUE(moves[k][6] >= -1200 && moves[k][6] <= 2600);
    for (std::size_t i = 0; i < 6; ++i)
      EXPECT_NEAR(moves[k][i] * degree, plan.poses[k].configuration[i + 1].value, 1e-6);
  }
}

TEST(Programs, OfAnArmWithAFollowerKeepTheFollowersLimits) {
  std::string text = on_a_rail;
  const std::string third = "<joint name=\"a3\" type=\"revolute\">";
  text.insert(text.find(third) + third.size(), "<mimic joint=\"a2\" multiplier=\"-2\" offset=\"0.4\"/>");
  const PoseSequence sequence = planned(text).second;
  const YAML::Node trajectory =
      YAML::Load(export_poses(find_pose_format("joint-trajectory"), sequence, {}).files.front().bytes);
  double before = 0, last_time = 0;
  for (const auto& point : trajectory["points"]) {
    const double a2 = point["positions"][2].as<double>(), follower = -2 * a2 + 0.4;
    EXPECT_TRUE(follower >= -1.7 && follower <= 1.7) << follower;
    const double time =
        point["time_from_start"]["sec"].as<double>() + 1e-9 * point["time_from_start"]["nanosec"].as<double>();
    // A cubic between points at rest is one and a half times as fast as its mean; the follower twice its master.
    if (last_time > 0) {
      EXPECT_LE(1.5 * 2 * std::abs(a2 - before) / (time - last_time), 2 + 1e-9);
    }
    before = a2;
    last_time = time;
  }
}

/// How near the poses of a plan come to a limit of the arm on a rail, in parts of 1 % of the range or 2 deg or 5 mm.
double nearest_limit(const Plan& plan) {
  const std::array<std::pair<double, double>, 7> limits = {
      {{-1.2, 2.6}, {-2.9, 2.9}, {-1.7, 1.7}, {-1.7, 1.7}, {-2.9, 2.9}, {-2.0, 2.0}, {-2.9, 2.9}}};
  double nearest = 1e9;
  for (const PlannedPose& pose : plan.poses)
    for (std::size_t i = 0; i < limits.size(); ++i) {
      const auto [lower, upper] = limits[i];
      const double q = pose.configuration[i].value;
      nearest = std::min(nearest,
                         std::min(q - lower, upper - q) / std::min(0.01 * (upper - lower), i == 0 ? 5e-3 : 2 * degree));
    }
  return nearest;
}

TEST(Margins, KeepProposedPosesOffTheLimitsUnlessNoneIsAskedFor) {
  EXPECT_NEAR(nearest_limit(planned(on_a_rail).first), 1, 1e-9);
  EXPECT_NEAR(nearest_limit(planned(on_a_rail, "workspace: {joints: {margin: 0}}\n").first), 0, 1e-9);
  // What the problem's own limits keep further off is not narrowed once more.
  const Plan narrow = planned(on_a_rail, "workspace: {joints: {limits: {a2: [-1, 1]}}}\n").first;
  double farthest = 0;
  for (const PlannedPose& pose : narrow.poses) farthest = std::max(farthest, std::abs(pose.configuration[2].value));
  EXPECT_NEAR(farthest, 1, 1e-9);
}

}  // namespace
}  // namespace posewright
