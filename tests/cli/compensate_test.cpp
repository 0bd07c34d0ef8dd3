// `compensate` as a user meets it: which robot it takes, what it writes, what it refuses.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "posewright/support/file.hpp"
#include "posewright/support/json.hpp"
#include "posewright/support/sha256.hpp"
#include "tests/kit/run_program.hpp"
#include "tests/kit/temporary_folder.hpp"
#include "tests/kit/urdf_text.hpp"

namespace posewright {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr const char* header = "# by hand\nname,j1,j2,j3,j4,j5,j6\n";
constexpr const char* good_poses = "a,0.1,0.2,0.3,0.4,0.5,0.2\nb,-0.1,0.3,0.5,0.4,0.7,0.2\n";

/// An arm, its problem, its parameters and a list of poses.
class CompensateCommand : public testing::Test {
 protected:
  CompensateCommand() {
    for (const NamedChain& named : named_chains())
      if (std::string(named.name) == "anthropomorphic_6R") folder_.write("arm.urdf", urdf_text(named.joints));
    folder_.write("p.yaml", problem);
    folder_.write("cal.yaml",
                  parameters(problem, "{j2.x: {value: 0.3503, unit: m}, j4.offset: {value: 0.001, unit: rad}}"));
    folder_.write("list.csv", std::string(header) + good_poses);
  }

  static std::string parameters(const std::string& of, const std::string& values) {
    return "posewright_parameters: 1\nvariant: all\nproblem: {file: p.yaml, sha256: " + sha256_hex(of) +
           "}\nparameters: " + values + "\n";
  }
  ProgramRun run(std::vector<std::string> words) const {
    words.insert(words.begin(), "compensate");
    return run_program(folder_.path(), words);
  }
  bool is_there(const std::string& name) const { return std::filesystem::exists(folder_ / name); }

  const std::string problem =
      "posewright: 1\nrobot: {urdf: arm.urdf}\n"
      "measurement: {type: pose, device: {type: isotropic, noise: {position: 0.1 mm, rotation: 0.2 mrad}}}\n"
      "variants: {all: {parameters: auto}}\ndesign: {poses: 20}\n";
  TemporaryFolder folder_;
};

TEST_F(CompensateCommand, WritesTheListWithOtherJointsAndSaysWhatItIsWorth) {
  const ProgramRun table = run({"cal.yaml", "list.csv"});
  ASSERT_EQ(table.exit_code, 0) << table.err;
  EXPECT_THAT(table.out, HasSubstr("2 of 2 poses are compensated, variant all"));
  EXPECT_THAT(table.out, HasSubstr("position before [mm]"));
  EXPECT_EQ(folder_.count_files(), 4U) << "without -o nothing is written";

  const ProgramRun written = run({"cal.yaml", "list.csv", "-o", "out.csv", "--json"});
  ASSERT_EQ(written.exit_code, 0) << written.err;
  const json result = parse_json(written.out);
  EXPECT_EQ(result["written"], json({"out.csv"}));
  EXPECT_GT(result["error"]["before"]["position_largest"], 1e-4);
  EXPECT_LT(result["error"]["after"]["position_largest"], 1e-9);
  const std::string text = read_file(folder_ / "out.csv");
  EXPECT_THAT(text, HasSubstr("# by hand\nname,j1,j2,j3,j4,j5,j6\na,"));
  EXPECT_NEAR(result["lists"][0]["poses"][0]["configuration"][3], 0.399, 1e-3);

  EXPECT_EQ(run({"cal.yaml", "list.csv", "-o", "out.csv"}).exit_code, 0) << "its own file is replaced";
  const ProgramRun twice = run({"cal.yaml", "out.csv", "-o", "more.csv"});
  EXPECT_EQ(twice.exit_code, 2);
  EXPECT_THAT(twice.err, HasSubstr("out.csv: is compensated already"));
  EXPECT_FALSE(is_there("more.csv"));
}

TEST_F(CompensateCommand, TakesTheRobotThatWasCalibratedAndNoOther) {
  folder_.write("p.yaml", problem + "# another word\n");
  const ProgramRun other = run({"cal.yaml", "list.csv", "-o", "out.csv"});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.err, HasSubstr("cal.yaml:3: p.yaml has sha256 "));
  EXPECT_THAT(other.err, HasSubstr("or --problem FILE if it is the same robot"));
  EXPECT_EQ(messages_in(other.err), 1);
  EXPECT_FALSE(is_there("out.csv"));
  EXPECT_EQ(run({"cal.yaml", "list.csv", "-o", "out.csv", "--problem", "p.yaml"}).exit_code, 0);

  std::filesystem::remove(folder_ / "p.yaml");
  EXPECT_THAT(run({"cal.yaml", "list.csv"}).err, HasSubstr("cal.yaml:3: its problem file 'p.yaml' is not there"));
  folder_.write("none.yaml", "posewright_parameters: 1\nvariant: all\nparameters: {j2.x: {value: 0.3503}}\n");
  EXPECT_THAT(run({"none.yaml", "list.csv"}).err, HasSubstr("none.yaml: names no problem file"));
}

