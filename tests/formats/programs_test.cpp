// Robot programs read back by readers of their own (program_readers.cpp) and compared with the plan.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <numbers>

#include "posewright/support/error.hpp"
#include "posewright/support/file.hpp"
#include "program_readers.hpp"
#include "sequences.hpp"
#include "tests/kit/message_of.hpp"

namespace posewright {
namespace {

using readers::Program;
using testing::HasSubstr;

constexpr double tolerance = 1e-6;  // rad

ControllerSettings yaskawa_settings() {
  return parse_controller_settings(
      "sign: [1, -1, 1, -1, 1, 1]\nzero_deg: [0, 90, -90, 0, 0, 10]\n"
      "pulses_per_degree: [1435.1, 1435.1, 1300.5, 1024, 1024, 568.9]\ncoupling: 0.5\n",
      "robot.yaml");
}

/// What a controller of that program takes for the joint values q: written from the formats' descriptions.
using Convention = std::function<std::vector<double>(const std::vector<double>&)>;

struct Case {
  std::string format;
  ExportOptions options;
  Convention radians;  ///< of a plan's joint values, as the program counts them
  std::function<Program(const Exported&)> read;
  Convention back = [](const std::vector<double>& q) {  ///< of the program's numbers, rad
    std::vector<double> result;
    for (const double x : q) result.push_back(x * std::numbers::pi / 180);
    return result;
  };
  double limit = tolerance;
};

std::vector<double> same(const std::vector<double>& q) { return q; }
std::vector<double> coupled(const std::vector<double>& q, double factor) {
  std::vector<double> result = q;
  result[2] = q[2] - factor * q[1];
  return result;
}

std::map<std::string, std::string> by_name(const Exported& exported) {
  std::map<std::string, std::string> files;
  for (const ExportedFile& file : exported.files) files[file.name.substr(file.name.find('/') + 1)] = file.bytes;
  return files;
}

std::vector<Case> cases() {
  std::vector<Case> all;
  all.push_back({"kuka-krl", {}, same, [](const Exported& e) {
                   return readers::read_krl(e.files.at(0).bytes, e.files.at(1).bytes, "CALPOSES");
                 }});
  ExportOptions abb;
  abb.coupling = -1;
  all.push_back({"abb-rapid", abb, [](const auto& q) { return coupled(q, -1); },
                 [](const Exported& e) { return readers::read_rapid(e.files.at(0).bytes); }});
  ExportOptions fanuc;
  fanuc.coupling = 1;
  all.push_back({"fanuc-tp", fanuc, [](const auto& q) { return coupled(q, 1); },
                 [](const Exported& e) { return readers::read_tp(e.files.at(0).bytes); }});
  all.push_back(
      {"urscript", {}, same, [](const Exported& e) { return readers::read_urscript(e.files.at(0).bytes); }, same});
  ExportOptions yaskawa;
  yaskawa.controller = yaskawa_settings();
  // In pulses: half a pulse is the most that a whole number can miss.
  all.push_back({"yaskawa-inform", yaskawa,
                 [](const auto& q) {
                   const double sign[] = {1, -1, 1, -1, 1, 1}, zero[] = {0, 90, -90, 0, 0, 10},
                                pulses[] = {1435.1, 1435.1, 1300.5, 1024, 1024, 568.9};
                   std::vector<double> result = coupled(q, 0.5);
                   for (int i = 0; i < 6; ++i)
                     result[i] = (sign[i] * result[i] * 180 / std::numbers::pi + zero[i]) * pulses[i];
                   return result;
                 },
                 [](const Exported& e) { return readers::read_inform(e.files.at(0).bytes); }, same, 0.5 + 1e-9});
  all.push_back(
      {"staubli-val3", {}, same, [](const Exported& e) { return readers::read_val3(by_name(e), "CALPOSES"); }});
  return all;
}

void expect_same_path(const Case& c, const PoseSequence& sequence) {
  const Program program = c.read(find_pose_format(c.format).write(sequence, c.options));
  const Path path = path_of(sequence);
  ASSERT_EQ(program.moves.size(), path.points.size()) << c.format;
  EXPECT_EQ(program.measured, path.measured) << c.format;
  for (std::size_t k = 0; k < path.points.size(); ++k) {
    const auto wanted = c.radians(path.points[k]), found = c.back(program.moves[k]);
    ASSERT_EQ(found.size(), wanted.size());
    for (std::size_t i = 0; i < wanted.size(); ++i)
      EXPECT_NEAR(found[i], wanted[i], c.limit) << c.format << " " << k << " " << i;
  }
}

TEST(RobotPrograms, ReadBackToTheJointValuesOfThePlan) {
  for (const Case& c : cases())
    for (const int poses : {1, 2, 9})
      for (std::uint64_t seed = 1; seed <= 5; ++seed) expect_same_path(c, random_sequence(6, poses, seed));
}

TEST(RobotPrograms, GoThroughViaPointsAndMeasureAtPosesOnly) {
  for (const Case& c : cases())
    for (const int poses : {1, 2, 9})
      for (std::uint64_t seed = 1; seed <= 5; ++seed) expect_same_path(c, random_route(6, poses, seed));
}

TEST(RobotPrograms, WaitForSecondsInsteadOfAnInputWhereAsked) {
  for (Case c : cases()) {
    c.options.wait = 4.5;
    expect_same_path(c, random_route(6, 4, 3));
  }
}

TEST(RobotPrograms, StopAndTellWhatChangesBetweenPoses) {
  PoseSequence sequence = random_sequence(6, 4, 2);
  const char* stations[] = {"Süd \"1\"; x", "Süd \"1\"; x", "B", "B"};
  const char* loads[] = {"none", "none", "none", "20 kg [steel]"};
  for (std::size_t k = 0; k < 4; ++k) sequence.poses[k].choices = {{"load_case", loads[k]}, {"station", stations[k]}};
  for (const Case& c : cases()) {
    const Program program = c.read(find_pose_format(c.format).write(sequence, c.options));
    EXPECT_EQ(program.stops, (std::vector<std::size_t>{0, 2, 3})) << c.format;
    std::string told;
    for (const std::string& text : c.format == "kuka-krl" ? program.comments : program.messages) told += text + "|";
    EXPECT_THAT(told, HasSubstr("station: Sued '1', x")) << c.format;
    EXPECT_THAT(told, HasSubstr("station: B")) << c.format;
    EXPECT_THAT(told, HasSubstr("load case: 20 kg ")) << c.format;
  }
  for (SequencePose& pose : sequence.poses) pose.choices = {{"load_case", "only"}, {"station", "only"}};
  for (const Case& c : cases())
    EXPECT_TRUE(c.read(find_pose_format(c.format).write(sequence, c.options)).stops.empty()) << "nothing changes";
}

TEST(RobotPrograms, SayThatAPlansMotionsAreNotCheckedAndARoutesAre) {
  for (const Case& c : cases()) {
    const auto notes = [&](const PoseSequence& s) {
      return testing::PrintToString(find_pose_format(c.format).write(s, c.options).notes);
    };
    EXPECT_THAT(notes(random_sequence(6, 3, 1)), HasSubstr("posewright route"));
    EXPECT_THAT(notes(random_route(6, 3, 1)), testing::Not(HasSubstr("posewright route")));
  }
}

TEST(RobotPrograms, LeaveOutPosesThatAreMeasuredAndNameTheOthersByTheirIds) {
  PoseSequence sequence = random_sequence(6, 4, 2);
  sequence.poses[0].measured = sequence.poses[2].measured = true;
  for (const Case& c : cases()) {
    const Program program = c.read(find_pose_format(c.format).write(sequence, c.options));
    EXPECT_EQ(program.moves.size(), 2U);
    EXPECT_THAT(program.comments, testing::Contains("pose 2")) << c.format;
    EXPECT_THAT(program.comments, testing::Contains("pose 4")) << c.format;
    EXPECT_THAT(program.comments, testing::Not(testing::Contains("pose 3"))) << c.format;
  }
}

TEST(RobotPrograms, ARouteWithAPoseMarkedAsMeasuredIsRefused) {
  // Its motions lead through that pose; a program without it would take a way that nobody checked.
  std::string text = read_file(std::string(POSEWRIGHT_SOURCE_DIR) + "/tests/formats/golden/route.json");
  EXPECT_NO_THROW(parse_sequence(text, "route.json"));
  text.replace(text.find("\"id\": 1,"), 8, "\"id\": 1, \"measured\": true,");
  EXPECT_THAT(message_of<InputError>([&] { parse_sequence(text, "route.json"); }),
              HasSubstr("pose 1 of a route is marked as measured"));
}

TEST(RobotPrograms, ZerosOfSlidingAxesMayBeMetresAway) {
  PoseSequence sequence = random_sequence(7, 3, 4);
  sequence.names.front() = "rail";
  sequence.units.front() = "m";
  ExportOptions options;
  options.controller =
      parse_controller_settings("axes: [E1, A1, A2, A3, A4, A5, A6]\nzero_deg: [1500, 0, 0, 0, 0, 0, 0]", "r.yaml");
  EXPECT_NO_THROW(find_pose_format("kuka-krl").write(sequence, options));
  options.controller =
      parse_controller_settings("axes: [E1, A1, A2, A3, A4, A5, A6]\nzero_deg: [0, 1500, 0, 0, 0, 0, 0]", "r.yaml");
  EXPECT_THROW(find_pose_format("kuka-krl").write(sequence, options), InputError);
}

TEST(PoseLists, OfJointsRefusePlatformsAndPairsOfConfigurations) {
  PoseSequence platforms = random_sequence(6, 2, 1), pairs = random_sequence(12, 2, 1);
  platforms.is_platform = true;
  for (std::size_t i = 6; i < 12; ++i) pairs.names[i] = pairs.names[i - 6] + ".second";
  int open = 0;
  for (const PoseFormat& format : pose_formats()) {
    if (format.any_coordinates) {
      ++open;
      continue;
    }
    ExportOptions options;
    options.coupling = 0;
    EXPECT_THROW(export_poses(format, platforms, options), CannotDo) << format.name;
    EXPECT_THROW(export_poses(format, pairs, options), CannotDo) << format.name;
  }
  EXPECT_EQ(open, 6) << "csv, json, hexapod-gcs, lists of targets";
}

TEST(RobotPrograms, ExternalAxesStandWhereTheControllerHasThem) {
  PoseSequence sequence = random_sequence(7, 3, 4);
  sequence.names.front() = "rail";
  sequence.units.front() = "m";
  ExportOptions options;
  options.coupling = 0;
  EXPECT_THROW(find_pose_format("kuka-krl").write(sequence, options), CannotDo);
  options.controller = parse_controller_settings("axes: [E1, A1, A2, A3, A4, A5, A6]", "r.yaml");
  const Exported krl = find_pose_format("kuka-krl").write(sequence, options);
  const Program kuka = readers::read_krl(krl.files[0].bytes, krl.files[1].bytes, "CALPOSES");
  options.controller = parse_controller_settings("axes: [eax_a, rax_1, rax_2, rax_3, rax_4, rax_5, rax_6]", "r.yaml");
  const Program abb = readers::read_rapid(find_pose_format("abb-rapid").write(sequence, options).files[0].bytes);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto& q = sequence.poses[k].values;
    for (const Program* program : {&kuka, &abb}) {
      ASSERT_EQ(program->moves[k].size(), 7U);
      EXPECT_NEAR(program->moves[k][6], q[0] * 1000, 1e-4);
      for (std::size_t i = 0; i < 6; ++i)
        EXPECT_NEAR(program->moves[k][i] * std::numbers::pi / 180, q[i + 1], tolerance);
    }
  }
}

TEST(RobotPrograms, OfFanucHoldRailAndPositionerWithTheirUnits) {
  PoseSequence sequence = random_sequence(9, 3, 4);
  sequence.units.front() = "m";
  ExportOptions options;
  options.coupling = 0;
  EXPECT_THROW(find_pose_format("fanuc-tp").write(sequence, options), CannotDo);
  options.controller = parse_controller_settings("axes: [E1, J1, J2, J3, J4, J5, J6, GP2.J1, GP2.J2]", "r.yaml");
  const std::string listing = find_pose_format("fanuc-tp").write(sequence, options).files[0].bytes;
  EXPECT_THAT(listing, HasSubstr("DEFAULT_GROUP\t= 1,1,*,*,*;"));
  EXPECT_THAT(listing, HasSubstr(" mm\r\n   GP2:\r\n\tUF : 0, UT : 1,\r\n\tJ1="));
  const Program program = readers::read_tp(listing);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto& q = sequence.poses[k].values;
    ASSERT_EQ(program.moves[k].size(), 9U);
    EXPECT_NEAR(program.moves[k][6], q[0] * 1000, 1e-4);
    for (std::size_t i = 0; i < 8; ++i)
      EXPECT_NEAR(program.moves[k][i < 6 ? i : i + 1] * std::numbers::pi / 180, q[i + 1], tolerance);
  }
}

