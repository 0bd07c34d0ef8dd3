// What a report's page is given: enough to judge any subset of the poses, and pictures that fit the model.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <nlohmann/json.hpp>

#include "posewright/cell/drawing.hpp"
#include "posewright/model/variant_columns.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/report/report_problem.hpp"
#include "posewright/results/plan.hpp"
#include "posewright/study/study.hpp"
#include "posewright/support/file.hpp"
#include "posewright/support/json.hpp"
#include "posewright/tasks/plan_problem.hpp"
#include "posewright/tasks/route_problem.hpp"
#include "tests/kit/design_edits.hpp"
#include "tests/kit/example_problems.hpp"
#include "tests/kit/packed_matrix.hpp"
#include "tests/kit/pose_lists.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

using nlohmann::json;
using testing::HasSubstr;

double log_det(const Eigen::MatrixXd& M) { return 2 * M.llt().matrixLLT().diagonal().array().log().sum(); }

/// log det of the interest part, in SI units, of the poses that are not left out.
double interest_log_det(const json& report, int left_out = 0) {
  const auto m = Eigen::Index(report["columns"].size());
  Eigen::Index nuisance = 0;
  double units = 0;
  for (const json& column : report["columns"]) {
    if (column["role"] == "nuisance") ++nuisance;
    else units += 2 * std::log(column["tolerance"].get<double>());
  }
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(m, m);
  for (const json& pose : report["information"]["poses"])
    if (pose["id"] != left_out) M += information_of(report["information"], pose, m);
  if (!report["information"]["prior"].is_null()) M += unpacked(report["information"]["prior"], m);
  return log_det(M) - (nuisance > 0 ? log_det(M.topLeftCorner(nuisance, nuisance)) : 0.0) - units;
}

struct Made {
  Plan plan;
  json report;
};

Made make_report(const Problem& problem, const DesignEdits& options, const TemporaryFolder& folder,
                 const ReportOptions& report_options) {
  Made made{planned(problem, options), {}};
  const auto file = folder.write("plan.json", plan_json(made.plan));
  made.report = parse_json(report_json(report_problem(problem, file, report_options, Monitor{})));
  return made;
}

DesignEdits quick_report(int poses, int candidates) {
  DesignEdits options;
  options.edit("poses", poses);
  options.edit("candidates", candidates);
  options.edit("restarts", 1);
  options.edit("method", "exchange");
  return options;
}

TEST(Report, MatricesGiveThePlansLogDetAndWhatTheLossOfAPoseCosts) {
  const TemporaryFolder folder;
  const Problem problem = read_problem(examples_folder() / "kr270" / "problem.yaml");
  ReportOptions brief;
  brief.sizes = brief.candidates = false;
  const auto [plan, report] = make_report(problem, quick_report(18, 100), folder, brief);
  EXPECT_NEAR(interest_log_det(report), plan.log_det, 1e-9 * std::abs(plan.log_det));
  double interest = 0;
  for (const json& column : report["columns"]) interest += column["role"] == "interest";
  for (const PlannedPose& pose : plan.poses)
    EXPECT_NEAR(std::exp((interest_log_det(report, pose.id) - plan.log_det) / interest), pose.without, 1e-8) << pose.id;
  EXPECT_TRUE(report["notes"].empty()) << report["notes"];
}

TEST(Report, IsOfTheParametersThatThePlanEstimates) {
  // Of its dependent groups other parameters have the largest columns among the candidates of the report.
  const TemporaryFolder folder;
  const Problem problem = read_problem(examples_folder() / "gough" / "problem.yaml");
  ReportOptions brief;
  brief.sizes = brief.candidates = false;
  DesignEdits edits = quick_report(24, 2000);
  edits.edit("method", "greedy");
  const auto [plan, report] = make_report(problem, edits, folder, brief);
  std::vector<std::string> estimated, shown;
  for (const PlannedParameter& p : plan.parameters)
    if (p.sigma) estimated.push_back(p.label.name);
  for (const json& column : report["columns"]) shown.push_back(column["name"]);
  EXPECT_THAT(shown, testing::UnorderedElementsAreArray(estimated));
  EXPECT_NEAR(interest_log_det(report), plan.log_det, 1e-9 * std::abs(plan.log_det));
  EXPECT_TRUE(report["notes"].empty()) << report["notes"];
}

