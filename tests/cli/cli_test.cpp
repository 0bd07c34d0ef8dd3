// The program as a user meets it: exit codes, messages, files.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "posewright/support/file.hpp"
#include "posewright/support/json.hpp"
#include "tests/kit/random_blocks.hpp"
#include "tests/kit/recompute.hpp"
#include "tests/kit/run_program.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

using testing::HasSubstr;

const std::string telescope = std::string(POSEWRIGHT_SOURCE_DIR) + "/examples/telescope/problem.yaml";
const std::string kr270 = std::string(POSEWRIGHT_SOURCE_DIR) + "/examples/kr270/problem.yaml";

std::string csv_blocks(int count, int rows, int columns) {
  const BlockArray blocks = random_blocks(std::size_t(count), rows, columns, 3);
  std::ostringstream text;
  text.precision(17);
  for (int i = 0; i < count; ++i)
    for (int r = 0; r < rows; ++r)
      for (int c = 0; c < columns; ++c) text << blocks.row(std::size_t(i), r)[c] << (c + 1 < columns ? "," : "\n");
  return text.str();
}

TEST(CommandLine, HelpAndVersionAreEverywhere) {
  const TemporaryFolder folder;
  EXPECT_THAT(run_program(folder.path(), {"--version"}).out, testing::StartsWith("posewright 0."));
  EXPECT_THAT(run_program(folder.path(), {"--help"}).out, HasSubstr("Example:"));
  for (const char* command : {"plan", "observe", "select"}) {
    const ProgramRun help = run_program(folder.path(), {"help", command});
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_THAT(help.out, HasSubstr("Example:\n  posewright " + std::string(command)));
    EXPECT_EQ(run_program(folder.path(), {command, "--help"}).out, help.out);
  }
}

