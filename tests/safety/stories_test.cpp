// Three cells from the problem to the program, as an integrator goes through them: with vendors' kinematics and meshes,
// the program read back and every pose and motion of it judged by other code.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>
#include <regex>

#include "posewright/controller/known_controllers.hpp"
#include "posewright/formats/pose_formats.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/results/plan.hpp"
#include "posewright/support/file.hpp"
#include "posewright/tasks/check_sequence.hpp"
#include "posewright/tasks/plan_problem.hpp"
#include "posewright/tasks/route_problem.hpp"
#include "tests/formats/program_readers.hpp"
#include "tests/kit/design_edits.hpp"
#include "tests/kit/pose_lists.hpp"
#include "tests/kit/temporary_folder.hpp"
#include "tests/kit/verify_cell.hpp"

namespace posewright {
namespace {

namespace fs = std::filesystem;

/// A cell of examples/cells, written down a second time.
struct Story {
  const char *name, *folder, *urdf, *tip;
  const char *tool, *tool_geometry, *tool_at;  ///< as a link of a URDF
  double clearance;
  std::function<void(CellVerifier&)> surround;
  const char *format, *controller;
  double unit;  ///< rad, of the program's numbers
};
void PrintTo(const Story& story, std::ostream* out) { *out << story.name; }

const fs::path cells = fs::path(POSEWRIGHT_SOURCE_DIR) / "examples/cells";
const fs::path vendors = fs::path(POSEWRIGHT_SHARED_DIR) / "robots";

class Stories : public testing::TestWithParam<Story> {
 protected:
  Problem problem(const TemporaryFolder& folder) const {
    fs::copy_file(cells / "reflector_plate.stl", folder / "reflector_plate.stl");
    const std::string text = read_file(cells / (std::string(GetParam().name) + ".yaml"));
    Problem problem =
        read_problem(folder.write("cell.yaml", std::regex_replace(text, std::regex("ROBOTS"), vendors.string())));
    for (const auto& package : fs::directory_iterator(vendors / GetParam().folder))
      if (package.is_directory()) problem.packages.emplace_back(package.path().filename().string(), package.path());
    return problem;
  }

  /// The same surroundings for other code: the tool is one more link.
  CellVerifier judge(const TemporaryFolder& folder, const Plan& plan) const {
    const Story& story = GetParam();
    std::string urdf = read_file(vendors / story.folder / story.urdf);
    const std::string tool = std::string("<link name=\"") + story.tool + "\"><collision><origin xyz=\"" +
                             story.tool_at + "\"/><geometry>" + story.tool_geometry +
                             "</geometry></collision></link><joint name=\"holds_tool\" type=\"fixed\"><parent link=\"" +
                             story.tip + "\"/><child link=\"" + story.tool + "\"/></joint></robot>";
    urdf.replace(urdf.rfind("</robot>"), 8, std::regex_replace(tool, std::regex("CELLS"), cells.string()));
    CellVerifier judge(folder.write("with_tool.urdf", urdf), vendors / story.folder);
    judge.skip(plan.statistics.cell.always_touching);
    story.surround(judge);
    return judge;
  }

