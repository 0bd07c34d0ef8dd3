// Options --parameters and --set as a user meets them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "posewright/support/file.hpp"
#include "posewright/support/json.hpp"
#include "tests/kit/run_program.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// The five-bar with speeds, so that it has a route.
std::string five_bar() {
  return read_file(std::string(POSEWRIGHT_SOURCE_DIR) + "/examples/five_bar/problem.yaml") +
         "workspace: {motion: {velocity: {leg_1.rho: 90 deg/s, leg_2.rho: 90 deg/s}}}\n";
}
const char* const calibrated =
    "posewright_parameters: 1\nvariant: links_and_offsets\nparameters:\n  leg_1.distal: {value: 0.3499, unit: m}\n";

std::vector<std::string> plan_words(const std::vector<std::string>& more) {
  std::vector<std::string> words = {"plan", "p.yaml", "--candidates", "200", "--restarts", "1", "--method", "exchange"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

TEST(ParametersOption, PlanStatesThemAndRouteAndReportFindThem) {
  const TemporaryFolder folder;
  folder.write("p.yaml", five_bar());
  folder.write("cal.yaml", calibrated);
  const ProgramRun plan = run_program(folder.path(), plan_words({"--parameters", "cal.yaml"}));
  ASSERT_EQ(plan.exit_code, 0) << plan.err;
  EXPECT_THAT(plan.out, HasSubstr("At the calibrated parameters of cal.yaml."));
  const json stated = parse_json(read_file(folder / "plan.json"))["problem"]["parameters"];
  EXPECT_EQ(stated["file"], "cal.yaml");
  EXPECT_EQ(stated["variant"], "links_and_offsets");

  const ProgramRun report = run_program(folder.path(), {"report", "plan.json", "--brief"});
  EXPECT_EQ(report.exit_code, 0) << report.err;
  EXPECT_THAT(report.out, testing::Not(HasSubstr("plan was made")));
  const ProgramRun route = run_program(folder.path(), {"route", "plan.json", "--json"});
  ASSERT_EQ(route.exit_code, 0) << route.err;
  EXPECT_EQ(parse_json(route.out)["problem"]["parameters"]["sha256"], stated["sha256"]);

  const ProgramRun evaluation = run_program(folder.path(), {"evaluate", "p.yaml", "plan.json", "--candidates", "200"});
  EXPECT_EQ(evaluation.exit_code, 0);
  EXPECT_THAT(evaluation.err, HasSubstr("note: plan.json was made at the parameters of cal.yaml; this run uses "
                                        "nominal ones (--parameters cal.yaml)"));

  std::filesystem::remove(folder / "cal.yaml");
  const ProgramRun lost = run_program(folder.path(), {"route", "plan.json"});
  EXPECT_EQ(lost.exit_code, 2);
  EXPECT_THAT(lost.err, HasSubstr("its parameters file 'cal.yaml' is not there; name it with --parameters FILE"));
}

TEST(ParametersOption, PosesThatOnlyTheCalibratedRobotReachesAreRefusedWithTheReason) {
  const TemporaryFolder folder;
  folder.write("p.yaml", five_bar());
  folder.write("cal.yaml",
               "posewright_parameters: 1\nvariant: links_and_offsets\n"
               "parameters: {leg_1.distal: {value: 0.36}, leg_2.distal: {value: 0.36}}\n");
  ASSERT_EQ(run_program(folder.path(), plan_words({"--parameters", "cal.yaml"})).exit_code, 0);
  const ProgramRun run = run_program(folder.path(), {"evaluate", "p.yaml", "plan.json", "--candidates", "200"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("is not feasible: out of reach; plan.json was made at the parameters of cal.yaml"));
}

TEST(ParametersOption, ObservationAndComparisonStateThem) {
  const TemporaryFolder folder;
  folder.write("p.yaml", five_bar());
  folder.write("cal.yaml", calibrated);
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"observe", "p.yaml", "--variant", "links_and_offsets", "--candidates", "200"},
        std::vector<std::string>{"compare", "p.yaml", "--variant", "links_and_offsets", "--candidates", "200",
                                 "--restarts", "1"}}) {
    std::vector<std::string> all = words;
    all.insert(all.end(), {"--parameters", "cal.yaml", "--json"});
    const ProgramRun run = run_program(folder.path(), all);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(parse_json(run.out)["problem"]["parameters"]["file"], "cal.yaml");
  }
}

