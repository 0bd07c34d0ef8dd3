// The command `compare` as a user meets it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "posewright/support/file.hpp"
#include "posewright/support/json.hpp"
#include "tests/kit/run_program.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

using testing::HasSubstr;

const std::string telescope_problem = std::string(POSEWRIGHT_SOURCE_DIR) + "/examples/telescope/problem.yaml";

TEST(CompareCommand, TablesNameVariantsPlansBiasAndWhatPays) {
  const TemporaryFolder folder;
  // All diagonal elements together are kappa.
  std::string text = read_file(telescope_problem);
  text.insert(text.find("  # To see what"), "  both: {parameters: [kappa, K_11, K_22, K_33, K_44, K_55, K_66]}\n");
  folder.write("both.yaml", text);
  const ProgramRun run = run_program(folder.path(), {"compare", "both.yaml", "--variant", "rigid,matrix", "--variant",
                                                     "both", "--candidates", "200", "--restarts", "1"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("3 variants, 2 plans"));
  EXPECT_THAT(run.out, HasSubstr("both: variant 'both': "));
  EXPECT_THAT(run.out, HasSubstr("best for matrix"));
  EXPECT_THAT(run.out, HasSubstr("bias/σ"));
  EXPECT_THAT(run.out, HasSubstr("matrix over rigid: pays if matrix is true: "));
  EXPECT_THAT(run.out, HasSubstr("Only measurements can show"));
  EXPECT_EQ(run.err, "");
}

TEST(CompareCommand, TruthShowsEveryParameterAndPlansThatAreGivenAreJudged) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_program(folder.path(), {"plan", telescope_problem, "--candidates", "200", "--restarts", "1", "--method",
                                        "exchange", "--poses", "20"})
                .exit_code,
            0);
  const std::vector<std::string> words = {"compare", telescope_problem, "plan.json", "poses.csv",    "--variant",
                                          "linear",  "--truth",         "rigid",     "--candidates", "200"};
  const ProgramRun run = run_program(folder.path(), words);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("linear fitted with poses.csv while rigid is true: 0 nominal values differ, 12 "));
  EXPECT_THAT(run.out, HasSubstr("leg_6.l"));
  std::vector<std::string> machine = words;
  machine.emplace_back("--json");
  const auto json = parse_json(run_program(folder.path(), machine).out);
  EXPECT_EQ(json["schema"], "posewright/comparison/1");
  ASSERT_EQ(json["scores"].size(), 4U);
  EXPECT_EQ(json["scores"][0]["log_det"], json["scores"][2]["log_det"]) << "one list in two files";
  EXPECT_TRUE(json["method"].is_null());
  ASSERT_EQ(json["aliases"].size(), 2U);
  EXPECT_EQ(json["aliases"][0]["truth"], "rigid");
}

TEST(CompareCommand, BadUsageIsToldInOneLine) {
  const TemporaryFolder folder;
  folder.write("poses.csv", "x,y,z,rx,ry\n0,0,0,0,0\n");
  struct Bad {
    std::vector<std::string> words;
    std::string message;
  };
  for (const Bad& bad : {
           Bad{{"compare"}, "PROBLEM is missing"},
           Bad{{"compare", telescope_problem, "--variant", "rigid,"}, "--variant rigid, has an empty name"},
           Bad{{"compare", telescope_problem, "--variant", "rigid", "--variant", "rigid"}, "'rigid' is named twice"},
           Bad{{"compare", telescope_problem, "--variant", "soft"}, "has no variant 'soft'"},
           Bad{{"compare", telescope_problem, "--truth", "soft"}, "has no variant 'soft'"},
           Bad{{"compare", telescope_problem, "poses.csv", "--poses", "20"}, "--poses is for plans that are searched"},
           Bad{{"compare", telescope_problem, "poses.csv", "--method", "tabu"},
               "--method is for plans that are searched"},
           Bad{{"compare", telescope_problem, "--from", "csv"}, "--from"},
           Bad{{"compare", telescope_problem, "--method", "none"}, "unknown method 'none'"},
           Bad{{"compare", telescope_problem, "poses.csv", "--candidates", "50"}, "poses.csv:1: has no column 'rz'"},
           Bad{{"compare", telescope_problem, "absent.csv", "--candidates", "50"}, "absent.csv"},
       }) {
    const ProgramRun run = run_program(folder.path(), bad.words);
    EXPECT_EQ(run.exit_code, 2) << bad.message;
    EXPECT_EQ(run.out, "");
    EXPECT_THAT(run.err, HasSubstr(bad.message));
    EXPECT_EQ(messages_in(run.err), 1) << run.err;
  }
}

TEST(CompareCommand, InterruptedItPrintsNothing) {
  const TemporaryFolder folder;
  const ProgramRun run = run_program(
      folder.path(),
      {"compare", telescope_problem, "--candidates", "20000", "--restarts", "1000", "--variant", "rigid"}, 1.0);
  EXPECT_EQ(run.exit_code, 130);
  EXPECT_EQ(run.out, "");
}

}  // namespace
}  // namespace posewright
