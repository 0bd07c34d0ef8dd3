// A parameters file from what a calibration found, and what plans, routes and lists say of it afterwards.

#include "posewright/lists/parameters_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "posewright/model/apply_parameters.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/report/report_problem.hpp"
#include "posewright/results/plan.hpp"
#include "posewright/support/file.hpp"
#include "posewright/support/json.hpp"
#include "posewright/support/random.hpp"
#include "posewright/tasks/evaluate_problem.hpp"
#include "posewright/tasks/plan_problem.hpp"
#include "posewright/tasks/route_problem.hpp"
#include "tests/kit/design_edits.hpp"
#include "tests/kit/pose_lists.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const std::filesystem::path examples = std::filesystem::path(POSEWRIGHT_SOURCE_DIR) / "examples";

Plan quick_plan(const Problem& problem) {
  DesignEdits options = DesignEdits().edit("candidates", 200).edit("restarts", 1).edit("method", "exchange");
  options.threads = 1;
  return planned(problem, options);
}

TEST(ParametersFile, ReadBackGivesTheVerySameModel) {
  const TemporaryFolder folder;
  for (const char* name : {"kr270/problem.yaml", "kr270/elastostatic.yaml", "telescope/problem.yaml"}) {
    Problem problem = read_problem(examples / name);
    const VariantSpec variant = problem.variants.front();
    const auto model = make_model({problem, variant});
    Random random(1, 0);
    std::vector<double> correction;
    for (const Parameter& p : model->parameters()) correction.push_back(random.uniform(-1, 1) * p.tolerance);
    std::vector<EstimatedValue> values;
    for (const CalibratedValue& v : calibrated_values({problem, variant}, *model, correction))
      values.push_back({v, 1e-5});
    const std::string text = parameters_yaml({problem, variant}, values);
    EXPECT_EQ(text, parameters_yaml({problem, variant}, values));
    apply_parameters(problem, read_calibrated_parameters(folder.write("cal.yaml", text)), {});
    const auto again = make_model({problem, variant});
    for (std::size_t i = 0; i < correction.size(); ++i)
      ASSERT_EQ(again->parameters()[i].nominal, values[i].value.value) << values[i].value.name;
  }
}

TEST(ParametersFile, HasWhatWasEstimatedOrIsNotNominalAndQuotesWhatYamlWouldMisread) {
  const Problem problem = read_problem(examples / "kr270/problem.yaml");
  const VariantSpec& variant = problem.variants.front();
  const std::string text = parameters_yaml({problem, variant}, {{{"joint_a1.offset", "rad", 0, 0.000123}, 1.2e-5},
                                                                {{"b & \"c\".x", "m", 0.25, 0.5}, {}},
                                                                {{"a.x", "m", 1, 1}, {}}});
  EXPECT_THAT(text, HasSubstr("posewright_parameters: 1\nvariant: "));
  EXPECT_THAT(text, testing::EndsWith(
                        "parameters:\n  joint_a1.offset: {value: 0.000123, unit: rad, nominal: 0, sigma: 1.2e-05}\n"
                        "  \"b & \\\"c\\\".x\": {value: 0.5, unit: m, nominal: 0.25}\n"));
  const CalibratedParameters read = parse_calibrated_parameters(text, "cal.yaml");
  EXPECT_EQ(read.variant.value, variant.name);
  EXPECT_EQ(read.values[1].name.value, "b & \"c\".x");
  EXPECT_TRUE(parse_calibrated_parameters(parameters_yaml({problem, variant}, {}), "cal.yaml").values.empty());
}

const char* const velocities = "workspace: {motion: {velocity: {leg_1.rho: 90 deg/s, leg_2.rho: 90 deg/s}}}\n";