TEST(Report, SaysWhatCandidatesAndOtherNumbersOfPosesBring) {
  const TemporaryFolder folder;
  const Problem problem = read_problem(examples_folder() / "telescope" / "problem.yaml");
  const auto [plan, report] = make_report(problem, quick_report(20, 300), folder, {});
  const json& candidates = report["candidates"];
  ASSERT_EQ(candidates["sensitivity"].size(), 300U);
  EXPECT_EQ(candidates["positions"].size(), 900U);
  EXPECT_EQ(candidates["chosen"].size(), 20U);
  double chosen = 0, all = 0;
  for (const json& i : candidates["chosen"])
    chosen += candidates["sensitivity"][i.get<std::size_t>()].get<double>() / 20;
  for (const json& d : candidates["sensitivity"]) all += d.get<double>() / 300;
  EXPECT_GT(chosen, all) << "chosen candidates tell more than others";
  const json& curve = report["curve"];
  ASSERT_GE(curve.size(), 4U);
  for (std::size_t k = 1; k < curve.size(); ++k) {
    EXPECT_GT(curve[k]["poses"], curve[k - 1]["poses"]);
    EXPECT_GT(curve[k]["log_det"], curve[k - 1]["log_det"]) << "more poses tell more";
  }
  ASSERT_EQ(report["prefix"].size(), 20U);
  EXPECT_TRUE(report["prefix"][0].is_null()) << "one pose does not identify everything";
  EXPECT_NEAR(report["prefix"][19]["log_det"].get<double>(), plan.log_det, 1e-9 * std::abs(plan.log_det));
}

TEST(Report, AccuracyFollowsFromTheMatricesOfTestPoses) {
  const TemporaryFolder folder;
  std::filesystem::copy(examples_folder() / "kr270", folder.path(), std::filesystem::copy_options::recursive);
  const Problem problem = read_problem(folder.write(
      "problem.yaml", read_file(examples_folder() / "kr270" / "problem.yaml") + "  test_poses: {random: 12}\n"));
  ReportOptions brief;
  brief.sizes = brief.candidates = false;
  const auto [plan, report] = make_report(problem, quick_report(18, 100), folder, brief);
  ASSERT_EQ(report["candidates"], nullptr);
  EXPECT_TRUE(report["curve"].empty());
  ASSERT_EQ(report["information"]["test"].size(), 12U);
  const auto m = Eigen::Index(report["columns"].size());
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(m, m);
  for (const json& pose : report["information"]["poses"]) M += information_of(report["information"], pose, m);
  double sum = 0, weights = 0;
  for (const json& test : report["information"]["test"]) {
    sum += test["weight"].get<double>() * M.llt().solve(test_information(test, m)).trace();
    weights += test["weight"].get<double>();
  }
  EXPECT_NEAR(std::sqrt(sum / weights), *plan.rho0, 1e-9 * *plan.rho0);
}