TEST(CommandLine, PlanWritesBothFilesAndASummary) {
  const TemporaryFolder folder;
  const ProgramRun run = run_program(folder.path(), {"plan", telescope, "--candidates", "400", "--method", "exchange",
                                                     "-o", "p.json", "--poses-csv", "p.csv"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("40 poses for variant rigid: 42 parameters"));
  EXPECT_THAT(run.out, HasSubstr("as informative as any plan of 40 of these"));
  EXPECT_THAT(run.out, HasSubstr("boundary of the feasible set"));
  EXPECT_EQ(run.err, "") << "no progress where stderr is not a terminal";
  const auto json = parse_json(read_file(folder / "p.json"));
  EXPECT_EQ(json["schema"], "posewright/plan/1");
  EXPECT_EQ(json["problem"]["sha256"].get<std::string>().size(), 64U);
  EXPECT_EQ(json["poses"].size(), 40U);
  EXPECT_EQ(json["parameters"].size(), 42U);
  EXPECT_EQ(json["poses"][0]["names"][3], "rx");
  EXPECT_EQ(json["poses"][0]["actuators"].size(), 6U);
  const std::string csv = read_file(folder / "p.csv");
  EXPECT_THAT(csv, testing::StartsWith("pose,x [m],y [m],z [m],rx [rad],ry [rad],rz [rad],leg_1.rho [m]"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 41);
}

TEST(CommandLine, JsonIsAloneOnStandardOutput) {
  const TemporaryFolder folder;
  const ProgramRun plan = run_program(folder.path(), {"plan", telescope, "--candidates", "200", "--method", "exchange",
                                                      "--json", "-o", "-", "--poses-csv", "-"});
  EXPECT_EQ(parse_json(plan.out)["poses"].size(), 40U);
  EXPECT_EQ(folder.count_files(), 0U);
  const ProgramRun observe = run_program(folder.path(), {"observe", telescope, "--candidates", "300", "--json"});
  const auto json = parse_json(observe.out);
  EXPECT_EQ(json["variants"].size(), 8U);
  EXPECT_EQ(json["variants"][0]["rank"], 42);
}

TEST(CommandLine, ObservePrintsRankSpectrumIndicesAndEquations) {
  const TemporaryFolder folder;
  const ProgramRun run =
      run_program(folder.path(), {"observe", telescope, "--variant", "all_free", "--candidates", "500", "--spectrum"});
  EXPECT_EQ(run.exit_code, 0);
  for (const char* text : {"Variant all_free: 42 of 54 parameters can be identified; ", "Rank 42 of 54",
                           "Singular values", "O1 ", "O5 ", "leg_1.az = ", "·leg_1.l"})
    EXPECT_THAT(run.out, HasSubstr(text));
}

struct BadCommand {
  std::vector<std::string> words;
  int exit_code;
  const char* expected;
};

TEST(CommandLine, EveryMistakeGivesOneLineTheRightCodeAndNoFile) {
  const TemporaryFolder folder, inputs;
  const std::string blocks = inputs.write("b.csv", csv_blocks(20, 2, 4)).string();
  const std::string broken =
      inputs.write("broken.yaml", "posewright: 1\nrobot: {urdf: x.urdf, colour: red}\n").string();
  const std::vector<BadCommand> table = {
      {{"paln", telescope},
       2,
       "unknown command 'paln' (did you mean 'plan'?); commands of this version: init, observe, plan, select"},
      {{"plan"}, 2, "PROBLEM is missing"},
      {{"plan", telescope, "another"}, 2, "unexpected argument 'another'"},
      {{"plan", telescope, "--pose", "4"},
       2,
       "unrecognised option '--pose' (did you mean '--poses'?); see posewright help plan"},
      {{"plan", telescope, "--criteron", "o1"}, 2, "(did you mean '--criterion'?); see posewright help plan"},
      {{"plan", telescope, "--poses"}, 2, "--poses"},
      {{"plan", telescope, "--poses", "many"}, 2, "--poses is 'many'; a whole number from 1"},
      {{"plan", telescope, "--poses", "0"}, 2, "a whole number from 1"},
      {{"plan", telescope, "--poses", "4.5"}, 2, "a whole number from 1"},
      {{"plan", telescope, "--seed", "-1"}, 2, "--seed -1 is not a seed"},
      {{"plan", telescope, "--threads", "0"}, 2, "--threads 0; a whole number from 1 to 4096"},
      {{"plan", telescope, "--time-limit", "soon"}, 2, "--time-limit soon"},
      {{"plan", telescope, "--variant", "none"},
       2,
       "--variant is 'none'; allowed: rigid, rigid_6, linear, linear_common, matrix, all_free, kappa_and_ux, "
       "row_of_K"},
      {{"plan", telescope, "--criterion", "o9"}, 2, "unknown criterion 'o9'; available: o1"},
      {{"plan", telescope, "--method", "magic"}, 2, "unknown method 'magic'; available: auto, exchange"},
      {{"plan", telescope, "--repeats", "maybe"}, 2, "--repeats is 'maybe'; allowed: allow, forbid"},
      {{"plan", "missing.yaml"}, 2, "missing.yaml"},
      {{"plan", broken}, 2, "broken.yaml:2: "},
      {{"plan", kr270, "--poses", "4", "--candidates", "200"}, 1, "at least 5 poses are needed"},
      {{"plan", telescope, "--poses", "300", "--candidates", "200"},
       1,
       "300 poses cannot be chosen from 200 candidates without repeats"},
      {{"plan", telescope, "-o", "no/such/folder.json"}, 1, "cannot be written"},
      {{"plan", telescope, "-o", "same", "--poses-csv", "same"}, 2, "is named for two outputs"},
      {{"plan", telescope, "-o", telescope}, 2, "is an input"},
      {{"select", blocks, "--rows", "2"}, 2, "--poses is missing"},
      {{"select", blocks, "--poses", "5"}, 2, "say with --rows"},
      {{"select", blocks, "--rows", "3", "--poses", "5"}, 2, "multiple of --rows 3"},
      {{"select", blocks, "--rows", "2", "--poses", "1"}, 1, "at least 2 poses are needed"},
      {{"select", blocks, "--rows", "2", "--poses", "21"}, 1, "21 poses cannot be chosen from 20"},
      {{"select", blocks, "--rows", "2", "--poses", "5", "--nuisance", "4"}, 2, "--nuisance 4; 0 to 3"},
      {{"observe", telescope, "--variant", "none"}, 2, "has no variant 'none'"},
      {{"observe", telescope, "--restarts", "4"}, 2, "unrecognised option"},
      {{"report"}, 2, "PLAN, RESULT or PROBLEM is missing"},
      {{"report", blocks},
       2,
       "b.csv: is no JSON; plan.json, or the --json output of calibrate, compare, next, simulate"},
      {{"report", blocks, blocks}, 2, "b.csv: is no JSON"},
      {{"report", blocks, blocks, "--brief"}, 2, "--brief does not go with two plans; it goes with one PLAN"},
      {{"report", "a", "b", "c"}, 2, "unexpected argument 'b'; one PLAN, RESULT or PROBLEM is expected"},
  };
  for (const BadCommand& bad : table) {
    const ProgramRun run = run_program(folder.path(), bad.words);
    const std::string words = testing::PrintToString(bad.words);
    EXPECT_EQ(run.exit_code, bad.exit_code) << words << run.err;
    EXPECT_THAT(run.err, HasSubstr(bad.expected)) << words;
    EXPECT_EQ(messages_in(run.err), 1) << words << run.err;
    EXPECT_EQ(run.out, "") << words;
    EXPECT_EQ(folder.count_files(), 0U) << words;
  }
}

TEST(CommandLine, FilesOfOthersAreNotReplacedUnlessForced) {
  const TemporaryFolder folder;
  folder.write("plan.json", "my notes");
  const std::vector<std::string> words = {"plan", telescope, "--candidates", "100", "--method", "exchange"};
  const ProgramRun refused = run_program(folder.path(), words);
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err,
              HasSubstr("plan.json exists and is not known to be written by posewright; --force replaces it"));
  EXPECT_EQ(read_file(folder / "plan.json"), "my notes");
  std::vector<std::string> forced = words;
  forced.push_back("--force");
  EXPECT_EQ(run_program(folder.path(), forced).exit_code, 0);
  EXPECT_EQ(run_program(folder.path(), words).exit_code, 0) << "an earlier plan of ours may be replaced";
}

TEST(CommandLine, TwoPlansInAFolderHaveTwoPoseListsAndBothMayBeReplaced) {
  const TemporaryFolder folder;
  for (const char* name : {"a.json", "plan.json", "arm.plan.json", "plan-b.json", "a.json"}) {
    const ProgramRun run = run_program(folder.path(), {"plan", telescope, "--candidates", "100", "--method", "greedy",
                                                       "--proof-time", "0", "-o", name});
    EXPECT_EQ(run.exit_code, 0) << name << run.err;
  }
  for (const char* list : {"a-poses.csv", "poses.csv", "arm.poses.csv", "poses-b.csv"})
    EXPECT_TRUE(std::filesystem::exists(folder / list)) << list;
}

TEST(CommandLine, AFolderWhoseNameIsNotUtf8HasItsPlan) {
  const TemporaryFolder folder;
  const std::filesystem::path latin = folder / "caf\xe9";
  std::filesystem::create_directory(latin);
  std::filesystem::copy_file(telescope, latin / "p.yaml");
  const std::string problem = (latin / "p.yaml").string();
  const ProgramRun run = run_program(latin, {"plan", problem, "--candidates", "100", "--method", "greedy", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto json = parse_json(run.out);
  EXPECT_THAT(json["problem"]["file"].get<std::string>(), HasSubstr("caf\xef\xbf\xbd/p.yaml"));
  EXPECT_EQ(run_program(latin, {"report", "plan.json", "--problem", "p.yaml"}).exit_code, 0);
}

TEST(CommandLine, MorePosesThanATaskTakesAreRefusedAtOnce) {
  const TemporaryFolder folder;
  std::string list = "x,y,z,rx,ry,rz\n";
  for (int i = 0; i < 100000; ++i) list += "0,0,0,0,0,0\n";
  folder.write("many.csv", list);
  const ProgramRun judged = run_program(folder.path(), {"evaluate", telescope, "many.csv"});
  EXPECT_EQ(judged.exit_code, 2);
  EXPECT_THAT(judged.err, HasSubstr("many.csv: has 100000 poses; evaluate scores at most 2000"));
  const ProgramRun routed = run_program(folder.path(), {"route", "many.csv", "--problem", telescope});
  EXPECT_EQ(routed.exit_code, 2);
  EXPECT_THAT(routed.err, HasSubstr("many.csv: has 100000 poses; route orders at most 1000"));
}

TEST(CommandLine, InterruptWritesTheBestPlanSoFar) {
  const TemporaryFolder folder;
  // Restarts that no machine gets through.
  const ProgramRun run = run_program(
      folder.path(),
      {"plan", kr270, "--poses", "40", "--candidates", "2000", "--method", "exchange", "--restarts", "1000000"}, 6.0,
      2);
  // As `timeout` does: one to the process and one to its group are one wish.
  EXPECT_EQ(run.exit_code, 130) << run.err;
  EXPECT_THAT(run.out, HasSubstr("search interrupted: best plan so far"));
  const PlanFile plan = read_back(read_file(folder / "plan.json"));
  EXPECT_EQ(plan.poses.size(), 40U);
  EXPECT_GT(plan.efficiency, 0.9);
}

TEST(CommandLine, TimeLimitEndsTheSearchWithAPlan) {
  const TemporaryFolder folder;
  const ProgramRun run = run_program(
      folder.path(), {"plan", telescope, "--candidates", "1000", "--restarts", "1000000", "--time-limit", "1.5"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(read_back(read_file(folder / "plan.json")).poses.size(), 40U);
}

TEST(CommandLine, SelectChoosesBlocksWithoutRobots) {
  const TemporaryFolder folder;
  folder.write("b.csv", csv_blocks(60, 2, 5));
  const ProgramRun run = run_program(folder.path(), {"select", "b.csv", "--rows", "2", "--poses", "7", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto json = parse_json(run.out);
  EXPECT_EQ(json["poses"].size(), 7U);
  EXPECT_FALSE(json.contains("variant"));
  EXPECT_FALSE(json["poses"][0].contains("configuration"));
  EXPECT_LE(json["criterion"]["log_det"], json["certificate"]["candidates"]["log_det_bound"]);
}

}  // namespace
}  // namespace posewright