/// The five-bar with its links 0.1 mm shorter, so that its poses can be reached with nominal ones too.
class PlannedAtParameters : public testing::Test {
 protected:
  PlannedAtParameters()
      : nominal(read_problem(folder.write("p.yaml", read_file(examples / "five_bar/problem.yaml") + velocities))),
        calibrated(nominal) {
    const VariantSpec& variant = nominal.variants.front();
    std::vector<EstimatedValue> values;
    for (CalibratedValue v : calibrated_values({nominal, variant}, *make_model(nominal), {})) {
      if (v.name.ends_with(".distal")) v.value -= 1e-4;
      values.push_back({v, {}});
    }
    file = folder.write("cal.yaml", parameters_yaml({nominal, variant}, values));
    apply_parameters(calibrated, read_calibrated_parameters(file), {});
  }
  TemporaryFolder folder;
  Problem nominal, calibrated;
  std::filesystem::path file;
};

TEST_F(PlannedAtParameters, PlanStatesFileAndHashAndLaterStepsFindIt) {
  const Plan plan = quick_plan(calibrated);
  const Plan before = quick_plan(nominal);
  EXPECT_NE(plan.log_det, before.log_det);
  const json stated = parse_json(plan_json(plan))["problem"]["parameters"];
  EXPECT_EQ(stated["file"], file.string());
  EXPECT_EQ(stated["sha256"], calibrated.parameters->sha256);
  EXPECT_FALSE(parse_json(plan_json(before))["problem"].contains("parameters"));

  const auto plan_file = folder.write("plan.json", plan_json(plan));
  EXPECT_EQ(parameters_of_plan(plan_file).file, file.string());
  EXPECT_EQ(parameters_of_plan(folder.write("before.json", plan_json(before))).file, "");
  EXPECT_EQ(parameters_of_plan(folder.write("poses.csv", "pose,x\n1,2\n")).file, "");
  std::filesystem::remove(file);
  EXPECT_THROW(parameters_of_plan(plan_file), InputError);
}

TEST_F(PlannedAtParameters, ReportAndEvaluationAgreeAtTheParametersAndSaySoElsewhere) {
  const Plan plan = quick_plan(calibrated);
  const auto plan_file = folder.write("plan.json", plan_json(plan));
  ReportOptions brief;
  brief.sizes = brief.candidates = false;
  EXPECT_TRUE(report_problem(calibrated, plan_file, brief, Monitor{}).notes.empty());
  const Report elsewhere = report_problem(nominal, plan_file, brief, Monitor{});
  ASSERT_EQ(elsewhere.notes.size(), 1U);
  EXPECT_THAT(elsewhere.notes.front(), HasSubstr("The plan was made at the parameters of " + file.string()));

  DesignEdits few = DesignEdits().edit("candidates", 200);
  const auto judged = [&](const Problem& problem) {
    return evaluate_problem(few.of(problem), poses_in(problem, plan_file), {}, Monitor{});
  };
  const PoseListEvaluation same = judged(calibrated);
  EXPECT_TRUE(same.notes.empty());
  EXPECT_NEAR(same.plan.log_det, plan.log_det, 1e-9 * std::abs(plan.log_det));
  EXPECT_EQ(same.plan.problem.parameters.sha256, calibrated.parameters->sha256);
  const PoseListEvaluation other = judged(nominal);
  ASSERT_EQ(other.notes.size(), 1U);
  EXPECT_THAT(other.notes.front(), HasSubstr("this run uses nominal ones (--parameters "));
}

TEST_F(PlannedAtParameters, RouteStatesThemAndNotesOthers) {
  const Plan plan = quick_plan(calibrated);
  const auto plan_file = folder.write("plan.json", plan_json(plan));
  RouteOptions options;
  const Route route = route_problem(calibrated, poses_in(calibrated, plan_file), options, Monitor{});
  EXPECT_TRUE(route.notes.empty());
  EXPECT_EQ(parse_json(route_json(route))["problem"]["parameters"]["sha256"], calibrated.parameters->sha256);
  Problem changed = nominal;
  folder.write("cal.yaml", "posewright_parameters: 1\nvariant: " + nominal.variants.front().name +
                               "\nparameters: {leg_1.distal: {value: 0.3501}}\n");
  apply_parameters(changed, read_calibrated_parameters(file), {});
  const Route other = route_problem(changed, poses_in(changed, plan_file), options, Monitor{});
  ASSERT_EQ(other.notes.size(), 1U);
  EXPECT_THAT(other.notes.front(), HasSubstr("with sha256 "));
}

}  // namespace
}  // namespace posewright