TEST(Report, PlaysTheRouteThroughEveryPose) {
  const TemporaryFolder folder;
  Problem problem = read_problem(examples_folder() / "cell" / "problem.yaml");
  problem.workspace.motion.reachable = false;  // the route finds out, and the test is quick_report
  const Plan plan = planned(problem, quick_report(14, 200));
  const auto file = folder.write("plan.json", plan_json(plan));
  RouteOptions route_options;
  route_options.from_home = route_options.closed = true;
  route_options.reading = 3.0;
  const Route route = route_problem(problem, poses_in(problem, file), route_options, Monitor{});
  ReportOptions brief;
  brief.sizes = brief.candidates = false;
  brief.route = folder.write("route.json", route_json(route));
  const json report = parse_json(report_json(report_problem(problem, file, brief, Monitor{})));
  std::vector<int> stops, expected = {0};
  double before = -1;
  for (const json& keyframe : report["keyframes"]) {
    EXPECT_GE(keyframe["seconds"].get<double>(), before);
    before = keyframe["seconds"];
    EXPECT_EQ(keyframe["frames"].size(), report["frames"].size());
    if (!keyframe["pose"].is_null()) stops.push_back(keyframe["pose"]);
  }
  for (const PlannedPose& pose : route.poses) expected.push_back(pose.id);
  expected.push_back(0);
  EXPECT_EQ(stops, expected);
  // Readings are part of the job: the tracker reads target after target. The robot comes home after the last of them.
  double whole = 5.0 * double(route.poses.size());
  const auto read = [&](const std::vector<TargetSight>& sights) {
    for (const TargetSight& sight : sights) whole += sight.hidden_by.empty() ? 3.0 : 0.0;
  };
  for (const PlannedPose& pose : route.poses) read(pose.sights);
  for (const ReferenceCheck& references : route.references) read(references.sights);
  for (const RouteMotion& motion : route.motions) whole += motion.seconds + motion.change_seconds;
  EXPECT_NEAR(report["keyframes"].back()["seconds"].get<double>(), whole, 1e-3);
  EXPECT_FALSE(report["bodies"].empty());
  EXPECT_EQ(report["stations"].size(), 1U);
  // At a stop the tip is where the plan says.
  for (const json& keyframe : report["keyframes"]) {
    if (keyframe["pose"].is_null() || keyframe["pose"] == 0) continue;
    const PlannedPose& pose = plan.poses.at(keyframe["pose"].get<std::size_t>() - 1);
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(keyframe["tip"][std::size_t(k)].get<double>(), pose.tool_pose->translation()[k], 1e-5);
  }
}

TEST(Report, RoutesOfOtherPlansAreRefusedAndClosedOnesCountTheirFirstPoseOnce) {
  const TemporaryFolder folder;
  const Problem problem = read_problem(examples_folder() / "kr270" / "problem.yaml");
  DesignEdits options = quick_report(12, 100);
  const auto file = folder.write("plan.json", plan_json(planned(problem, options)));
  options.seed = 5;
  const auto other = folder.write("other.json", plan_json(planned(problem, options)));
  RouteOptions closed;
  closed.closed = true;
  Route route = route_problem(problem, poses_in(problem, file), closed, Monitor{});
  ReportOptions brief;
  brief.sizes = brief.candidates = false;
  brief.route = folder.write("route.json", route_json(route));
  EXPECT_THROW(report_problem(problem, other, brief, Monitor{}), InputError);
  EXPECT_EQ(report_problem(problem, file, brief, Monitor{}).prefix.size(), 12U);
  // Without the last pose the tour closes one motion earlier.
  route.poses.pop_back();
  route.motions.erase(route.motions.end() - 2);
  route.motions.back().from = route.poses.back().id;
  route.motions.back().points.front() = route.motions[route.motions.size() - 2].points.back();
  brief.route = folder.write("shorter.json", route_json(route));
  EXPECT_EQ(report_problem(problem, file, brief, Monitor{}).prefix.size(), 11U);
}

TEST(Report, PosesOfAShortenedPlanKeepTheirIds) {
  const TemporaryFolder folder;
  const Problem problem = read_problem(examples_folder() / "delta" / "problem.yaml");
  json plan = parse_json(plan_json(planned(problem, quick_report(12, 60))));
  plan["poses"].erase(1);
  ReportOptions brief;
  brief.sizes = brief.candidates = false;
  const Report report = report_problem(problem, folder.write("plan.json", plan.dump()), brief, Monitor{});
  std::vector<int> ids;
  for (const auto& [id, M] : report.information.poses) ids.push_back(id);
  EXPECT_EQ(ids, (std::vector<int>{1, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}));
  EXPECT_EQ(report.keyframes[1].pose, 3);
}

TEST(Report, ATimeLimitShortensTheCurveAndNothingElse) {
  const TemporaryFolder folder;
  const Problem problem = read_problem(examples_folder() / "delta" / "problem.yaml");
  const auto file = folder.write("plan.json", plan_json(planned(problem, quick_report(12, 60))));
  Monitor late;
  late.on_progress = [&](const Progress& progress) {
    if (progress.stage == "other numbers of poses") late.deadline = Monitor::Clock::now();
  };
  ReportOptions options;
  options.threads = 1;
  const Report report = report_problem(problem, file, options, late);
  EXPECT_EQ(report.candidates->sensitivity.size(), 60U);
  EXPECT_EQ(report.curve.size(), 2U) << "the plan itself and the one number that was done";
  EXPECT_THAT(report.notes, testing::Contains(HasSubstr("left out of the curve")));
  // With no time at all there is nothing to show, and no page that looks whole.
  Monitor over;
  over.deadline = Monitor::Clock::now();
  EXPECT_THROW(report_problem(problem, file, {}, over), CannotDo);
}

