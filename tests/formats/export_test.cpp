// `posewright export`, and the way back through `evaluate` and `route`, as a user meets them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "posewright/formats/pose_formats.hpp"
#include "posewright/support/file.hpp"
#include "posewright/support/json.hpp"
#include "tests/kit/run_program.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const std::string golden = std::string(POSEWRIGHT_SOURCE_DIR) + "/tests/formats/golden/";
const std::string plan = golden + "plan.json", route = golden + "route.json";
const std::string kr270 = std::string(POSEWRIGHT_SOURCE_DIR) + "/examples/kr270/problem.yaml";

TEST(ExportCommand, ListsItsFormats) {
  const TemporaryFolder folder;
  const ProgramRun bare = run_program(folder.path(), {"export"});
  EXPECT_EQ(bare.exit_code, 0);
  EXPECT_EQ(bare.out, run_program(folder.path(), {"export", "--to", "list"}).out);
  EXPECT_THAT(bare.out, HasSubstr("* syntax checked, not run on a controller"));
  const auto json = parse_json(run_program(folder.path(), {"export", "--json"}).out);
  EXPECT_EQ(json["formats"].size(), pose_formats().size());
  for (const PoseFormat& format : pose_formats()) EXPECT_THAT(bare.out, HasSubstr("\n  " + format.name));
}

