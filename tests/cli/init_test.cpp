// `init` as a user meets it: a robot and an instrument in, a file that plans out; questions on a terminal alone.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "posewright/problem/read_problem.hpp"
#include "posewright/support/file.hpp"
#include "posewright/support/json.hpp"
#include "posewright/tasks/known_cameras.hpp"
#include "tests/kit/run_program.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::string kr270 = POSEWRIGHT_SOURCE_DIR "/examples/kr270/kr270.urdf";

class Init : public testing::Test {
 protected:
  ProgramRun program(const std::vector<std::string>& words) const { return run_program(folder.path(), words); }
  ProgramRun init(std::vector<std::string> words) const {
    words.insert(words.begin(), "init");
    words.emplace_back("--yes");
    return program(words);
  }
  /// With a tracker and eight poses.
  ProgramRun init_arm(const std::string& urdf) const {
    folder.write("arm.urdf", urdf);
    return init({"arm.urdf", "--tracker", "--poses", "8"});
  }
  std::string problem_text() const { return read_file(folder / "problem.yaml"); }

  const TemporaryFolder folder;
};

/// The text with something else in place of the first `old`.
std::string with(std::string text, const std::string& old, const std::string& other) {
  return text.replace(text.find(old), old.size(), other);
}

/// Runs `init` with a terminal as its input, output and error; each answer is typed when the program waits for it.
std::pair<int, std::string> at_a_terminal(const TemporaryFolder& folder, const std::vector<std::string>& words,
                                          const std::vector<std::string>& answers) {
  int terminal = -1;
  const pid_t child = ::forkpty(&terminal, nullptr, nullptr, nullptr);
  if (child == 0) {
    std::vector<std::string> copies = {POSEWRIGHT_PROGRAM, "init"};
    copies.insert(copies.end(), words.begin(), words.end());
    std::vector<char*> arguments;
    for (std::string& word : copies) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    std::filesystem::current_path(folder.path());
    ::execv(arguments[0], arguments.data());
    ::_exit(127);
  }
  std::string shown;
  std::size_t given = 0, seen = 0;
  char bytes[4096];
  for (ssize_t n = 0; (n = ::read(terminal, bytes, sizeof bytes)) > 0;) {
    shown.append(bytes, std::size_t(n));
    if (given < answers.size() && shown.find("]: ", seen) != std::string::npos) {
      seen = shown.size();
      const std::string line = answers[given++] + "\n";
      if (::write(terminal, line.data(), line.size()) < 0) break;
    }
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  ::close(terminal);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, shown};
}

TEST_F(Init, WritesAFileThatPlansWithoutAnEdit) {
  const ProgramRun run = init({kr270, "--tracker", "--poses", "12"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("problem.yaml: 6 joints from base_link to flange, laser tracker"));
  EXPECT_THAT(run.out, HasSubstr("posewright plan problem.yaml"));
  const ProgramRun plan = program({"plan", "problem.yaml", "--proof-time", "0"});
  EXPECT_EQ(plan.exit_code, 0) << plan.err;
  EXPECT_THAT(plan.out, HasSubstr("12 poses for variant geometric"));
}

/// An arm of three axes that hangs down from its foot where all joints are at zero.
const char* const hanging = R"(<robot name="hanging">
  <link name="base"><collision><geometry><box size="0.3 0.3 0.2"/></geometry></collision></link>
  <link name="l1"><collision><geometry><cylinder radius="0.08" length="0.2"/></geometry></collision></link>
  <link name="l2"><collision><origin xyz="0 0 -0.3"/><geometry><box size="0.08 0.08 0.5"/></geometry></collision></link>
  <link name="l3"><collision><origin xyz="0 0 -0.25"/><geometry><box size="0.06 0.06 0.3"/></geometry></collision></link>
  <link name="flange"/>
  <joint name="j1" type="revolute"><parent link="base"/><child link="l1"/><origin xyz="0 0 0.3"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" effort="1" velocity="2"/></joint>
  <joint name="j2" type="revolute"><parent link="l1"/><child link="l2"/><origin xyz="0.4 0 0"/><axis xyz="0 1 0"/>
    <limit lower="-3" upper="3" effort="1" velocity="2"/></joint>
  <joint name="j3" type="revolute"><parent link="l2"/><child link="l3"/><origin xyz="0 0 -0.6"/><axis xyz="0 1 0"/>
    <limit lower="-2.5" upper="2.5" effort="1" velocity="2"/></joint>
  <joint name="end" type="fixed"><parent link="l3"/><child link="flange"/><origin xyz="0 0 -0.42"/></joint>
</robot>)";