TEST(Report, PositionErrorsOverTheWorkspaceAreThoseOfTestPosesThere) {
  const TemporaryFolder folder;
  std::filesystem::copy(examples_folder() / "kr270", folder.path(), std::filesystem::copy_options::recursive);
  const std::filesystem::path file = folder / "problem.yaml";
  ReportOptions brief;
  brief.sizes = brief.candidates = false;
  const Problem problem = read_problem(file);
  const json report = make_report(problem, quick_report(18, 60), folder, brief).report;
  // The same configurations, written into the problem as test poses.
  const Problem searched = quick_report(18, 60).of(problem);
  const Study study = make_study(resolve(searched, {}, Monitor{}), Monitor{});
  std::string at;
  for (std::size_t i = 0; i < study.configurations.count(); ++i) {
    at += at.empty() ? "[" : ", [";
    for (std::size_t k = 0; k < 6; ++k) at += fmt::format("{}{:.17g}", k > 0 ? ", " : "", study.configurations[i][k]);
    at += "]";
  }
  std::string text = read_file(file);
  const std::string design = "design:\n";
  ASSERT_NE(text.find(design), std::string::npos);
  text.insert(text.find(design) + design.size(), "  test_poses: {at: [" + at + "]}\n");
  const Plan plan = planned(read_problem(folder.write("tested.yaml", text)), quick_report(18, 60));
  ASSERT_EQ(plan.test_errors.size(), 60U);
  ASSERT_EQ(report["position_errors"].size(), 60U);
  for (std::size_t i = 0; i < 60; ++i)
    EXPECT_NEAR(report["position_errors"][i].get<double>(), plan.test_errors[i], 1e-9 * plan.test_errors[i]) << i;
}

TEST(Report, IsCalledAsTheRobotAndLinksHaveTheirColours) {
  const TemporaryFolder folder;
  folder.write("arm.urdf", R"(<robot name="cobot 7"><material name="red"><color rgba="1 0.25 0 1"/></material>
<link name="a"><visual><geometry><box size="0.1 0.1 0.1"/></geometry><material name="red"/></visual>
<collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
<link name="b"><collision><origin xyz="0.3 0 0.2"/><geometry><box size="0.4 0.1 0.1"/></geometry></collision></link>
<joint name="j" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>
<limit lower="-2" upper="2" velocity="1" effort="1"/></joint></robot>)");
  const Problem problem = read_problem(
      folder.write("line.yaml",
                   "posewright: 1\nrobot: {urdf: arm.urdf}\nmeasurement: {type: position, target: [0.5, 0, 0], device: "
                   "{type: isotropic, noise: 0.1 mm}}\nvariants: {all: {parameters: [j.offset]}}\ndesign: {criterion: "
                   "o1, poses: 3}\n"));
  ReportOptions brief;
  brief.sizes = brief.candidates = false;
  const json report = make_report(problem, quick_report(3, 20), folder, brief).report;
  EXPECT_EQ(report["title"], "cobot 7");
  ASSERT_EQ(report["bodies"].size(), 2U);
  EXPECT_EQ(report["bodies"][0]["colour"], (std::vector<double>{1, 0.25, 0}));
  EXPECT_FALSE(report["bodies"][1].contains("colour")) << "none is stated";
}

