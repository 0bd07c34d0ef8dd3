// A problem before its plan: what is drawn, what is wrong with it in space, and the verdicts of its configurations.

#include "posewright/report/draw_problem.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "posewright/support/file.hpp"
#include "posewright/support/json.hpp"
#include "tests/kit/example_problems.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// A KR 270 at a tracker, with this block in its file.
ProblemReport drawn_problem(const std::string& workspace, bool ways = true) {
  const TemporaryFolder folder;
  const std::string urdf = (examples_folder() / "kr270/kr270.urdf").string();
  const auto file =
      folder.write("problem.yaml", "posewright: 1\nrobot: {urdf: " + urdf +
                                       ", base: base_link, tip: flange}\n"
                                       "measurement:\n  type: points\n  targets: {P1: [0.24, 0.03, -0.1]}\n"
                                       "  device: {type: laser_tracker, stations: {A: [4, -1, 0.5]}}\n"
                                       "variants: {geometric: {parameters: auto}}\ndesign: {poses: 20}\n" +
                                       workspace);
  DrawOptions options;
  options.evenly = 60;
  options.feasible = 10;
  options.ways = ways;
  return draw_problem(read_problem(file), options, Monitor{});
}

std::string verdict(const ProblemReport& report, std::size_t place) {
  const int v = report.verdicts[place];
  return v < 0 ? "" : report.reasons[std::size_t(v)];
}

/// Positions of the obstacle `box` at the tip's keyframes, by the frame that carries the cell and by its own.
std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> places_of_box(const Report& scene,
                                                                       const Eigen::Vector3d& p_CellBox) {
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> places;
  for (const ReportKeyframe& k : scene.keyframes)
    for (const ReportBody& body : scene.bodies)
      if (body.name == "box")
        places.emplace_back(k.frames[std::size_t(scene.cell_frame)] * (scene.X_FrameCell * p_CellBox),
                            (k.frames[std::size_t(body.frame)] * body.X_FrameBody).translation());
  return places;
}

TEST(DrawProblem, TellsWhereTheCellStands) {
  const std::string box =
      "workspace: {collision: {obstacles: [{name: box, box: [0.1, 0.1, 0.1], at: [1.5, -2, 0.25]}]}}\n";
  const Report still = drawn_problem(box).scene;
  EXPECT_EQ(still.cell_frame, 0);
  EXPECT_TRUE(still.X_FrameCell.isApprox(Eigen::Isometry3d::Identity()));

  // Both arms of a torso that stands move the frame of the measurement.
  const TemporaryFolder folder;
  std::string text = read_file(examples_folder() / "two_arms/left_sees_right.yaml");
  const std::string robot = "urdf: two_arms.urdf", collision = "collision: {";
  text.replace(text.find(robot), robot.size(), "urdf: " + (examples_folder() / "two_arms/two_arms.urdf").string());
  text.replace(text.find(collision), collision.size(),
               collision + "obstacles: [{name: box, box: [0.1, 0.1, 0.1], at: [1.5, -2, 0.25]}], ");
  DrawOptions options;
  options.evenly = 10;
  options.feasible = 0;
  const Report moving = draw_problem(read_problem(folder.write("problem.yaml", text)), options, Monitor{}).scene;
  EXPECT_GT(moving.cell_frame, 0);
  const auto places = places_of_box(moving, {1.5, -2, 0.25});
  ASSERT_GE(places.size(), 11u);
  for (const auto& [by_cell, drawn] : places) EXPECT_LT((by_cell - drawn).norm(), 1e-9);
  EXPECT_GT((places.front().second - places.back().second).norm(), 0.01) << "the base moves";
}

/// Whether a pinhole sees all points of the board of `camera` at a keyframe, and how near to its picture's rim, px.
double least_distance_to_rim(const ReportCamera& camera, const ReportKeyframe& at, double focal) {
  const Eigen::Isometry3d X_CameraBoard =
      (at.frames[std::size_t(camera.camera_frame)] * camera.X_FrameCamera).inverse() *
      at.frames[std::size_t(camera.board_frame)] * camera.X_FrameBoard;
  double least = camera.width;
  for (const auto& [name, position] : camera.points) {
    const Eigen::Vector3d p = X_CameraBoard * position;
    if (p.z() <= 0) return -camera.width;
    const double u = focal * p.x() / p.z() + camera.width / 2, v = focal * p.y() / p.z() + camera.height / 2;
    least = std::min({least, u, camera.width - u, v, camera.height - v});
  }
  return least;
}