TEST(RobotPrograms, MoveWithTheToolThatIsNamed) {
  ExportOptions options;
  options.coupling = 0;
  const PoseFormat& rapid = find_pose_format("abb-rapid");
  const auto tools = [&] {
    return readers::read_rapid(rapid.write(random_sequence(6, 3, 1), options).files[0].bytes).tools;
  };
  const auto notes = [&] { return testing::PrintToString(rapid.write(random_sequence(6, 3, 1), options).notes); };
  EXPECT_THAT(tools(), testing::ElementsAre("tool0"));
  EXPECT_THAT(notes(), HasSubstr("tool0, which has no load"));
  options.tool = "tReflectors";
  EXPECT_THAT(tools(), testing::ElementsAre("tReflectors"));
  EXPECT_THAT(notes(), HasSubstr("tooldata tReflectors must exist"));
}

TEST(RobotPrograms, SayWhatTheRobotCarriesBeforeItMoves) {
  ExportOptions options;
  options.coupling = 1;
  const auto tp = [&] {
    return readers::read_tp(find_pose_format("fanuc-tp").write(random_sequence(6, 3, 1), options).files[0].bytes).load;
  };
  EXPECT_THAT(tp(), testing::IsEmpty());
  options.payload = "3";
  EXPECT_THAT(tp(), testing::ElementsAre(3));
  options.coupling = {};
  const auto urscript = [&](const std::string& payload) {
    options.payload = payload;
    return readers::read_urscript(find_pose_format("urscript").write(random_sequence(6, 3, 1), options).files[0].bytes)
        .load;
  };
  EXPECT_THAT(urscript(""), testing::IsEmpty());
  EXPECT_THAT(urscript("2.5,0.01,-0.02,0.05"), testing::ElementsAre(2.5, 0.01, -0.02, 0.05));
  EXPECT_THAT(urscript("4"), testing::ElementsAre(4, 0, 0, 0));
}