TEST(ParametersOption, BadFilesAndOutputsOverItEndWithTwo) {
  const TemporaryFolder folder;
  folder.write("p.yaml", five_bar());
  folder.write("cal.yaml", calibrated);
  folder.write("bad.yaml",
               "posewright_parameters: 1\nvariant: links_and_offsets\nparameters: {leg_9.distal: {value: 1}}\n");
  const auto complaint = [&](const std::vector<std::string>& more) {
    const ProgramRun run = run_program(folder.path(), plan_words(more));
    EXPECT_EQ(run.exit_code, 2);
    return run.err;
  };
  EXPECT_THAT(complaint({"--parameters", "bad.yaml"}),
              HasSubstr("bad.yaml:3: 'leg_9.distal' is not a parameter of variant 'links_and_offsets'; parameters: "));
  EXPECT_THAT(complaint({"--parameters", "none.yaml"}), HasSubstr("none.yaml"));
  EXPECT_THAT(complaint({"--parameters", "cal.yaml", "--force", "-o", "cal.yaml"}), HasSubstr("cal.yaml is an input"));
  EXPECT_EQ(read_file(folder / "cal.yaml"), calibrated);
}

std::set<std::string> keys_of(const json& result) {
  std::set<std::string> keys;
  for (const json& edit : result["problem"]["set"]) keys.insert(edit["key"]);
  return keys;
}

TEST(SetOption, PlanStatesAnyKeyAndLaterCommandsFindIt) {
  const TemporaryFolder folder;
  folder.write("p.yaml", five_bar());
  std::string text = five_bar();
  const std::string key = "measurement.device.noise", value = "0.02 deg", before = R"(noise: "0.01 deg"})";
  ASSERT_NE(text.find(before), std::string::npos);
  text.replace(text.find(before), before.size(), R"(noise: "0.02 deg"})");
  folder.write("edited.yaml", text);
  const ProgramRun plan = run_program(folder.path(), plan_words({"--set", key + "=" + value}));
  ASSERT_EQ(plan.exit_code, 0) << plan.err;
  const json stated = parse_json(read_file(folder / "plan.json"));
  EXPECT_THAT(stated["problem"]["set"], testing::Contains(json{{"key", key}, {"value", value}}));
  std::vector<std::string> words = plan_words({"--json", "-o", "-"});
  words[1] = "edited.yaml";
  const ProgramRun edited = run_program(folder.path(), words);
  ASSERT_EQ(edited.exit_code, 0) << edited.err;
  EXPECT_EQ(parse_json(edited.out)["criterion"]["log_det"], stated["criterion"]["log_det"]);

  const ProgramRun report = run_program(folder.path(), {"report", "plan.json", "--brief"});
  EXPECT_EQ(report.exit_code, 0) << report.err;
  EXPECT_THAT(report.err, testing::Not(HasSubstr("another")));
  const ProgramRun route = run_program(folder.path(), {"route", "plan.json", "--json", "--set", key + "=" + value});
  ASSERT_EQ(route.exit_code, 0) << route.err;
  EXPECT_EQ(keys_of(parse_json(route.out)), keys_of(stated));
  EXPECT_EQ(parse_json(route.out)["problem"]["sha256"], stated["problem"]["sha256"]);

  const ProgramRun wrong = run_program(folder.path(), plan_words({"--set", key + "=fast"}));
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("--set: measurement.device.noise is wrong"));
}

TEST(SetOption, LaterCommandsHaveTheDesignOfThePlan) {
  const TemporaryFolder folder;
  folder.write("p.yaml", five_bar());
  folder.write("test.csv", "x [m],y [m]\n0.1,0.4\n-0.1,0.3\n");
  ASSERT_EQ(run_program(folder.path(), plan_words({"--poses", "6", "-o", "measured.json"})).exit_code, 0);
  const std::string places = "design.test_poses={file: test.csv}";
  const ProgramRun run =
      run_program(folder.path(), plan_words({"--set", places, "--poses", "14", "--augment", "measured.json"}));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json plan = parse_json(read_file(folder / "plan.json"));
  EXPECT_EQ(keys_of(plan), (std::set<std::string>{"design.candidates", "design.restarts", "design.method",
                                                  "design.poses", "design.test_poses"}));
  EXPECT_EQ(plan["problem"]["sha256"], parse_json(read_file(folder / "measured.json"))["problem"]["sha256"]);
  // Its poses are in the plan.
  std::filesystem::remove(folder / "measured.json");
  const ProgramRun report = run_program(folder.path(), {"report", "plan.json", "--json"});
  ASSERT_EQ(report.exit_code, 0) << report.err;
  const json curve = parse_json(report.out)["curve"];
  const auto own = std::find_if(curve.begin(), curve.end(), [](const json& point) { return point["poses"] == 14; });
  ASSERT_NE(own, curve.end());
  EXPECT_NEAR(own->at("rho0"), plan["accuracy"]["rho0"], 1e-9);
  // What the user says now counts.
  const ProgramRun other =
      run_program(folder.path(), {"report", "plan.json", "--json", "--set", "design.test_poses={file: none.csv}"});
  EXPECT_THAT(other.err, HasSubstr("none.csv"));
}

}  // namespace
}  // namespace posewright