TEST_F(Init, ProposesAFreeHomeAndPosesThatARouteKeeps) {
  const ProgramRun run = init_arm(hanging);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(problem_text(), HasSubstr("reachable: true"));
  EXPECT_THAT(problem_text(), Not(HasSubstr("\"j2\": \"0 deg\""))) << "zero is in the floor";
  ASSERT_EQ(program({"plan", "problem.yaml", "--proof-time", "0"}).exit_code, 0);
  const ProgramRun route = program({"route", "plan.json", "--from-home"});
  EXPECT_EQ(route.exit_code, 0) << route.err;
  EXPECT_THAT(route.out, HasSubstr("8 poses in "));
}

TEST_F(Init, KeepsJointsThatTurnMoreThanOnceWithinOneTurn) {
  const std::string limits = "lower=\"-3\" upper=\"3\"";
  const std::string text =
      with(with(hanging, limits, "lower=\"-6\" upper=\"6\""), limits, "lower=\"-3.3\" upper=\"2.9\"");
  ASSERT_EQ(init_arm(text).exit_code, 0);
  EXPECT_THAT(problem_text(), HasSubstr("    limits: {\"j1\": [\"-180 deg\", \"180 deg\"]}\n"));
}

TEST_F(Init, LeavesMotionsOutWhereNoVelocityIsKnown) {
  std::string text = hanging;
  for (std::size_t at = 0; (at = text.find("velocity=\"2\"", at)) != std::string::npos;)
    text.replace(at, 12, "velocity=\"0\"");
  const ProgramRun run = init_arm(text);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("reachability of poses is not checked"));
  EXPECT_THAT(problem_text(), Not(HasSubstr("reachable")));
}

/// A program `xacro` that is first in the search path, as long as this lives: it writes the file without its macros.
class OwnXacro {
 public:
  explicit OwnXacro(const TemporaryFolder& folder) : path_(std::getenv("PATH")) {
    std::filesystem::create_directories(folder / "bin");
    const auto script = folder.write("bin/xacro", "#!/bin/sh\ngrep -v xacro: \"$1\"\n");
    std::filesystem::permissions(script, std::filesystem::perms::owner_all);
    ::setenv("PATH", ((folder / "bin").string() + ":" + path_).c_str(), 1);
  }
  ~OwnXacro() { ::setenv("PATH", path_.c_str(), 1); }
  OwnXacro(const OwnXacro&) = delete;
  OwnXacro& operator=(const OwnXacro&) = delete;

 private:
  std::string path_;
};

