// Plans and routes in cells: three real arms with their meshes, judged again by other code; the example cell.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "posewright/formats/pose_sequence.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/results/plan.hpp"
#include "posewright/support/json.hpp"
#include "posewright/tasks/evaluate_problem.hpp"
#include "posewright/tasks/place_stations.hpp"
#include "posewright/tasks/plan_problem.hpp"
#include "posewright/tasks/route_problem.hpp"
#include "tests/kit/design_edits.hpp"
#include "tests/kit/message_of.hpp"
#include "tests/kit/pose_lists.hpp"
#include "tests/kit/temporary_folder.hpp"
#include "tests/kit/verify_cell.hpp"

namespace posewright {
namespace {

using testing::HasSubstr;

/// The full figures take minutes: POSEWRIGHT_CANDIDATES=10000 POSEWRIGHT_STEP=5e-5 asks for them.
double setting(const char* name, double standard) {
  const char* text = std::getenv(name);
  return text == nullptr ? standard : std::atof(text);
}

struct CellRobot {
  const char* name;
  const char* urdf;
  double scale;  ///< of the cell, with the arm's size
};
void PrintTo(const CellRobot& robot, std::ostream* out) { *out << robot.name; }

class CellOfRealArm : public testing::TestWithParam<CellRobot> {};

std::string cell_problem(const std::filesystem::path& urdf, double s) {
  const auto n = [s](double x) { return std::to_string(x * s); };
  return "posewright: 1\nrobot: {urdf: \"" + urdf.string() + "\", base: base_link, tip: tool0}\n" +
         "measurement: {type: position, target: [0.05, 0, 0.03], device: {type: laser_tracker, stations: {A: [" + n(4) +
         ", " + n(1) + ", " + n(0.6) +
         "]}}}\nvariants: {all: {parameters: auto, nuisance: [\"base.*\", \"target.*\"]}}\n" +
         "workspace:\n  joints: {margin: 3 deg}\n  collision:\n    clearance: 0.02\n    obstacles:\n" +
         "      - {name: table, box: [" + n(1.2) + ", " + n(1.6) + ", 0.1], at: [" + n(0.2) + ", 0, -0.1]}\n" +
         "      - {name: post, box: [" + n(0.3) + ", " + n(0.3) + ", " + n(1) + "], at: [" + n(0.6) + ", " + n(0.7) +
         ", " + n(0.4) + "]}\n" + "      - {name: wall, plane: [0, 1, 0], at: [0, " + n(-0.9) + ", 0]}\n" +
         "      - {name: tracker, cylinder: {radius: 0.1, length: 1}, at: [" + n(4) + ", " + n(1) +
         ", 0.2], station: A}\n" +
         "  line_of_sight: {visible: all, range: [0.3, 20], elevation: [-60 deg, 77 deg], acceptance: 80 deg, "
         "normals: {\"*\": [0, 0, 1]}}\n" +
         "design: {criterion: o1, poses: 12, candidates: " +
         std::to_string(int(setting("POSEWRIGHT_CANDIDATES", 150))) + ", restarts: 1, method: exchange}\n";
}

TEST_P(CellOfRealArm, PosesAndMotionsHoldWhenOtherCodeLooksAtThem) {
  const std::filesystem::path robots = std::filesystem::path(POSEWRIGHT_SHARED_DIR) / "robots";
  if (!std::filesystem::exists(robots)) GTEST_SKIP() << "the folder of shared robots is absent";
  const CellRobot& robot = GetParam();
  const std::filesystem::path urdf = robots / robot.name / robot.urdf;
  const double s = robot.scale, step = setting("POSEWRIGHT_STEP", 0.03);
  const TemporaryFolder folder;
  const Problem problem = read_problem(folder.write("p.yaml", cell_problem(urdf, s)));
  const Plan plan = plan_problem(problem, {}, Monitor{});
  long rejected = 0;
  for (const auto& [reason, count] : plan.statistics.rejected) rejected += count;
  EXPECT_EQ(plan.statistics.drawn, plan.statistics.feasible + rejected);
  const auto file = folder.write("plan.json", plan_json(plan));
  RouteOptions options;
  options.closed = true;
  const Route route = route_problem(problem, poses_in(problem, file), options, Monitor{});
  EXPECT_EQ(route.poses.size() + route.unreachable.size(), 12U);
  EXPECT_LE(route.unreachable.size(), 2U);
  EXPECT_EQ(route.motions.size(), route.poses.size());

  CellVerifier verifier(urdf, robots / robot.name);
  verifier.skip(plan.statistics.cell.always_touching);
  verifier.add(CellVerifier::Box{{1.2 * s, 1.6 * s, 0.1}, {0.2 * s, 0, -0.1}});
  verifier.add(CellVerifier::Box{{0.3 * s, 0.3 * s, s}, {0.6 * s, 0.7 * s, 0.4 * s}});
  verifier.add(CellVerifier::Wall{{0, 1, 0}, {0, -0.9 * s, 0}});
  const auto joints = [&](const std::vector<double>& q) {
    std::map<std::string, double> named;
    for (std::size_t i = 0; i < route.names.size(); ++i) named[route.names[i]] = q[i];
    return named;
  };
  long states = 0;
  for (const RouteMotion& motion : route.motions)
    for (std::size_t k = 1; k < motion.points.size(); ++k) {
      const std::vector<double>&a = motion.points[k - 1], &b = motion.points[k];
      // No point of such an arm moves further than three times its size for a radian of one joint.
      double way = 0;
      for (std::size_t i = 0; i < a.size(); ++i) way += 1.5 * s * std::abs(b[i] - a[i]);
      const long count = std::max(1L, long(way / step));
      for (long i = 0; i <= count; ++i, ++states) {
        std::vector<double> q(a.size());
        for (std::size_t j = 0; j < q.size(); ++j) q[j] = a[j] + double(i) / double(count) * (b[j] - a[j]);
        ASSERT_EQ(verifier.violation(joints(q), 0.02), "") << motion.from << " to " << motion.to;
      }
    }
  for (const PlannedPose& pose : route.poses)
    for (const TargetSight& sight : pose.sights) EXPECT_EQ(sight.hidden_by, "");
  RecordProperty("states", std::to_string(states));
}

INSTANTIATE_TEST_SUITE_P(All, CellOfRealArm,
                         testing::Values(CellRobot{"kuka_kr300_r2700_2", "kuka_quantec_support/urdf/kr300_r2700_2.urdf",
                                                   2.2},
                                         CellRobot{"abb_irb120_3_58", "abb_irb120_support/urdf/irb120_3_58.urdf", 0.6},
                                         CellRobot{"staubli_tx2_90", "staubli_tx2_90_support/urdf/tx2_90.urdf", 1.0}),
                         [](const auto& instance) { return std::string(instance.param.name); });

Problem example_cell() {
  return read_problem(std::filesystem::path(POSEWRIGHT_SOURCE_DIR) / "examples/cell/problem.yaml");
}

DesignEdits quick_cell(int threads) {
  DesignEdits options =
      DesignEdits().edit("poses", 12).edit("candidates", 100).edit("restarts", 1).edit("method", "exchange");
  options.threads = threads;
  return options;
}

TEST(ExampleCell, PlanAndRouteAreTheSameOnAnyNumberOfThreadsAndShorterThanThePlansOrder) {
  Problem problem = example_cell();
  // What OMPL's roadmap says is tested by the route below; here it would take the most time.
  problem.workspace.motion.reachable = false;
  Plan one = planned(problem, quick_cell(1)), two = planned(problem, quick_cell(2));
  one.statistics.seconds = two.statistics.seconds = 0;
  for (Plan* plan : {&one, &two})
    for (PlanStage& stage : plan->statistics.stages) stage.seconds = 0;
  EXPECT_EQ(plan_json(one), plan_json(two));
  const TemporaryFolder folder;
  const auto file = folder.write("plan.json", plan_json(one));
  RouteOptions options;
  options.from_home = options.closed = true;
  options.threads = 1;
  Route first = route_problem(problem, poses_in(problem, file), options, Monitor{});
  options.threads = 2;
  Route second = route_problem(problem, poses_in(problem, file), options, Monitor{});
  EXPECT_EQ(route_json(first), route_json(second));
  EXPECT_LT(first.travel_seconds(), first.planned_seconds);
  EXPECT_EQ(first.motions.front().from, 0);
  EXPECT_EQ(first.motions.back().to, 0);
  EXPECT_FALSE(first.references.empty());
  for (std::size_t i = 1; i < first.motions.size(); ++i) {
    EXPECT_EQ(first.motions[i].from, first.motions[i - 1].to);
    EXPECT_EQ(first.motions[i].points.front(), first.motions[i - 1].points.back());
  }
}

TEST(ExampleCell, ReadingTakesItsTimeForEveryTargetThatATrackerSees) {
  Problem problem = example_cell();
  problem.workspace.motion.reachable = false;
  problem.measurement.repeats = 3;
  const TemporaryFolder folder;
  const auto file = folder.write("plan.json", plan_json(planned(problem, quick_cell(0))));
  RouteOptions options;
  const Route quick = route_problem(problem, poses_in(problem, file), options, Monitor{});
  options.reading = 2;
  options.settle = 7;
  const Route slow = route_problem(problem, poses_in(problem, file), options, Monitor{});
  const nlohmann::json json = parse_json(route_json(slow));
  // From what is written: three readings of two seconds of whatever is seen.
  double seen = 0;
  for (const auto* list : {&json["poses"], &json["references"]})
    for (const auto& stop : *list)
      for (const auto& target : stop["targets"]) seen += target["visible"].get<bool>();
  EXPECT_GT(seen, double(slow.poses.size()));
  EXPECT_NEAR(json["seconds"]["reading"].get<double>(), 3 * 2 * seen, 1e-9);
  EXPECT_NEAR(json["seconds"]["settle"].get<double>(), 7 * double(slow.poses.size()), 1e-9);
  EXPECT_EQ(quick.reading_seconds(), 0);
  EXPECT_EQ(quick.travel_seconds(), slow.travel_seconds());
  EXPECT_THAT(route_summary(slow), HasSubstr("of readings"));
}

TEST(ExampleCell, HomeInCollisionIsSaidWithWhatCollides) {
  Problem problem = example_cell();
  problem.workspace.motion.reachable = false;
  const TemporaryFolder folder;
  const auto file = folder.write("plan.json", plan_json(planned(problem, quick_cell(0))));
  // Stretched out over the fixture and down into it.
  problem.workspace.motion.home = {{{"joint_a2", 1}, {-0.1, Quantity::angle}},
                                   {{"joint_a3", 1}, {0.4, Quantity::angle}}};
  RouteOptions options;
  options.from_home = true;
  EXPECT_THAT(message_of<CannotDo>([&] { route_problem(problem, poses_in(problem, file), options, Monitor{}); }),
              testing::AllOf(HasSubstr("home is not free"), HasSubstr("fixture")));
}

TEST(ExampleCell, APoseThatIsNoLongerFreeIsLeftOutAndNamed) {
  Problem problem = example_cell();
  problem.workspace.motion.reachable = false;
  const TemporaryFolder folder;
  const Plan plan = planned(problem, quick_cell(0));
  const auto file = folder.write("plan.json", plan_json(plan));
  // A new obstacle where the tip of pose 3 is.
  const Eigen::Vector3d p = plan.poses[2].tool_pose->translation();
  problem.workspace.collision->obstacles.push_back({"newcomer", SphereShape{0.2}, {p, Eigen::Vector3d::Zero()}, "", 1});
  const Route route = route_problem(problem, poses_in(problem, file), {}, Monitor{});
  ASSERT_FALSE(route.unreachable.empty());
  bool named = false;
  for (const SkippedPose& skipped : route.unreachable)
    if (skipped.pose == 3) {
      named = true;
      EXPECT_THAT(skipped.reason, HasSubstr("newcomer"));
    }
  EXPECT_TRUE(named);
  for (const PlannedPose& pose : route.poses) EXPECT_NE(pose.id, 3);
  // What is left, as `plan` and `evaluate` judge the two lists.
  const PoseList all = poses_in(problem, file);
  PoseList kept;
  for (std::size_t i = 0; i < all.configurations.size(); ++i)
    if (std::any_of(route.poses.begin(), route.poses.end(), [&](const PlannedPose& p) { return p.id == all.ids[i]; }))
      kept.configurations.push_back(all.configurations[i]);
  const Plan left = evaluate_problem(quick_cell(0).of(problem), kept, {}, Monitor{}).plan;
  ASSERT_TRUE(route.worth.has_value());
  const double interest = std::count_if(left.parameters.begin(), left.parameters.end(), [](const auto& p) {
    return p.label.role == Role::interest && p.dropped_because.empty();
  });
  EXPECT_NEAR(route.worth->efficiency, std::exp((left.log_det - plan.log_det) / interest), 1e-9);
  EXPECT_LT(route.worth->efficiency, 1);
  const std::string json = route_json(route);
  const PoseSequence sequence = parse_sequence(json, "route.json");
  EXPECT_EQ(sequence.left_out, route.unreachable.size());
  EXPECT_NEAR(*sequence.worth, route.worth->efficiency, 1e-12);
  EXPECT_THAT(route_summary(route),
              testing::StartsWith(fmt::format("{} of {} pose", route.unreachable.size(), plan.poses.size())));
}

TEST(Stations, ThatSeesTheReflectorsIsRankedAboveTheOneBehindTheWall) {
  Problem problem = example_cell();
  problem.workspace.motion.reachable = false;
  problem.workspace.stations->list = {{"behind", {{0, 4, 0.5}, Eigen::Vector3d::Zero()}},
                                      {"front", {{3.6, -1.4, 0.5}, Eigen::Vector3d::Zero()}},
                                      {"in_the_fixture", {{1.9, 0.2, -0.4}, Eigen::Vector3d::Zero()}}};
  StationOptions options;
  options.full = 1;
  const std::vector<StationRank> ranks = place_stations(quick_cell(0).of(problem), options, Monitor{});
  ASSERT_EQ(ranks.size(), 3U);
  EXPECT_EQ(ranks[0].stations.front().name, "front");
  EXPECT_TRUE(ranks[0].in_full);
  EXPECT_DOUBLE_EQ(ranks[0].phi, planned(problem, quick_cell(0)).log_det);
  for (std::size_t i = 1; i < 3; ++i) EXPECT_NE(ranks[i].why_not, "") << ranks[i].stations.front().name;
}

}  // namespace
}  // namespace posewright
