// What other numbers of poses reach: kept in plan.json, and shown as long as it is of the plan's own poses.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <nlohmann/json.hpp>

#include "posewright/lists/parameters_file.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/report/report_problem.hpp"
#include "posewright/results/plan.hpp"
#include "posewright/study/written_plan.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/json.hpp"
#include "posewright/support/text_file.hpp"
#include "tests/kit/design_edits.hpp"
#include "tests/kit/example_problems.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

using nlohmann::json;
using testing::HasSubstr;

struct Written {
  TemporaryFolder folder{};
  Problem problem;
  json plan;

  explicit Written(bool other_numbers = true, int restarts = 10)
      : Written(read_problem(examples_folder() / "five_bar" / "problem.yaml"), other_numbers, restarts) {}
  explicit Written(const Problem& of, bool other_numbers = true, int restarts = 10) : problem(of) {
    DesignEdits edits;
    edits.edit("poses", 12);
    edits.edit("candidates", 200);
    edits.edit("restarts", restarts);
    edits.edit("method", "exchange");
    edits.other_numbers = other_numbers;
    plan = parse_json(plan_json(planned(problem, edits)));
  }

  std::vector<CurvePoint> curve_of(const json& edited) const {
    ReportOptions options;
    options.candidates = false;
    return report_problem(problem, folder.write("plan.json", edited.dump()), options, Monitor{}).curve;
  }