TEST(RobotPrograms, TakeSignsAndZerosFromTheSettings) {
  const PoseSequence sequence = random_sequence(6, 5, 6);
  ExportOptions options;
  options.controller =
      parse_controller_settings("sign: [-1, 1, 1, -1, 1, 1]\nzero_deg: [10, -90, 90, 0, 0, 5]\ndecimals: 7", "r.yaml");
  const Exported krl = find_pose_format("kuka-krl").write(sequence, options);
  const Program program = readers::read_krl(krl.files[0].bytes, krl.files[1].bytes, "CALPOSES");
  const double sign[] = {-1, 1, 1, -1, 1, 1}, zero[] = {10, -90, 90, 0, 0, 5};
  for (std::size_t k = 0; k < 5; ++k)
    for (std::size_t i = 0; i < 6; ++i)
      EXPECT_NEAR(program.moves[k][i], sign[i] * sequence.poses[k].values[i] * 180 / std::numbers::pi + zero[i], 1e-7);
}

struct Refusal {
  std::string format, settings;
  std::function<void(PoseSequence&, ExportOptions&)> change;
  std::string message;
};

TEST(RobotPrograms, RefuseWhatWouldBeWrong) {
  const auto nothing = [](PoseSequence&, ExportOptions&) {};
  const auto slide = [](PoseSequence& s, ExportOptions& o) { s.units[2] = "m", o.coupling = 0; };
  const auto five = [](PoseSequence& s, ExportOptions& o) { s = random_sequence(5, 2, 1), o.coupling = 0; };
  const auto named = [](const char* name) {
    return [name](PoseSequence&, ExportOptions& o) { o.name = name, o.coupling = 0; };
  };
  for (const Refusal& refusal : std::vector<Refusal>{
           {"fanuc-tp", "", nothing, "fanuc-tp needs --coupling F; the controller's J3 is J3 - F*J2"},
           {"abb-rapid", "", nothing, "abb-rapid needs --coupling F; robots with a parallelogram"},
           {"yaskawa-inform", "", nothing, "yaskawa-inform needs --coupling F"},
           {"yaskawa-inform", "coupling: 0", nothing,
            "needs pulses_per_degree in --controller FILE; pulses, directions"},
           {"yaskawa-inform", "coupling: 0\npulses_per_degree: [1, 1, 1, 1, 1, 1]", nothing,
            "needs sign in --controller"},
           {"yaskawa-inform", "coupling: 0\npulses_per_degree: [1, 1, 1, 1, 1, 1]\nsign: [1, 1, 1, 1, 1, 1]", nothing,
            "needs zero_deg in --controller"},
           {"kuka-krl", "pulses_per_degree: [1, 1, 1, 1, 1, 1]", nothing,
            "r.yaml:1: 'pulses_per_degree' is not read for kuka-krl"},
           {"kuka-krl", "sign: [1, 1, 1]", nothing, "r.yaml:1: sign has 3 numbers; the plan has 6 joints"},
           {"kuka-krl", "axes: [A1, A2, A3, A4, A5, A5]", nothing, "r.yaml:1: axes has 'A5'; each once of A1, A2"},
           {"kuka-krl", "axes: [A1, A2, A3, A4, A5, E1]", nothing, "kuka-krl needs axis A6"},
           {"kuka-krl", "axes: [A1, A2]", nothing, "r.yaml:1: axes has 2 names; the plan has 6 joints"},
           {"kuka-krl", "", slide, "kuka-krl: axis A3 turns, joint 'joint_a3' slides; name external axes"},
           {"fanuc-tp", "", slide, "fanuc-tp: axis J3 turns, joint 'joint_a3' slides"},
           {"kuka-krl", "", five, "joint_a5); no program for fewer axes is written, lists of poses are (csv)"},
           {"staubli-val3", "", five, "staubli-val3 has six turning axes, the plan 5 joints (joint_a1, joint_a2"},
           {"urscript", "", [](PoseSequence&s, ExportOptions&) { s.poses[1].values[3] = -6.3; },
            "urscript: P2 turns wrist1 to -6.3000 rad; the controller takes -2 pi to 2 pi"},
           {"kuka-krl", "", named("CALIBRATION_OF_THE_KR_270"), "at most 24 in all"},
           {"abb-rapid", "", named("1st"), "'1st' is not a name of a abb-rapid program"},
           {"fanuc-tp", "", named("CAL-1"), "'CAL-1' is not a name"},
           {"kuka-krl", "", [](PoseSequence&, ExportOptions&o) { o.digital_output = "0"; },
            "--digital-output '0'; a whole number from 1"},
           {"urscript", "", [](PoseSequence&, ExportOptions&o) { o.digital_input = "8"; },
            "--digital-input '8'; a whole number from 0 to 7"},
           {"staubli-val3", "", [](PoseSequence&, ExportOptions&o) { o.digital_input = "2"; }, "the name of a signal"},
           {"kuka-krl", "", [](PoseSequence&, ExportOptions&o) { o.tool = "tCal"; },
            "--tool 'tCal'; a whole number from 0 to 255"},
           {"abb-rapid", "", [](PoseSequence&, ExportOptions&o) { o.tool = "5", o.coupling = 0; },
            "--tool '5'; the name of a tool"},
           {"fanuc-tp", "", [](PoseSequence&, ExportOptions&o) { o.payload = "11", o.coupling = 0; },
            "--payload '11'; a whole number from 1 to 10"},
           {"urscript", "", [](PoseSequence&, ExportOptions&o) { o.payload = "2.5,0.1"; },
            "--payload '2.5,0.1'; KG or KG,X,Y,Z is expected"},
           {"urscript", "", [](PoseSequence&, ExportOptions&o) { o.payload = "2,0,0,50"; }, "--payload '2,0,0,50'"},
           {"urscript", "", [](PoseSequence&, ExportOptions&o) { o.payload = "2 kg"; }, "--payload '2 kg'"},
           {"kuka-krl", "", [](PoseSequence&, ExportOptions&o) { o.wait = 1, o.digital_input = "2"; },
            "--wait and --digital-input cannot be combined"},
           {"kuka-krl", "",
            [](PoseSequence&s, ExportOptions&) {
              for (auto& p : s.poses) p.measured = true;
            },
            "all poses are measured already"},
       }) {
    PoseSequence sequence = random_sequence(6, 3, 1);
    ExportOptions options;
    if (!refusal.settings.empty()) options.controller = parse_controller_settings(refusal.settings, "r.yaml");
    refusal.change(sequence, options);
    try {
      find_pose_format(refusal.format).write(sequence, options);
      ADD_FAILURE() << "accepted: " << refusal.message;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(refusal.message));
    } catch (const CannotDo& error) {
      EXPECT_THAT(error.what(), HasSubstr(refusal.message));
    }
  }
}