TEST(Report, PageHoldsItsDataOnceAndNothingInItEndsTheElement) {
  const TemporaryFolder folder;
  const Problem problem = read_problem(examples_folder() / "five_bar" / "problem.yaml");
  const Plan plan = plan_problem(problem, {}, Monitor{});
  const auto file = folder.write("plan.json", plan_json(plan));
  ReportOptions brief;
  brief.sizes = brief.candidates = false;
  Report report = report_problem(problem, file, brief, Monitor{});
  report.notes.emplace_back("</script><script>alert(1)</script><!-- @REPORT_DATA@");
  const std::string page = report_html(report);
  EXPECT_TRUE(page.starts_with("<!doctype html><!-- posewright report -->"));
  const std::string open = "<script type=\"application/json\" id=\"report-data\">";
  const auto begin = page.find(open);
  ASSERT_NE(begin, std::string::npos);
  const auto end = page.find("</script>", begin);
  const json data = parse_json(page.substr(begin + open.size(), end - begin - open.size()));
  EXPECT_EQ(data["notes"].back(), report.notes.back());
  EXPECT_EQ(data["plan"]["criterion"]["log_det"], plan.log_det);
}

TEST(Report, SaysThatTheProblemHasChanged) {
  const TemporaryFolder folder;
  const Problem problem = read_problem(examples_folder() / "five_bar" / "problem.yaml");
  Plan plan = plan_problem(problem, {}, Monitor{});
  plan.problem.sha256 = std::string(64, '0');
  ReportOptions brief;
  brief.sizes = brief.candidates = false;
  const Report report = report_problem(problem, folder.write("plan.json", plan_json(plan)), brief, Monitor{});
  EXPECT_THAT(report.notes, testing::Contains(HasSubstr("The problem file has changed")));
}