TEST_F(Init, WritesTheExpandedRobotBesideTheProblemSoThatLaterCommandsNeedNoXacro) {
  std::filesystem::create_directories(folder / "robots/meshes");
  folder.write("robots/meshes/tip.obj",
               "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0 0 0.1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  std::string text = with(hanging, "<box size=\"0.06 0.06 0.3\"/>", "<mesh filename=\"meshes/tip.obj\"/>");
  text.insert(text.find('\n') + 1, "<xacro:arg name=\"side\"/>\n");
  folder.write("robots/arm.urdf.xacro", text);
  {
    const OwnXacro xacro(folder);
    const ProgramRun run =
        init({"robots/arm.urdf.xacro", "--xacro", "side=left", "--tracker", "--poses", "8", "-o", "cell.yaml"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.err, "") << "the mesh is found";
  }
  const std::string problem = read_file(folder / "cell.yaml"), urdf = read_file(folder / "cell.urdf");
  EXPECT_THAT(problem, HasSubstr("urdf: \"cell.urdf\""));
  EXPECT_THAT(problem, HasSubstr("# urdf: \"robots/arm.urdf.xacro\"\n  # xacro: {\"side\": \"left\"}\n"));
  EXPECT_THAT(urdf, Not(HasSubstr("xacro:")));
  EXPECT_THAT(urdf, HasSubstr("filename=\"" + (folder / "robots/meshes/tip.obj").string() + "\""));
  EXPECT_EQ(program({"plan", "cell.yaml", "--proof-time", "0"}).exit_code, 0);

  const OwnXacro xacro(folder);
  folder.write("other.urdf", "mine\n");
  const ProgramRun refused = init({"robots/arm.urdf.xacro", "--xacro", "side=left", "--tracker", "-o", "other.yaml"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err, HasSubstr("other.urdf exists; --force replaces it"));
  EXPECT_EQ(read_file(folder / "other.urdf"), "mine\n");
  EXPECT_FALSE(std::filesystem::exists(folder / "other.yaml"));
}

/// The lines that notes of what is left out name, "problem.yaml:41", in their order.
std::vector<std::string> lines_named(const std::string& notes, const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream each(text);
  std::vector<std::string> all;
  for (std::string line; std::getline(each, line);) all.push_back(line);
  const std::string key = "problem.yaml:";
  for (std::size_t at = 0; (at = notes.find(key, at)) != std::string::npos; at += key.size())
    lines.push_back(all.at(std::size_t(std::stoi(notes.substr(at + key.size()))) - 1));
  return lines;
}

TEST_F(Init, WritesTheFloorAsACommentWhereAnArmHangsBelowIt) {
  const ProgramRun run = init_arm(with(with(hanging, "0 0 0.3", "0 0 -0.3"), "0.4 0 0", "0 0 0"));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("and 'floor' are too near in"));
  const auto lines = lines_named(run.err, problem_text());
  ASSERT_EQ(lines.size(), 1U) << run.err;
  EXPECT_EQ(lines.front(), "    #   - {name: floor, plane: [0, 0, 1], at: [0, 0, \"-100 mm\"]}");
  EXPECT_EQ(program({"plan", "problem.yaml", "--proof-time", "0"}).exit_code, 0);

  const ProgramRun said = init({"arm.urdf", "--tracker", "--floor", "-100mm", "--force"});
  EXPECT_EQ(said.exit_code, 1) << "a floor that somebody names is there";
  EXPECT_THAT(said.err, HasSubstr("'collision with floor' rejects"));
}

TEST_F(Init, IgnoresThePairOfLinksThatLeavesNoPoseFreeAndNamesTheLine) {
  // Two cabinets, one on each side, and the arm is in one of them wherever it stands.
  const std::string base = "<box size=\"0.3 0.3 0.2\"/></geometry></collision></link>";
  const std::string text =
      with(hanging, base,
           base +
               "<link name=\"left\"><collision><geometry><box size=\"4 4 4\"/></geometry></collision></link>"
               "<link name=\"right\"><collision><geometry><box size=\"4 4 4\"/></geometry></collision></link>"
               "<joint name=\"a\" type=\"fixed\"><parent link=\"base\"/><child link=\"left\"/>"
               "<origin xyz=\"0 2.01 0\"/></joint><joint name=\"b\" type=\"fixed\"><parent link=\"base\"/>"
               "<child link=\"right\"/><origin xyz=\"0 -2.01 0\"/></joint>");
  folder.write("arm.urdf", text);
  const ProgramRun run = init({"arm.urdf", "--tracker", "--poses", "8", "--floor", "none"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("random configurations, no pose was free: this pair is ignored in problem.yaml:"));
  const auto lines = lines_named(run.err, problem_text());
  ASSERT_FALSE(lines.empty()) << run.err;
  for (const std::string& line : lines)
    EXPECT_THAT(line, testing::ContainsRegex("      - \\[\"l[123]\", \"(left|right)\"\\]"));
  EXPECT_EQ(program({"plan", "problem.yaml", "--proof-time", "0"}).exit_code, 0);
}

TEST_F(Init, RefusesLinksOfAnotherUnitThanTheArm) {
  const ProgramRun run = init_arm(with(hanging, "0.08 0.08 0.5", "80 80 500"));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("arm.urdf:4: link 'l2' is 5e+02 m large on an arm that reaches 1.4 m"));
  EXPECT_FALSE(read_problem(folder / "problem.yaml").workspace.collision);
}

TEST_F(Init, PutsTheFloorUnderWhatTheArmStandsOnAndNotUnderAFixtureElsewhere) {
  const std::string base = "<box size=\"0.3 0.3 0.2\"/></geometry></collision></link>";
  const std::string text =
      with(hanging, base,
           "<box size=\"0.3 0.3 0.2\"/></geometry></collision></link><link name=\"camera\"><collision><geometry>"
           "<sphere radius=\"0.05\"/></geometry></collision></link><joint name=\"a\" type=\"fixed\"><parent "
           "link=\"base\"/><child link=\"camera\"/><origin xyz=\"0.8 0 -0.4\"/></joint>");
  ASSERT_EQ(init_arm(text).exit_code, 0);
  EXPECT_THAT(problem_text(), HasSubstr("plane: [0, 0, 1], at: [0, 0, \"-100 mm\"]"));
}

TEST_F(Init, SaysEachChoiceInTheOrderRobotInstrumentCellPlan) {
  ASSERT_EQ(init({kr270, "--camera", "realsense-d435"}).exit_code, 0);
  const std::string text = problem_text();
  std::size_t at = 0;
  for (const char* part :
       {"# yaml-language-server: $schema=/", "\n# 1. Robot:", "\nrobot:", "\n# 2. Instrument:", "\nmeasurement:",
        "\n# 3. Cell:", "\nworkspace:", "\n# 4. Plan:", "\nvariants:", "\ndesign:"}) {
    const std::size_t found = text.find(part);
    ASSERT_NE(found, std::string::npos) << part;
    EXPECT_GE(found, at) << part;
    at = found;
  }
  EXPECT_THAT(text, HasSubstr("data sheet 337029")) << "where the lens is from";
  const std::string schema = text.substr(text.find('=') + 1, text.find('\n') - text.find('=') - 1);
  EXPECT_TRUE(std::filesystem::is_regular_file(schema)) << schema;
}

TEST_F(Init, PutsTheBoardWhereTheCameraOnTheHandSeesIt) {
  ASSERT_EQ(init({kr270, "--camera", "1920x1200@2300", "--board", "5x7x40mm", "-o", "c.yaml"}).exit_code, 0);
  const Problem problem = read_problem(folder / "c.yaml");
  const auto& camera = std::get<CameraMeasurement>(problem.measurement.instrument);
  EXPECT_EQ(camera.rows, 5);
  EXPECT_EQ(camera.columns, 7);
  EXPECT_DOUBLE_EQ(camera.spacing, 0.04);
  EXPECT_DOUBLE_EQ(camera.fx, 2300);
  EXPECT_TRUE(camera.on_hand);
  const ProgramRun seen = program({"observe", "c.yaml", "--candidates", "50", "--variant", "hand_eye"});
  EXPECT_EQ(seen.exit_code, 0) << seen.err;
  EXPECT_THAT(seen.out, HasSubstr("6 of 6 parameters can be identified"));
}

/// Three slides and a turn about the vertical: the hand always looks up.
std::string cart_urdf() {
  std::string text = "<robot name='cart'><link name='base_link'/>";
  std::string parent = "base_link";
  for (const auto& [name, type, axis, range] :
       {std::array{"px", "prismatic", "1 0 0", "0.3"}, std::array{"py", "prismatic", "0 1 0", "0.3"},
        std::array{"pz", "prismatic", "0 0 1", "0.3"}, std::array{"rz", "revolute", "0 0 1", "3.2"}}) {
    text += fmt::format(
        "<link name='{0}_link'/><joint name='{0}' type='{1}'><parent link='{2}'/><child link='{0}_link'/>"
        "<axis xyz='{3}'/><limit lower='-{4}' upper='{4}' effort='1' velocity='1'/></joint>",
        name, type, parent, axis, range);
    parent = std::string(name) + "_link";
  }
  return text + "</robot>";
}

TEST_F(Init, StandsCameraOrBoardBeforeAHandThatTurnsAboutOneAxisAndHoldsItsHeight) {
  folder.write("robot.urdf", cart_urdf());
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"--fixed-camera"}, {}, {"--fixed-camera", "--at", "0,0,0.8"}}) {
    std::vector<std::string> all = {"robot.urdf", "--camera", "realsense-d435", "--force"};
    all.insert(all.end(), words.begin(), words.end());
    const ProgramRun run = init(all);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.err, HasSubstr("no motion of this arm separates board.z from the other parameters"));
    EXPECT_THAT(problem_text(), HasSubstr("    fixed: [\"board.z\"]\n"));
    const ProgramRun plan = program({"plan", "problem.yaml", "--candidates", "100", "--restarts", "1", "--force"});
    EXPECT_EQ(plan.exit_code, 0) << plan.err;
    EXPECT_THAT(plan.out, HasSubstr("6 parameters and 5 nuisance parameters"));
  }
}