TEST(ControllerSettings, BadFilesNameTheLineAndWhatIsAllowed) {
  struct Bad {
    std::string text, message;
  };
  for (const Bad& bad : {
           Bad{"colour: red", "r.yaml:1: unknown key 'colour'; allowed: sign, zero_deg"},
           Bad{"sign: [1, 2]", "r.yaml:1: sign has a number that is not allowed; 1 or -1"},
           Bad{"coupling: 1\ncoupling: 1", "r.yaml:2: has 'coupling' twice"},
           Bad{"coupling: one", "r.yaml:1: coupling: 'one' is not a number"},
           Bad{"decimals: 12", "r.yaml:1: decimals is 12; 3 to 9"},
           Bad{"pivot_mm: [1, 2]", "r.yaml:1: pivot_mm has not three numbers"},
           Bad{"zero_deg: [0, .nan]", "is not a number"},
           Bad{"pulses_per_degree: [0]", "numbers above 0"},
           Bad{"- 1", "is not a mapping"},
           Bad{"a: [", "is not valid YAML"},
       }) {
    EXPECT_THAT(message_of<InputError>([&] { parse_controller_settings(bad.text, "r.yaml"); }), HasSubstr(bad.message));
  }
}

PoseSequence platform(int poses, std::uint64_t seed) {
  PoseSequence sequence = random_sequence(6, poses, seed);
  sequence.names = {"x", "y", "z", "rx", "ry", "rz"};
  sequence.units = {"m", "m", "m", "rad", "rad", "rad"};
  for (SequencePose& pose : sequence.poses)
    for (std::size_t i = 0; i < 6; ++i) pose.values[i] *= i < 3 ? 0.01 : 0.3;
  return sequence;
}

