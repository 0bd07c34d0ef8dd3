// Pages of results: what a file is told from what it says of itself, and the page holds it as it is.

#include "posewright/report/report_result.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "posewright/lists/pose_list.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/results/calibration.hpp"
#include "posewright/results/stations.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/json.hpp"
#include "posewright/tasks/calibrate_problem.hpp"
#include "posewright/tasks/simulate_problem.hpp"
#include "tests/kit/example_problems.hpp"
#include "tests/kit/pose_lists.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// Readings of a virtual KR 270, calibrated with every fourth pose held back.
json calibration_of_kr270(const TemporaryFolder& folder) {
  const Problem problem = example("kr270/problem.yaml");
  SimulateOptions simulate;
  simulate.validation = 2;
  simulate.experiment.draws = 2;
  const Simulation made = simulate_problem(problem, given_poses(problem, list_of(problem, 16)), simulate, Monitor{});
  CalibrateOptions options;
  options.data = folder.write("measured.csv", made.first_readings);
  options.hold_back = 4;
  return parse_json(json_text(calibration_json(problem, options, calibrate_problem(problem, options, Monitor{}))));
}

TEST(ReportResult, ResidualsBeforeAndAfterGiveTheErrorsByAxis) {
  const TemporaryFolder folder;
  const json c = calibration_of_kr270(folder);
  EXPECT_EQ(c["before"], "placed");
  // Along x, y and z of the tracker lie the readings P1.x, P1.y, P1.z, P2.x, …
  const std::map<std::string, std::size_t> axes = {{"x", 0}, {"y", 1}, {"z", 2}};
  int compared = 0;
  for (const json& stated : c["axes"]) {
    const auto axis = axes.find(stated["axis"]);
    if (axis == axes.end()) continue;
    for (const auto& [key, errors] : {std::pair{"before", "before"}, std::pair{"residuals", "after"}}) {
      double squares = 0, count = 0, largest = 0;
      for (const json& pose : c["poses"]) {
        if (pose["held_back"].get<bool>() != (stated["poses"] == "held back")) continue;
        for (std::size_t k = axis->second; k < pose[key].size(); k += 3, ++count) {
          squares += std::pow(pose[key][k].get<double>(), 2);
          largest = std::max(largest, std::abs(pose[key][k].get<double>()));
        }
      }
      EXPECT_NEAR(stated[errors]["rms"].get<double>(), std::sqrt(squares / count), 1e-12) << stated << key;
      EXPECT_NEAR(stated[errors]["largest"].get<double>(), largest, 1e-12) << stated << key;
      ++compared;
    }
  }
  EXPECT_EQ(compared, 12);
}

TEST(ReportResult, PageHoldsTheResultAsItsFileHasIt) {
  const TemporaryFolder folder;
  const json c = calibration_of_kr270(folder);
  const auto file = folder.write("calibration.json", c.dump());
  EXPECT_FALSE(is_plan(file));
  const ResultReport report = report_result(file);
  EXPECT_EQ(report.title, "kr270");
  const json data = parse_json(report_json(report));
  EXPECT_EQ(data["schema"], "posewright/report-of-result/1");
  EXPECT_EQ(data["result"], c);
  const std::string page = report_html(report);
  EXPECT_TRUE(page.starts_with("<!doctype html><!-- posewright report -->"));
  EXPECT_THAT(page, HasSubstr("posewright/calibration/1"));
}

TEST(ReportResult, RefusesEverythingElseInOneLine) {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& text) {
    const auto file = folder.write("file.json", text);
    try {
      if (is_plan(file)) return std::string("a plan");
      report_result(file);
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  const std::string known = "plan.json, or the --json output of calibrate, compare, next, simulate or stations";
  EXPECT_THAT(refused("pose,joint_a1 [rad]\n1,0\n"), HasSubstr("is no JSON; " + known));
  EXPECT_THAT(refused("[1, 2]"), HasSubstr("is not a result of posewright; " + known));
  EXPECT_THAT(refused("{\"schema\": \"x\", \"log_det\": 1e999}"), HasSubstr("too large"));
  EXPECT_THAT(refused("{\"schema\": 3}"), HasSubstr("is not a result of posewright"));
  EXPECT_THAT(refused("{\"schema\": \"other/1\"}"), HasSubstr("is of schema other/1, which has no page; " + known));
  EXPECT_THAT(refused("{\"schema\": \"posewright/route/1\"}"), HasSubstr("posewright report PLAN --route FILE"));
  EXPECT_THAT(refused("# from posewright\nposewright_parameters: 1\nvariant: a\n"), HasSubstr("is a parameters file"));
  EXPECT_THAT(refused("{\"schema\": \"posewright/stations/1\", \"ranking\": []}"),
              HasSubstr("has no problem; the output of posewright stations --json of this version"));
  EXPECT_EQ(refused("{\"schema\": \"posewright/plan/1\"}"), "a plan");
}

TEST(ReportResult, MapHasObstaclesWhereTheyStand) {
  const Problem problem = example("cell/problem.yaml");
  StationRank rank;
  rank.stations = {problem.workspace.stations->list.front()};
  const auto map = stations_json(problem, 0, "o1", {rank});
  EXPECT_EQ(map["base"], json({0.0, 0.0, 0.0}));
  std::map<std::string, json> bodies;
  for (const auto& body : map["obstacles"]) bodies[body["name"]] = body["points"];
  EXPECT_TRUE(bodies.at("floor").empty());
  ASSERT_EQ(bodies.at("fixture").size(), 8U);
  // 0.9 × 1.4 × 0.7 m about (1.9, 0.2, −0.4); a cylinder of 0.15 m about (−0.6, −1.7).
  for (const json& p : bodies.at("fixture")) {
    EXPECT_NEAR(std::abs(p[0].get<double>() - 1.9), 0.45, 1e-12);
    EXPECT_NEAR(std::abs(p[1].get<double>() - 0.2), 0.7, 1e-12);
    EXPECT_NEAR(std::abs(p[2].get<double>() + 0.4), 0.35, 1e-12);
  }
  for (const json& p : bodies.at("pillar"))
    EXPECT_NEAR(std::hypot(p[0].get<double>() + 0.6, p[1].get<double>() + 1.7), 0.15, 1e-12);
}

}  // namespace
}  // namespace posewright