TEST_F(Init, PlacesAndLinksThatAreSaidAreTaken) {
  const ProgramRun run = init({kr270, "--tracker", "--at", "4,-1,500mm", "--base", "link_1", "--tip", "link_6",
                               "--accuracy", "0.2mm", "--floor", "none"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Problem problem = read_problem(folder / "problem.yaml");
  const auto& points = std::get<PointsMeasurement>(problem.measurement.instrument);
  EXPECT_TRUE(points.stations.front().placement.position.isApprox(Eigen::Vector3d(4, -1, 0.5)));
  EXPECT_EQ(std::get<SerialArmSpec>(problem.robot).base->value, "link_1");
  EXPECT_EQ(std::get<SerialArmSpec>(problem.robot).tip->value, "link_6");
  EXPECT_TRUE(problem.workspace.collision->obstacles.empty());
  EXPECT_THAT(problem_text(), HasSubstr("poses: auto"));
}

TEST_F(Init, WritesOverNothingThatIsThere) {
  folder.write("problem.yaml", "mine\n");
  const ProgramRun refused = init({kr270, "--tracker"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err, HasSubstr("problem.yaml exists; --force replaces it"));
  EXPECT_EQ(problem_text(), "mine\n");
  EXPECT_EQ(init({kr270, "--tracker", "--force"}).exit_code, 0);
  EXPECT_EQ(init({kr270, "--tracker"}).exit_code, 1) << "it may have been edited since";
  folder.write("robot.urdf", read_file(kr270));
  EXPECT_EQ(init({"robot.urdf", "--tracker", "-o", "robot.urdf", "--force"}).exit_code, 2);
  EXPECT_EQ(read_file(folder / "robot.urdf"), read_file(kr270));
}

TEST_F(Init, MakesAProblemOfSamplesThatCalibratesPlansAndGoesOn) {
  const std::string samples = POSEWRIGHT_SOURCE_DIR "/examples/hand_eye/hand_eye.samples";
  const ProgramRun run = init({"--samples", samples});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("note: sample 5 is wrong: 39"));
  const auto result = [&](std::vector<std::string> words) {
    const ProgramRun done = program(words);
    EXPECT_EQ(done.exit_code, 0) << words.front() << ": " << done.err;
    return done.out;
  };
  const std::string short_way = result({"calibrate", "--samples", samples, "--json"});
  EXPECT_EQ(result({"calibrate", "problem.yaml", samples, "--weights", "robust", "--json"}).substr(0, 40),
            short_way.substr(0, 40));
  const auto proposed = parse_json(short_way)["next"];
  ASSERT_EQ(proposed.size(), 3U);
  EXPECT_EQ(proposed[0]["names"],
            (nlohmann::json{"robot.x", "robot.y", "robot.z", "robot.roll", "robot.pitch", "robot.yaw"}));
  EXPECT_EQ(
      proposed,
      parse_json(result({"next", "problem.yaml", "--data", samples, "--state", "-", "-k", "3", "--json"}))["poses"]);
  // make_samples.py says where the camera is.
  const auto frames = parse_json(short_way)["frames"];
  EXPECT_EQ(frames[1]["name"], "tool");
  const std::array<double, 3> camera{0.062, -0.018, 0.085}, board{0.61, 0.08, 0.004};
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(frames[1]["position"][k], camera[k], 2e-3);
    EXPECT_NEAR(frames[2]["position"][k], board[k], 2e-3);
  }
  EXPECT_EQ(frames[2]["name"], "target");
  EXPECT_EQ(frames[2]["in"], "base");
  EXPECT_THAT(result({"plan", "problem.yaml", "--poses", "6"}), HasSubstr("6 parameters and 6 nuisance parameters"));
  result({"evaluate", "problem.yaml", "poses.csv"});
  EXPECT_THAT(result({"next", "problem.yaml", "--data", samples, "--state", "-"}), HasSubstr("robot.roll [deg]"));
  const ProgramRun refused = program({"export", "plan.json", "--to", "moveit"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err, HasSubstr("moveit is for robots with joints"));
}

TEST_F(Init, WhatIsMissingOrWrongIsOneLine) {
  folder.write("two.urdf",
               "<robot name='t'><link name='b'/><link name='l'/><link name='r'/>"
               "<joint name='jl' type='continuous'><parent link='b'/><child link='l'/></joint>"
               "<joint name='jr' type='continuous'><parent link='b'/><child link='r'/></joint></robot>");
  folder.write("a.urdf.xacro", "<robot name='a' xmlns:xacro='x'><xacro:arg name='prefix'/></robot>");
  const std::map<std::vector<std::string>, std::string> wrong = {
      {{kr270}, "no instrument is named; --tracker or --camera NAME"},
      {{kr270, "--camera", "realsense-d453"}, "camera 'realsense-d453' is not known; known: realsense-d405"},
      {{kr270, "--camera", "femtobolt"}, "(did you mean 'femto-bolt'?)"},
      {{kr270, "--camera", "zed", "--board", "6x9"}, "ROWSxCOLUMNSxSPACING"},
      {{kr270, "--camera", "zed", "--board", "6x9x25"}, "board '6x9x25' has a spacing without unit"},
      {{kr270, "--tracker", "--camera", "zed"}, "one instrument is allowed"},
      {{kr270, "--tracker", "--tip", "flnge"}, "has no link 'flnge' (did you mean 'flange'?), --tip"},
      {{kr270, "--tracker", "--at", "1,2"}, "three lengths X,Y,Z"},
      {{kr270, "--tracker", "--accuracy", "0.1"},
       "--accuracy 0.1; a value above 0 with its unit is expected: m, mm, um, nm"},
      {{"two.urdf", "--tracker"}, "has several arms or ends; name one with --tip: l, r"},
      {{"a.urdf.xacro", "--tracker"}, "needs arguments that have no default: prefix"},
      {{"none.urdf", "--tracker"}, "none.urdf"},
      {{kr270, "--samples", "samples.yaml"}, "ROBOT and --samples; one of them"},
      {{"--samples", "samples.yaml"}, "samples.yaml"},
  };
  for (const auto& [words, message] : wrong) {
    const ProgramRun run = init(words);
    EXPECT_EQ(run.exit_code, 2) << message;
    EXPECT_THAT(run.err, HasSubstr(message));
    EXPECT_EQ(messages_in(run.err), 1) << run.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "problem.yaml"));
  }
}