  /// What reading this says.
  std::string refused(const json& edited) const {
    try {
      read_written_plan(folder.write("bad.json", edited.dump()));
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }
};

/// With the log det of every stated point moved, as no search would find it.
json moved(json plan) {
  for (json& point : plan["other_numbers"]["points"]) point["log_det"] = point["log_det"].get<double>() - 100;
  return plan;
}

TEST(OtherNumbers, ArePlansOfMorePosesAndFewer) {
  const Written written;
  const json& points = written.plan["other_numbers"]["points"];
  ASSERT_EQ(points.size(), 5U);
  std::vector<int> numbers;
  double before = -1e300;
  for (const json& point : points) {
    numbers.push_back(point["poses"]);
    EXPECT_GT(point["log_det"].get<double>(), before) << "more poses tell more";
    before = point["log_det"];
  }
  EXPECT_EQ(numbers, (std::vector<int>{7, 10, 15, 19, 24}));
  const double own = written.plan["criterion"]["log_det"];
  EXPECT_LT(points[1]["log_det"].get<double>(), own);
  EXPECT_GT(points[2]["log_det"].get<double>(), own);
  // Plans of as many poses, by a search of their own.
  for (const std::size_t k : {1, 3}) {
    DesignEdits edits;
    edits.edit("poses", numbers[k]);
    edits.edit("candidates", 200);
    edits.edit("method", "exchange");
    const double searched = planned(written.problem, edits).log_det;
    EXPECT_NEAR(points[k]["log_det"].get<double>(), searched, 0.2) << numbers[k];
  }
  EXPECT_FALSE(Written(false).plan.contains("other_numbers")) << "nobody asked";
  EXPECT_FALSE(Written(true, 1).plan.contains("other_numbers")) << "a quick plan";
}

TEST(OtherNumbers, AReportShowsWhatThePlanStates) {
  const Written written;
  const std::vector<CurvePoint> curve = written.curve_of(moved(written.plan));
  ASSERT_EQ(curve.size(), 6U);
  EXPECT_EQ(curve[2].poses, 12);
  EXPECT_NEAR(curve[2].log_det, written.plan["criterion"]["log_det"].get<double>(), 1e-9);
  for (const std::size_t k : {0, 1, 3, 4, 5}) {
    const json& point = written.plan["other_numbers"]["points"][k < 2 ? k : k - 1];
    EXPECT_EQ(curve[k].poses, point["poses"]);
    EXPECT_NEAR(curve[k].log_det, point["log_det"].get<double>() - 100, 1e-9) << "read, not searched for";
  }
}

TEST(OtherNumbers, OfOtherPosesProblemsOrCriteriaAreSearchedAnew) {
  const Written written;
  const auto expect_new = [&](json edited, const std::string& what) {
    for (const CurvePoint& point : written.curve_of(moved(std::move(edited))))
      EXPECT_GT(point.log_det, written.plan["criterion"]["log_det"].get<double>() - 50) << what;
  };
  json edited = written.plan;
  edited["poses"][4]["configuration"][0] = edited["poses"][4]["configuration"][0].get<double>() + 1e-3;
  expect_new(edited, "a pose was moved");
  edited = written.plan;
  edited["poses"].erase(3);
  expect_new(edited, "a pose was taken out");
  edited = written.plan;
  edited["problem"]["sha256"] = std::string(64, '0');
  expect_new(edited, "another problem");
  edited = written.plan;
  edited["criterion"]["name"] = "a";
  expect_new(edited, "another criterion");
  edited = written.plan;
  edited["certificate"]["candidates"]["repeats"] = "2";
  expect_new(edited, "other repeats");
  edited = written.plan;
  edited.erase("other_numbers");
  EXPECT_EQ(written.curve_of(edited).size(), 6U) << "a file without them";
  // What only names a pose or follows from it changes nothing.
  edited = written.plan;
  std::swap(edited["poses"][0], edited["poses"][1]);
  edited["poses"][2].erase("tool_pose");
  EXPECT_LT(written.curve_of(moved(edited))[0].log_det, written.plan["criterion"]["log_det"].get<double>() - 50);
}

TEST(OtherNumbers, SearchedAnewKeepTheDistanceOfThePlan) {
  // The problem file knows nothing of it. More than some sixty poses do not fit so far apart.
  const Problem problem = read_problem(examples_folder() / "five_bar" / "problem.yaml");
  DesignEdits edits;
  edits.edit("poses", 30);
  edits.edit("candidates", 900);
  edits.edit("restarts", 1);
  edits.edit("method", "exchange");
  edits.edit("minimum_distance", "45.5 mm");
  const Plan plan = planned(problem, edits);
  const TemporaryFolder folder;
  ReportOptions options;
  options.candidates = false;
  const auto file = folder.write("plan.json", plan_json(plan));
  const Problem again = read_problem(problem.file, {}, edits_of_plan(file));
  EXPECT_EQ(again.sha256, problem.sha256) << "the same robot";
  const std::vector<CurvePoint> curve = report_problem(again, file, options, Monitor{}).curve;
  const auto of = [&](int poses) {
    return std::find_if(curve.begin(), curve.end(), [&](const CurvePoint& point) { return point.poses == poses; });
  };
  ASSERT_NE(of(18), curve.end());
  EXPECT_LT(of(18)->log_det, plan.log_det) << "fewer, as far apart";
  edits.edit("poses", 18);
  EXPECT_NEAR(of(18)->log_det, planned(problem, edits).log_det, 0.5);
  EXPECT_EQ(of(60), curve.end()) << "they do not fit";
}

TEST(OtherNumbers, OfTestPosesThatChangedAreSearchedAnew) {
  // Log det, problem and poses are those of the plan, predicted errors are not.
  const TemporaryFolder folder;
  const auto file = folder.write("test.csv", "x [m],y [m]\n0.1,0.4\n-0.1,0.3\n0,0.3\n");
  std::string text = read_text(examples_folder() / "five_bar" / "problem.yaml", 1 << 20);
  const std::string design = "design: {";
  text.insert(text.find(design) + design.size(), "test_poses: {file: " + file.string() + "}, ");
  const Problem problem = read_problem(folder.write("problem.yaml", text));
  const Written written(problem);
  ASSERT_TRUE(written.plan["accuracy"]["rho0"].is_number());
  const double log_det = written.plan["other_numbers"]["points"][0]["log_det"];
  EXPECT_NEAR(written.curve_of(moved(written.plan)).front().log_det, log_det - 100, 1e-9) << "nothing has changed";
  std::ofstream(file) << "x [m],y [m]\n0.15,0.35\n";
  const std::vector<CurvePoint> curve = written.curve_of(moved(written.plan));
  EXPECT_GT(curve.front().log_det, log_det - 50);
  EXPECT_LT(*curve[3].rho0, *curve[2].rho0);
  EXPECT_LT(*curve[2].rho0, *curve[1].rho0) << "all at the same test poses";
}

TEST(OtherNumbers, AStopLeavesAStatedCurveWhole) {
  const Written written;
  ReportOptions options;
  std::atomic<bool> stopped = false;
  Monitor late;
  late.interrupted = &stopped;
  late.on_progress = [&](const Progress& progress) {
    if (progress.stage != "candidates") stopped = true;
  };
  const Report report =
      report_problem(written.problem, written.folder.write("plan.json", written.plan.dump()), options, late);
  EXPECT_EQ(report.curve.size(), 6U);
  EXPECT_THAT(report.notes, testing::Not(testing::Contains(HasSubstr("numbers of poses are left out"))));
}

TEST(OtherNumbers, BadValuesAreOneLine) {
  const Written written;
  const auto expect_refused = [&](const std::string& pointer, const json& value, const std::string& says) {
    json edited = written.plan;
    edited[json::json_pointer(pointer)] = value;
    const std::string text = written.refused(edited);
    EXPECT_THAT(text, HasSubstr("other_numbers: " + says)) << pointer;
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 0) << text;
  };
  expect_refused("/other_numbers", 7, "has no `of`");
  expect_refused("/other_numbers/of", nullptr, "has no `of`");
  expect_refused("/other_numbers/points", "many", "has no `points`");
  expect_refused("/other_numbers/points/1", 3, "points[1] has no number of poses");
  expect_refused("/other_numbers/points/1/poses", 0, "points[1] has no number of poses");
  expect_refused("/other_numbers/points/1/poses", 2.5, "points[1] has no number of poses");
  expect_refused("/other_numbers/points/2/poses", 8, "points[2] has no more poses than the one before");
  expect_refused("/other_numbers/points/0/log_det", nullptr, "points[0] has no log_det");
  expect_refused("/other_numbers/points/0/rho0", "1 mm", "points[0] has no rho0");
  expect_refused("/other_numbers/points/0/largest_sigma_ratio", -1, "points[0] has a negative error");
  expect_refused("/other_numbers/points/1/poses", 12, "points[1] has the plan's own number");
  json many = json::array();
  for (int i = 1; i <= 101; ++i)
    many.push_back({{"poses", 100 + i}, {"log_det", 1}, {"rho0", nullptr}, {"largest_sigma_ratio", 1}});
  expect_refused("/other_numbers/points", many, "has 101 points");
  EXPECT_EQ(written.refused(written.plan), "accepted");
  json without = written.plan;
  without["criterion"].erase("reserve");
  EXPECT_EQ(written.refused(without), "accepted") << "as a plan of which nobody asked for a reserve";
}

}  // namespace
}  // namespace posewright