  readers::Program read(const Exported& exported) const {
    const auto& files = exported.files;
    if (std::string(GetParam().format) == "kuka-krl")
      return readers::read_krl(files[0].bytes, files[1].bytes, "CALPOSES");
    if (std::string(GetParam().format) == "abb-rapid") return readers::read_rapid(files[0].bytes);
    return readers::read_urscript(files[0].bytes);
  }
};

std::map<std::string, double> joints_of(const std::vector<std::string>& names, const std::vector<double>& q) {
  std::map<std::string, double> joints;
  for (std::size_t i = 0; i < names.size(); ++i) joints[names[i]] = q[i];
  return joints;
}

TEST_P(Stories, LeadFromTheProblemToAProgramThatKeepsItsCellAndSaysHowNearThingsCome) {
  if (!fs::exists(vendors)) GTEST_SKIP() << "the folder of shared robots is absent";
  const Story& story = GetParam();
  const TemporaryFolder folder;
  const Problem problem = this->problem(folder);
  DesignEdits options;
  options.edit("poses", 8);
  options.edit("candidates", 120);
  options.edit("method", "exchange");
  options.edit("restarts", 1);
  const Plan plan = planned(problem, options);
  ASSERT_EQ(plan.poses.size(), 8U);
  long rejected = 0;
  for (const auto& [reason, count] : plan.statistics.rejected) rejected += count;
  EXPECT_EQ(plan.statistics.drawn, plan.statistics.feasible + rejected) << "samples and rejections add up";

  // Clearances as stated, at every pose.
  const CellVerifier judge = this->judge(folder, plan);
  for (const PlannedPose& pose : plan.poses) {
    std::map<std::string, double> joints;
    for (const NamedValue& value : pose.configuration) joints[value.name] = value.value;
    EXPECT_EQ(judge.violation(joints, story.clearance), "") << pose.id;
    ASSERT_TRUE(pose.nearest.has_value());
    EXPECT_NEAR(pose.nearest->distance, judge.nearest(joints, story.tool), 1e-4)
        << pose.id << " " << pose.nearest->first << " and " << pose.nearest->second;
  }

  // The route's program, read back, passes through the route's points and nothing comes near between them.
  RouteOptions way;
  way.from_home = way.closed = true;
  const Route route =
      route_problem(problem, poses_in(problem, folder.write("plan.json", plan_json(plan))), way, Monitor{});
  EXPECT_TRUE(route.unreachable.empty());
  const PoseSequence sequence = checked_sequence(problem, parse_sequence(route_json(route), "route.json"));
  ExportOptions words;
  words.controller = controller_settings(story.controller);
  words.name = "CALPOSES";
  const auto moves = read(export_poses(find_pose_format(story.format), sequence, words)).moves;
  std::vector<std::vector<double>> planned = {route.home};
  for (const RouteMotion& motion : route.motions)
    planned.insert(planned.end(), motion.points.begin() + 1, motion.points.end());
  ASSERT_EQ(moves.size(), planned.size());
  constexpr int states = 60;  // of each motion
  for (std::size_t k = 0; k < moves.size(); ++k) {
    for (std::size_t i = 0; i < 6; ++i) ASSERT_NEAR(moves[k][i] * story.unit, planned[k][i], 2e-6) << k;
    for (int s = 1; k > 0 && s <= states; ++s) {
      std::vector<double> q = planned[k];
      for (std::size_t i = 0; i < 6; ++i)
        q[i] = story.unit * (moves[k - 1][i] + s * (moves[k][i] - moves[k - 1][i]) / states);
      const std::string violation = judge.violation(joints_of(route.names, q), story.clearance);
      EXPECT_EQ(violation, "") << "move " << k << " state " << s;
      if (!violation.empty()) break;
    }
  }
  // A tool and the link before it may be near by design: the plan says what they keep.
  double least = story.clearance;
  for (const BodyDistance& reduced : plan.statistics.cell.reduced) least = std::min(least, reduced.distance);
  // Of a motion the smallest clearance on the way: what is found at its states is not less.
  for (const RouteMotion& motion : route.motions) {
    ASSERT_TRUE(motion.nearest.has_value());
    double found = 1e9;
    for (std::size_t p = 1; p < motion.points.size(); ++p)
      for (int s = 0; s <= 20; ++s) {
        std::vector<double> q = motion.points[p];
        for (std::size_t i = 0; i < q.size(); ++i)
          q[i] += (s / 20.0 - 1) * (motion.points[p][i] - motion.points[p - 1][i]);
        found = std::min(found, judge.nearest(joints_of(route.names, q), story.tool));
      }
    EXPECT_LE(motion.nearest->distance, found + 1e-4) << motion.from << " to " << motion.to;
    EXPECT_GE(motion.nearest->distance, least);
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, Stories,
    testing::Values(Story{"kuka_tracker", "kuka_kr300_r2700_2", "kuka_quantec_support/urdf/kr300_r2700_2.urdf", "tool0",
                          "plate", "<box size=\"0.3 0.3 0.03\"/>", "0 0 0.03", 0.03,
                          [](CellVerifier& judge) {
                            judge.add(CellVerifier::Wall{{0, 0, 1}, {0, 0, -0.01}});
                            judge.add(CellVerifier::Box{{1.2, 0.8, 0.7}, {1.9, 0.3, 0.35}});
                            judge.add(CellVerifier::Cylinder{0.08, 2.5, {1.2, 1.6, 1.25}});
                            judge.add(CellVerifier::Cylinder{0.08, 2.5, {1.2, -1.8, 1.25}});
                            judge.add(CellVerifier::Cylinder{0.12, 1.2, {4.2, -1.2, 0.3}});
                          },
                          "kuka-krl", "kuka-kr-c4", std::numbers::pi / 180},
                    Story{"abb_tracker", "abb_irb120_3_58", "abb_irb120_support/urdf/irb120_3_58.urdf", "tool0",
                          "plate", "<mesh filename=\"package://CELLS/reflector_plate.stl\"/>", "0 0 0", 0.015,
                          [](CellVerifier& judge) {
                            judge.add(CellVerifier::Wall{{0, 0, 1}, {0, 0, -0.005}});
                            judge.add(CellVerifier::Wall{{1, 0, 0}, {-0.6, 0, 0}});
                          },
                          "abb-rapid", "abb-irb120", std::numbers::pi / 180},
                    Story{"ur_camera", "ur10", "example-robot-data/robots/ur_description/urdf/ur10_robot.urdf", "tool0",
                          "camera", "<box size=\"0.1 0.05 0.04\"/>", "0 0.06 0", 0.02,
                          [](CellVerifier& judge) {
                            judge.add(CellVerifier::Wall{{0, 0, 1}, {0, 0, 0}});
                          },
                          "urscript", "universal-robots", 1.0}),
    [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace posewright