TEST_F(Init, AsksOnATerminalAndTakesWhatIsTyped) {
  const auto [status, shown] = at_a_terminal(folder, {kr270}, {"zde", "zed", "", "", "in front", "0.5 mm", "12"});
  EXPECT_EQ(status, 0) << shown;
  EXPECT_THAT(shown, HasSubstr("(did you mean 'zed'?)")) << "a wrong answer is asked for again";
  EXPECT_THAT(shown, HasSubstr("Board: rows x columns x spacing of its points [6x9x25mm]: "));
  const Problem problem = read_problem(folder / "problem.yaml");
  EXPECT_DOUBLE_EQ(std::get<CameraMeasurement>(problem.measurement.instrument).fx, 1400);
  EXPECT_THAT(problem_text(), HasSubstr("poses: 12"));
}

TEST_F(Init, AsksNothingThatOptionsSayAndNothingAfterYes) {
  const auto [status, shown] = at_a_terminal(folder, {kr270, "--tracker", "--at", "4,-1,0.5", "--poses", "12"}, {});
  EXPECT_EQ(status, 0) << shown;
  EXPECT_THAT(shown, Not(HasSubstr("]: ")));
  const auto [refused, why] = at_a_terminal(folder, {kr270, "--yes", "-o", "b.yaml"}, {});
  EXPECT_EQ(refused, 2);
  EXPECT_THAT(why, HasSubstr("no instrument is named"));
}