TEST(Hexapod, CommandedAnglesTurnThePlatformAsThePlanDoes) {
  ExportOptions options;
  options.controller = parse_controller_settings("pivot_mm: [0, 0, -12.5]", "r.yaml");
  const PoseSequence sequence = platform(12, 3);
  const std::string text = find_pose_format("hexapod-gcs").write(sequence, options).files[0].bytes;
  EXPECT_THAT(text, HasSubstr("SPI R 0.0000 S 0.0000 T -12.5000\n"));
  const Program program = readers::read_gcs(text);
  ASSERT_EQ(program.moves.size(), 12U);
  ASSERT_EQ(program.measured.size(), 12U);
  using Eigen::AngleAxisd, Eigen::Vector3d;
  for (std::size_t k = 0; k < 12; ++k) {
    const auto& q = sequence.poses[k].values;
    const auto& c = program.moves[k];
    const double r = std::numbers::pi / 180;
    // The plan: Rz Ry Rx. The controller: axes move with the platform, U first, then V, then W.
    const Eigen::Matrix3d planned = (AngleAxisd(q[5], Vector3d::UnitZ()) * AngleAxisd(q[4], Vector3d::UnitY()) *
                                     AngleAxisd(q[3], Vector3d::UnitX()))
                                        .toRotationMatrix();
    Eigen::Matrix3d turned = AngleAxisd(c[3] * r, Vector3d::UnitX()).toRotationMatrix();
    turned = AngleAxisd(c[4] * r, turned.col(1)) * turned;
    turned = AngleAxisd(c[5] * r, turned.col(2)) * turned;
    EXPECT_LT(AngleAxisd(planned.transpose() * turned).angle(), 2e-6);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(c[i] * 1e-3, q[i], 0.5e-7 + 1e-12);
  }
}