TEST(ExportCommand, WritesOneFileToStandardOutputAndNotesToStandardError) {
  const TemporaryFolder folder;
  const ProgramRun run = run_program(folder.path(), {"export", plan, "--to", "urscript", "-o", "-", "--unchecked"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(run.out, read_file(golden + "calposes.script"));
  EXPECT_THAT(run.err, HasSubstr("not checked for collisions"));
  EXPECT_THAT(run.err, HasSubstr("not run on a controller"));
  EXPECT_EQ(folder.count_files(), 0U);
}

TEST(ExportCommand, TellsFilesAndNotesAsJson) {
  const TemporaryFolder folder;
  const auto json = parse_json(run_program(folder.path(), {"export", plan, "--to", "kuka-krl", "-o", "out/", "--name",
                                                           "CELL3", "--json", "--unchecked"})
                                   .out);
  EXPECT_EQ(json["poses"], 3);
  EXPECT_EQ(json["files"], (std::vector<std::string>{"out/CELL3.src", "out/CELL3.dat"}));
  EXPECT_TRUE(fs::exists(folder / "out/CELL3.dat"));
}

TEST(ExportCommand, NamesFilesItselfWhereNothingElseIsSaid) {
  const TemporaryFolder folder;
  EXPECT_EQ(run_program(folder.path(), {"export", plan, "--to", "moveit"}).out, "Written: calposes.yaml\n");
  EXPECT_EQ(run_program(folder.path(), {"export", plan, "--to", "kuka-krl", "--unchecked"}).out,
            "Written: CALPOSES.src, CALPOSES.dat\n");
}

TEST(ExportCommand, ReplacesItsOwnFilesAndNoOthers) {
  const TemporaryFolder folder;
  for (const PoseFormat& format : pose_formats()) {
    if (format.several_files || format.name == "hexapod-gcs") continue;
    std::vector<std::string> words = {"export", plan, "--to", format.name, "-o", "CAL" + format.extension};
    if (format.moves_robot()) words.emplace_back("--unchecked");
    if (format.name == "abb-rapid" || format.name == "fanuc-tp") words.insert(words.end(), {"--coupling", "0"});
    if (format.name == "yaskawa-inform") words.insert(words.end(), {"--controller", golden + "yaskawa.yaml"});
    folder.write(words[5], "my notes");
    const ProgramRun refused = run_program(folder.path(), words);
    EXPECT_EQ(refused.exit_code, 1) << format.name;
    EXPECT_THAT(refused.err, HasSubstr("exists and is not known to be written by posewright; --force replaces it"));
    EXPECT_EQ(read_file(folder / words[5]), "my notes");
    words.emplace_back("--force");
    EXPECT_EQ(run_program(folder.path(), words).exit_code, 0) << format.name;
    words.pop_back();
    EXPECT_EQ(run_program(folder.path(), words).exit_code, 0) << "nothing is lost: " << format.name;
    // Formats that have no place for a comment cannot be told from others once they differ, and a list of poses may
    // have readings by now.
    const bool bare = format.name == "pybotics-npy" || format.name == "robodk-csv" || format.name == "csv" ||
                      format.name == "targets-csv" || format.name == "powerinspect";
    if (format.to_be_filled) continue;
    folder.write(words[5], read_file(folder / words[5]) + "\n");
    EXPECT_EQ(run_program(folder.path(), words).exit_code, bare ? 1 : 0) << format.name;
  }
}

TEST(ExportCommand, KeepsWhatWasMeasuredAndPutIntoAFile) {
  const TemporaryFolder folder;
  for (const char* format : {"figaroh-csv", "industrial-calibration", "pybotics-csv", "delmia", "easy-handeye2"}) {
    const std::vector<std::string> words = {"export", plan, "--to",
                                            format,   "-o", "m" + find_pose_format(format).extension};
    ASSERT_EQ(run_program(folder.path(), words).exit_code, 0) << format;
    EXPECT_EQ(run_program(folder.path(), words).exit_code, 0) << "nothing was filled in yet: " << format;
    const std::string filled = read_file(folder / words[5]) + " ";
    folder.write(words[5], filled);
    const ProgramRun refused = run_program(folder.path(), words);
    EXPECT_EQ(refused.exit_code, 1) << format;
    EXPECT_THAT(refused.err, HasSubstr("may hold measurements by now"));
    EXPECT_EQ(read_file(folder / words[5]), filled);
    fs::remove(folder / words[5]);
  }
}

struct BadExport {
  std::vector<std::string> words;
  int exit_code;
  const char* expected;
};

TEST(ExportCommand, EveryMistakeGivesTheRightCodeAndNoFile) {
  const TemporaryFolder folder, inputs;
  const std::string blocks =
      inputs.write("blocks.json", R"({"schema": "posewright/plan/1", "poses": [{"id": 1}]})").string();
  const std::string text = inputs.write("poses.csv", "a,b\n1,2\n").string();
  const std::string settings = inputs.write("r.yaml", "colour: red\n").string();
  const std::vector<BadExport> table = {
      {{plan, "--to", "excel"}, 2, "'excel' is not a format that is written; allowed: kuka-krl, abb-rapid, fanuc-tp"},
      {{"--to", "csv"}, 2, "PLAN is missing"},
      {{plan, "another", "--to", "csv"}, 2, "unexpected argument 'another'"},
      {{"missing.json", "--to", "csv"}, 2, "missing.json"},
      {{blocks, "--to", "csv"}, 2, "is not a plan with configurations"},
      {{text, "--to", "moveit"}, 2, "is not a plan with configurations"},
      {{plan, "--to", "fanuc-tp"}, 2, "fanuc-tp needs --coupling F"},
      {{plan, "--to", "yaskawa-inform", "--coupling", "0"}, 2, "needs pulses_per_degree in --controller FILE"},
      {{plan, "--to", "kuka-krl", "--controller", settings}, 2, "r.yaml:1: unknown key 'colour'"},
      {{plan, "--to", "moveit", "--speed", "5"}, 2, "--speed is not read for moveit; it has no options"},
      {{plan, "--to", "srdf", "--tool", "5"}, 2, "--tool is not read for srdf; allowed: --name, --group"},
      {{plan, "--to", "kuka-krl", "--payload", "3"}, 2, "--payload is not read for kuka-krl"},
      {{plan, "--to", "urscript", "--speed", "0"}, 2, "--speed 0; a whole number from 1 to 100"},
      {{plan, "--to", "urscript", "--settle", "-1"}, 2, "--settle -1; a number from 0 to 3600"},
      {{plan, "--to", "urscript", "--wait", "nan"}, 2, "--wait nan"},
      {{plan, "--to", "kuka-krl", "-o", "-"}, 2, "kuka-krl has several files"},
      {{plan, "--to", "csv", "-o", "-", "--json"}, 2, "both need stdout"},
      {{plan, "--to", "kuka-krl", "-o", "A.src", "--name", "B"}, 2, "--name B is not the name of A.src"},
      {{plan, "--to", "kuka-krl", "-o", "no good.src"}, 2, "'no good' is not a name of a kuka-krl program"},
      {{plan, "--to", "moveit", "-o", "states.txt"}, 2, "reads files that end in .yaml"},
      {{plan, "--to", "hexapod-gcs"}, 1, "is for six-legged platforms"},
      {{route, "--to", "joint-trajectory"}, 1, "cannot wait for a change of station or load case"},
      {{plan, "--to", "moveit", "--unchecked"}, 2, "--unchecked is not read for moveit; lists are not checked"},
      {{plan, "--to", "csv", "-o", plan}, 2, "is an input"},
      {{plan, "--to", "csv", "-o", "no/such/poses.csv"}, 1, "cannot be written"},
  };
  for (const BadExport& bad : table) {
    std::vector<std::string> words = bad.words;
    words.insert(words.begin(), "export");
    // The robot of the golden plan is nowhere: what is wrong with the words is to be told all the same.
    for (const PoseFormat& format : pose_formats())
      if (format.moves_robot() && std::find(words.begin(), words.end(), format.name) != words.end())
        words.emplace_back("--unchecked");
    const ProgramRun run = run_program(folder.path(), words);
    EXPECT_EQ(run.exit_code, bad.exit_code) << testing::PrintToString(words) << run.err;
    EXPECT_THAT(run.err, HasSubstr(bad.expected)) << testing::PrintToString(words);
    EXPECT_EQ(run.out, "") << testing::PrintToString(words);
    EXPECT_EQ(folder.count_files(), 0U) << testing::PrintToString(words);
  }
}

double log_det(const ProgramRun& run) {
  EXPECT_EQ(run.exit_code, 0) << run.err;
  return run.exit_code == 0 ? parse_json(run.out)["criterion"]["log_det"].get<double>() : 0;
}

/// A plan of a real arm, once for all tests.
const fs::path& arm_folder() {
  static const TemporaryFolder folder;
  static const bool made = [] {
    const ProgramRun run =
        run_program(folder.path(), {"plan", kr270, "--candidates", "200", "--restarts", "1", "--poses", "8", "--method",
                                    "greedy", "-o", "p.json", "--poses-csv", "-"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return true;
  }();
  EXPECT_TRUE(made);
  return folder.path();
}

TEST(PosesBack, EveryReadableFormatScoresAsThePlan) {
  const fs::path& folder = arm_folder();
  const auto evaluate = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {"evaluate", kr270});
    words.insert(words.end(), {"--candidates", "60", "--json"});
    return run_program(folder, words);
  };
  const double wanted = log_det(evaluate({"p.json"}));
  for (const PoseFormat& format : pose_formats()) {
    if (format.read == nullptr) continue;
    const std::string file = "list" + format.extension;
    ASSERT_EQ(run_program(folder, {"export", "p.json", "--to", format.name, "-o", file, "--force"}).exit_code, 0);
    const ProgramRun run = evaluate({file, "--from", format.name});
    EXPECT_NEAR(log_det(run), wanted, 1e-9) << format.name;
    const bool nameless = format.read(read_file(folder / file), file).names.empty();
    EXPECT_EQ(run.err.find("names no joints") != run.err.npos, nameless) << format.name << run.err;
  }
  EXPECT_THAT(
      evaluate({"p.json", "--from", "targets-csv"}).err,
      testing::MatchesRegex(".*'targets-csv' is not a format that is read; allowed: joint-trajectory, .*kuka-krl.*\n"));
  EXPECT_THAT(evaluate({"p.json", "--from", "kuka-krl"}).err, HasSubstr("p.json: has neither points nor motions"));
}

TEST(PosesBack, ARouteIsAPoseListAndListsAreRouted) {
  const fs::path& folder = arm_folder();
  ASSERT_EQ(run_program(folder, {"route", "p.json", "--start", "3", "-o", "r.json"}).exit_code, 0);
  const auto first = parse_json(read_file(folder / "r.json"));
  // The route's own poses keep their ids.
  const ProgramRun again = run_program(folder, {"route", "r.json", "--start", "3", "-o", "again.json"});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  const auto second = parse_json(read_file(folder / "again.json"));
  EXPECT_EQ(second["order"][0], 3);
  for (const auto& pose : second["poses"])
    for (const auto& other : first["poses"]) {
      if (other["id"] != pose["id"]) continue;
      EXPECT_EQ(other["configuration"], pose["configuration"]);
    }
  ASSERT_EQ(run_program(folder, {"export", "p.json", "--to", "moveit", "-o", "m.yaml"}).exit_code, 0);
  EXPECT_THAT(run_program(folder, {"route", "m.yaml", "--from", "moveit"}).err,
              HasSubstr("give it with --problem FILE"));
  const ProgramRun listed =
      run_program(folder, {"route", "m.yaml", "--from", "moveit", "--problem", kr270, "-o", "l.json"});
  ASSERT_EQ(listed.exit_code, 0) << listed.err;
  EXPECT_EQ(parse_json(read_file(folder / "l.json"))["order"].size(), 8U);
  // And a program of it measures every pose.
  ASSERT_EQ(run_program(folder, {"export", "l.json", "--to", "kuka-krl", "-o", "LIST.src"}).exit_code, 0);
  const std::string source = read_file(folder / "LIST.src");
  std::size_t measured = 0;
  for (std::size_t at = 0; (at = source.find("]=TRUE", at)) != source.npos; ++at) ++measured;
  EXPECT_EQ(measured, 8U);
}

}  // namespace
}  // namespace posewright