TEST(DrawProblem, DrawsOfSeveralInstrumentsThatWhichReads) {
  DrawOptions options;
  options.evenly = 80;
  options.feasible = 30;
  options.ways = false;
  const ProblemReport report =
      draw_problem(read_problem(examples_folder() / "humanoid/both_hands.yaml"), options, Monitor{});
  const Report& scene = report.scene;
  ASSERT_EQ(scene.cameras.size(), 2u);
  ASSERT_EQ(scene.stations.size(), 1u);
  EXPECT_EQ(scene.stations[0].instrument, "tracker");
  EXPECT_LT((scene.stations[0].X_MeasureStation.translation() - Eigen::Vector3d(3, 0, 1.2)).norm(), 1e-12);
  EXPECT_THAT(scene.targets, ElementsAre("tracker.P1", "tracker.P2", "tracker.P3"));
  std::map<std::string, std::set<bool>> seen;
  for (std::size_t k = 0; k < scene.keyframes.size(); ++k) {
    const ReportKeyframe& at = scene.keyframes[k];
    ASSERT_EQ(at.targets.size(), 3u);
    for (std::size_t t = 0; t < 3; ++t) EXPECT_EQ(at.targets[t].has_value(), at.instrument == "tracker");
    if (at.instrument == "tracker") {
      EXPECT_LT((*at.targets[2] - at.tip * Eigen::Vector3d(0.03, 0, -0.16)).norm(), 1e-12);
      continue;
    }
    const ReportCamera& camera = scene.cameras[at.instrument == "left_board" ? 0 : 1];
    EXPECT_EQ(camera.instrument, at.instrument);
    const std::string why = verdict(report, k);
    const double rim = least_distance_to_rim(camera, at, 920);
    if (why.empty()) {
      EXPECT_GE(rim, 0) << "drawn as it is judged";
    }
    if (why.starts_with("board not in the image")) {
      EXPECT_LT(rim, 0);
    }
    seen[at.instrument].insert(rim >= 0);
  }
  EXPECT_EQ(seen["left_board"].size(), 2u);
  EXPECT_EQ(seen["right_board"].size(), 2u);
}

TEST(DrawProblem, HasOneVerdictAKeyframeThatItsTipShows) {
  const ProblemReport report = drawn_problem("workspace: {tool: {z: [0.2, 1.6]}}\n");
  EXPECT_THAT(report.faults, IsEmpty());
  EXPECT_EQ(report.evenly, 60);
  ASSERT_EQ(report.verdicts.size(), 71u);  // home, even ones, feasible ones
  ASSERT_EQ(report.scene.keyframes.size(), report.verdicts.size());
  std::set<std::string> met;
  for (std::size_t k = 0; k < report.verdicts.size(); ++k) {
    const double z = report.scene.keyframes[k].tip.translation().z();
    EXPECT_EQ(verdict(report, k), z < 0.2 || z > 1.6 ? "tool outside its box" : "") << z;
    met.insert(verdict(report, k));
    EXPECT_TRUE(k <= 60 || report.verdicts[k] == -1);
  }
  EXPECT_EQ(met.size(), 2u);
}

TEST(DrawProblem, NamesWhatIsWrongInSpaceAndDrawsItAllTheSame) {
  const ProblemReport inside = drawn_problem(
      "workspace:\n  line_of_sight: {visible: 1}\n"
      "  collision: {obstacles: [{name: hall, box: [2, 2, 2], at: [4, -1, 0.5]}]}\n");
  EXPECT_THAT(inside.faults, ElementsAre(HasSubstr("problem.yaml:10: station A stands inside hall")));
  EXPECT_EQ(inside.scene.stations.size(), 1u);
  EXPECT_EQ(inside.scene.bodies.back().name, "hall");

  const std::string table =
      "workspace:\n  motion: {reachable: true}\n"
      "  collision: {obstacles: [{name: table, plane: [0, 0, 1], at: [0, 0, 0.6]}]}\n";
  const ProblemReport home = drawn_problem(table);
  EXPECT_THAT(home.faults, Contains(HasSubstr("home is not free")));
  EXPECT_THAT(verdict(home, 0), HasSubstr("collision"));
  const ProblemReport brief = drawn_problem(table, false);
  EXPECT_THAT(brief.faults, Not(Contains(HasSubstr("home is not free"))));
  EXPECT_THAT(verdict(brief, 0), HasSubstr("collision"));
}

TEST(DrawProblem, AProblemIsYamlThatHoldsNoParameters) {
  const TemporaryFolder folder;
  EXPECT_TRUE(is_problem(folder.write("a.yaml", "posewright: 1\n")));
  EXPECT_FALSE(is_problem(folder.write("b.yaml", "# of calibrate\nposewright_parameters: 1\n")));
  EXPECT_FALSE(is_problem(folder.write("c.json", "{}")));
}

TEST(DrawProblem, ItsDataAreThoseOfAPage) {
  const ProblemReport report = drawn_problem("");
  const auto data = parse_json(report_json(report));
  EXPECT_EQ(data["schema"], "posewright/report-of-problem/1");
  EXPECT_EQ(data["keyframes"].size(), data["verdicts"].size());
  EXPECT_EQ(data["keyframes"][0]["pose"], 0);
  EXPECT_EQ(data["frames"].size(), report.scene.frames.size());
  EXPECT_THAT(report_html(report), HasSubstr("posewright/report-of-problem/1"));
}

}  // namespace
}  // namespace posewright