TEST(Hexapod, RefusesWhatItCannotPlace) {
  const PoseFormat& format = find_pose_format("hexapod-gcs");
  EXPECT_THROW(format.write(random_sequence(6, 2, 1), {}), CannotDo) << "joints are no platform";
  EXPECT_THROW(format.write(platform(2, 1), {}), InputError) << "turns without a pivot";
  PoseSequence level = platform(3, 1);
  for (SequencePose& pose : level.poses) std::fill(pose.values.begin() + 3, pose.values.end(), 0.0);
  EXPECT_EQ(readers::read_gcs(format.write(level, {}).files[0].bytes).moves.size(), 3U)
      << "does not turn: no pivot needed";
  PoseSequence leaning = level;
  leaning.is_route = leaning.from_home = true;
  leaning.home = {0, 0, 0, 0.1, 0, 0};
  EXPECT_THROW(format.write(leaning, {}), InputError) << "turns at home";
  leaning.home[3] = 0;
  leaning.motions = {{0, 1, {leaning.home, {0, 0, 0, 0, 0.1, 0}, leaning.poses[0].values}, 1.0}};
  EXPECT_THROW(format.write(leaning, {}), InputError) << "turns on the way";
  level.poses.back().choices = {{"station", "B"}};
  EXPECT_THROW(format.write(level, {}), CannotDo) << "cannot wait for people";
}

}  // namespace
}  // namespace posewright