TEST_F(Init, AFileWhoseMeshesAreMissingPlansWithoutACellAndSaysSo) {
  std::string text = read_file(kr270);
  const std::string sphere = "<sphere radius=\"0.13\"/>";
  text.replace(text.find(sphere), sphere.size(), "<mesh filename=\"package://nowhere/wrist.stl\"/>");
  folder.write("arm.urdf", text);
  const ProgramRun run = init({"arm.urdf", "--tracker"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("no collision is checked"));
  EXPECT_THAT(run.err, HasSubstr("package 'nowhere' is not found"));
  EXPECT_THAT(problem_text(), HasSubstr("# No collision is checked: "));
  EXPECT_FALSE(read_problem(folder / "problem.yaml").workspace.collision);
}

TEST_F(Init, HandEyeInThreeCommands) {
  ASSERT_EQ(init({kr270, "--camera", "realsense-d435", "--board", "6x9x25mm"}).exit_code, 0);
  const ProgramRun plan = program({"plan", "problem.yaml", "--quiet"});
  ASSERT_EQ(plan.exit_code, 0) << plan.err;
  const std::map<std::string, std::string> lists = {{"moveit", "calposes.yaml"},
                                                    {"easy-handeye2", "posewright.samples"},
                                                    {"industrial-calibration", "measurements.yaml"},
                                                    {"industrial-calibration-hand-eye", "poses/15.yaml"}};
  for (const auto& [format, file] : lists) {
    const ProgramRun run = program({"export", "plan.json", "--to", format});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_TRUE(std::filesystem::exists(folder / file)) << file;
  }
}

/// What the makers say of whole angles of view, horizontally and vertically, in degrees; the table has focal lengths.
TEST(KnownCameras, SeeTheAnglesThatTheirMakersState) {
  const std::map<std::string, std::pair<double, double>> stated = {
      {"realsense-d405", {87, 58}},
      {"realsense-d415", {69.4, 42.5}},
      {"realsense-d435", {69.4, 42.5}},
      {"realsense-d455", {90, 65}},
      {"azure-kinect", {90, 59}},
      {"femto-bolt", {80, 51}},
      {"zed", {69, 42}},
      {"oak-d-s2", {66, 54}},
      // Of the lens alone: sensor width and height over 8 mm.
      {"imx392-8mm",
       {2 * std::atan(1920 * 3.45e-3 / 16) * 180 / std::numbers::pi,
        2 * std::atan(1200 * 3.45e-3 / 16) * 180 / std::numbers::pi}},
      {"imx250-8mm",
       {2 * std::atan(2448 * 3.45e-3 / 16) * 180 / std::numbers::pi,
        2 * std::atan(2048 * 3.45e-3 / 16) * 180 / std::numbers::pi}},
      {"logitech-c920", {70.4, 43.3}},  // of 78 deg along the diagonal
  };
  ASSERT_EQ(known_cameras().size(), stated.size());
  for (const KnownCamera& camera : known_cameras()) {
    const auto& [horizontal, vertical] = stated.at(camera.name);
    EXPECT_NEAR(camera.horizontal_view() * 180 / std::numbers::pi, horizontal, 1) << camera.name;
    EXPECT_NEAR(camera.vertical_view() * 180 / std::numbers::pi, vertical, 3.5) << camera.name;
    EXPECT_FALSE(camera.source.empty());
    EXPECT_EQ(find_camera(camera.name).focal, camera.focal);
  }
}

}  // namespace
}  // namespace posewright