TEST(Report, RefusesWhatIsNoPlanAndRoutesOfOtherPlans) {
  const TemporaryFolder folder;
  const Problem problem = read_problem(examples_folder() / "five_bar" / "problem.yaml");
  const auto refused = [&](const std::filesystem::path& plan, const ReportOptions& options) {
    try {
      report_problem(problem, plan, options, Monitor{});
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_THAT(refused(folder.write("a.json", "{"), {}), HasSubstr("is not a plan of a robot"));
  EXPECT_THAT(refused(folder.write("b.json", "{\"schema\": \"posewright/plan/1\"}"), {}), HasSubstr("is not a plan"));
  EXPECT_THAT(refused(folder.write("c.json", "[]"), {}), HasSubstr("is not a plan"));
  const auto plan = folder.write("plan.json", plan_json(plan_problem(problem, {}, Monitor{})));
  ReportOptions options;
  options.sizes = options.candidates = false;
  options.route = folder.write("r.json", "{}");
  EXPECT_THAT(refused(plan, options), HasSubstr("is not a route"));
  options.route = folder.write("s.json", R"({"names": ["joint_1"], "poses": [], "seconds": {"settle": 0}})");
  EXPECT_THAT(refused(plan, options), HasSubstr("does not fit the plan: no coordinate joint_1"));
}

/// Lengths of the segments of a line.
std::vector<double> lengths(const Polyline& line) {
  std::vector<double> result;
  for (std::size_t i = 1; i < line.size(); ++i) result.push_back((line[i] - line[i - 1]).norm());
  return result;
}

DrawnPose drawn(const Problem& problem, std::vector<double> q) {
  const auto cell = make_cell(problem);
  q.resize(cell->model->coordinates().size());
  return Drawing(problem, *cell).at(q);
}

TEST(Drawing, LegsOfASixPusAreAsLongAsTheModelSays) {
  const Problem problem = read_problem(examples_folder() / "telescope" / "problem.yaml");
  const DrawnPose pose = drawn(problem, {1e-4, -2e-4, 3e-4, 1e-3, -5e-4, 2e-4});
  const auto& spec = std::get<SixLegsSpec>(problem.robot);
  ASSERT_EQ(pose.lines.size(), 8U) << "six legs and two rims";
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(lengths(pose.lines[i])[1], spec.legs[i].l, 1e-12);
    EXPECT_LT((pose.lines[i].back() - pose.lines[7][i]).norm(), 1e-12) << "ends on the platform's rim";
  }
}

TEST(Drawing, ArmsOfADeltaAndAFiveBarAreAsLongAsTheModelSays) {
  const Problem delta = read_problem(examples_folder() / "delta" / "problem.yaml");
  const auto& spec = std::get<DeltaSpec>(delta.robot);
  const Eigen::Vector3d centre = (spec.lower + spec.upper) / 2 + Eigen::Vector3d(0.02, -0.03, 0);
  const DrawnPose pose = drawn(delta, {centre.x(), centre.y(), centre.z()});
  ASSERT_EQ(pose.lines.size(), 5U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(lengths(pose.lines[i])[0], spec.arm, 1e-12);
    EXPECT_NEAR(lengths(pose.lines[i])[1], spec.forearm, 1e-12);
  }
  const Problem five_bar = read_problem(examples_folder() / "five_bar" / "problem.yaml");
  const auto& legs = std::get<FiveBarSpec>(five_bar.robot);
  const DrawnPose point = drawn(five_bar, {(legs.x_lower + legs.x_upper) / 2, (legs.y_lower + legs.y_upper) / 2});
  ASSERT_EQ(point.lines.size(), 3U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(lengths(point.lines[i])[0], legs.legs[i].proximal, 1e-12);
    EXPECT_NEAR(lengths(point.lines[i])[1], legs.legs[i].distal, 1e-12);
  }
}

TEST(Drawing, ArmEndsAtTheToolAndCarriesItsTargets) {
  const Problem problem = read_problem(examples_folder() / "kr270" / "problem.yaml");
  const auto cell = make_cell(problem);
  const Drawing drawing(problem, *cell);
  const std::vector<double> q = {0.3, -1.2, 0.8, 0.4, -0.6, 1.0};
  const DrawnPose pose = drawing.at(q);
  const Eigen::Isometry3d tool = cell->model->tool_pose(q);
  ASSERT_EQ(pose.lines.size(), 1U);
  EXPECT_LT((pose.lines[0].back() - tool.translation()).norm(), 1e-12);
  ASSERT_EQ(pose.targets.size(), drawing.targets().size());
  const auto& targets = std::get<PointsMeasurement>(problem.measurement.instrument).targets;
  for (std::size_t i = 0; i < targets.size(); ++i)
    EXPECT_LT((*pose.targets[i] - tool * targets[i].position).norm(), 1e-12);
}

TEST(Drawing, ShowsTargetsOfAllThatReadTogether) {
  const Problem problem = read_problem(examples_folder() / "instruments" / "read_together.yaml");
  const auto cell = make_cell(problem);
  const Drawing drawing(problem, *cell);
  const auto drawn_targets = [&](double reader) {
    const DrawnPose pose = drawing.at(std::vector<double>{0.1, -1.4, 1.6, 0.2, 0.1, 0.3, reader});
    return std::ranges::count_if(pose.targets, [](const auto& target) { return target.has_value(); });
  };
  ASSERT_EQ(drawing.targets(), (std::vector<std::string>{"tracker.P1", "tracker.P2", "tracker.P3"}));
  EXPECT_EQ(drawn_targets(0), 3);
  EXPECT_EQ(drawn_targets(1), 0);
  EXPECT_EQ(drawn_targets(2), 3);
  ASSERT_EQ(drawing.cameras().size(), 1U);
  EXPECT_EQ(drawing.cameras()[0].instrument, "camera");
  EXPECT_EQ(drawing.cameras()[0].with, std::vector<std::string>{"both"});
}

TEST(Drawing, AThinnedMeshKeepsItsPlace) {
  TriangleMesh sphere;
  constexpr int rings = 100, sectors = 200;
  for (int i = 0; i <= rings; ++i)
    for (int j = 0; j < sectors; ++j) {
      const double a = M_PI * i / rings, b = 2 * M_PI * j / sectors;
      sphere.vertices.emplace_back(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a));
    }
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < sectors; ++j) {
      const int a = i * sectors + j, b = i * sectors + (j + 1) % sectors;
      sphere.triangles.push_back({a, b, a + sectors});
      sphere.triangles.push_back({b, b + sectors, a + sectors});
    }
  const TriangleMesh thin = thinned(sphere, 3000);
  EXPECT_LE(thin.triangles.size(), 3000U);
  EXPECT_GE(thin.triangles.size(), 500U);
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& v : thin.vertices) {
    EXPECT_NEAR(v.norm(), 1.0, 1e-12) << "vertices are the mesh's own";
    box.extend(v);
  }
  EXPECT_NEAR(box.sizes().minCoeff(), 2.0, 0.1);
}

}  // namespace
}  // namespace posewright