TEST_F(CompensateCommand, WritesNothingWhereAPoseCannotBeHadUnlessTheRestIsAskedFor) {
  // Joint 4 would have to stand a milliradian beyond -2.5.
  folder_.write("list.csv", std::string(header) + good_poses + "c,0.1,0.2,0.3,-2.5,0.5,0.2\n");
  const ProgramRun refused = run({"cal.yaml", "list.csv", "-o", "out.csv", "--urdf", "out.urdf"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.out, HasSubstr("list.csv:5: pose 3: 'j4' would be at -143.3"));
  EXPECT_THAT(refused.err, HasSubstr("no file is written; --partial"));
  EXPECT_FALSE(is_there("out.csv"));
  EXPECT_FALSE(is_there("out.urdf"));
  const ProgramRun partial = run({"cal.yaml", "list.csv", "-o", "out.csv", "--partial"});
  EXPECT_EQ(partial.exit_code, 0);
  EXPECT_THAT(read_file(folder_ / "out.csv"), HasSubstr("\nc,0.1,0.2,0.3,-2.5,0.5,0.2\n"));

  folder_.write("list.csv", std::string(header) + "c,0.1,0.2,0.3,-2.6,0.5,0.2\n");
  const ProgramRun beyond = run({"cal.yaml", "list.csv"});
  EXPECT_EQ(beyond.exit_code, 2);
  EXPECT_THAT(beyond.err, HasSubstr("list.csv:3: 'j4' is -2.6 rad; allowed: -2.5 to 2.5 rad"));
}

TEST_F(CompensateCommand, WritesSeveralFilesIntoAFolderAllOrNone) {
  std::filesystem::create_directory(folder_ / "out");
  folder_.write(
      "weld.dat",
      "DEFDAT WELD\n;mine\nDECL E6AXIS XP={A1 5,A2 10,A3 20,A4 20,A5 30,A6 5,E1 0,E2 0,E3 0,E4 0,E5 0,E6 0}\nENDDAT\n");
  const ProgramRun good = run({"cal.yaml", "list.csv", "weld.dat", "-o", "out"});
  ASSERT_EQ(good.exit_code, 0) << good.err;
  EXPECT_TRUE(is_there("out/list.csv"));
  EXPECT_THAT(read_file(folder_ / "out/weld.dat"), HasSubstr("E1 0,E2 0,E3 0,E4 0,E5 0,E6 0}"));
  std::filesystem::remove_all(folder_ / "out");
  folder_.write("weld.dat", "DEFDAT WELD\nDECL E6AXIS XP={A1 5,A2 10,A3 20,A4 20,A5 30}\nENDDAT\n");
  const ProgramRun bad = run({"cal.yaml", "list.csv", "weld.dat", "-o", "out"});
  EXPECT_EQ(bad.exit_code, 1);
  EXPECT_THAT(bad.out, HasSubstr("has no axis A6: it stays where it is"));
  EXPECT_FALSE(is_there("out")) << "a folder that nothing comes into is not left behind";
  // The program of the points says none itself.
  folder_.write("weld.dat", "DEFDAT WELD\nDECL E6AXIS P={A1 5,A2 10,A3 20,A4 20,A5 30,A6 5}\nENDDAT\n");
  folder_.write("weld.src", "DEF WELD( )\nPTP P\nEND\n");
  EXPECT_EQ(run({"cal.yaml", "weld.src", "weld.dat", "-o", "made/"}).exit_code, 0);
  EXPECT_EQ(read_file(folder_ / "made/weld.src"), "DEF WELD( )\nPTP P\nEND\n");
  EXPECT_NE(read_file(folder_ / "made/weld.dat"), read_file(folder_ / "weld.dat"));
}

TEST_F(CompensateCommand, NeverWritesOverAnInputOrAStrangersFile) {
  EXPECT_EQ(run({"cal.yaml", "list.csv", "-o", "list.csv", "--force"}).exit_code, 2);
  EXPECT_EQ(run({"cal.yaml", "list.csv", "-o", "cal.yaml"}).exit_code, 2);
  EXPECT_EQ(run({"cal.yaml", "list.csv", "--urdf", "arm.urdf"}).exit_code, 2);
  folder_.write("theirs.csv", "a,b\n1,2\n");
  EXPECT_EQ(run({"cal.yaml", "list.csv", "-o", "theirs.csv"}).exit_code, 1);
  EXPECT_EQ(read_file(folder_ / "theirs.csv"), "a,b\n1,2\n");
}

TEST_F(CompensateCommand, WritesTheRobotItselfFromTheParameters) {
  const ProgramRun run_urdf = run({"cal.yaml", "--urdf", "real.urdf", "--dh", "distal"});
  ASSERT_EQ(run_urdf.exit_code, 0) << run_urdf.err;
  EXPECT_THAT(read_file(folder_ / "real.urdf"), HasSubstr("0.3503"));
  EXPECT_THAT(run_urdf.out, HasSubstr("Denavit"));
  const ProgramRun no_ur = run({"cal.yaml", "--ur-kinematics", "kinematics.yaml"});
  EXPECT_EQ(no_ur.exit_code, 1);
  EXPECT_THAT(no_ur.err, HasSubstr("joint 'j1' does not belong to a Universal Robots arm"));
  EXPECT_EQ(run({"cal.yaml"}).exit_code, 2);
}

}  // namespace
}  // namespace posewright
