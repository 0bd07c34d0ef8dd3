// Files of poses written again with other joints: programs by the tests' own readers, the rest of every file byte for
// byte.

#include "posewright/lists/pose_document.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "posewright/lists/read_poses.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/json.hpp"
#include "tests/formats/program_readers.hpp"
#include "tests/formats/sequences.hpp"
#include "tests/kit/message_of.hpp"

namespace posewright {
namespace {

std::unique_ptr<PoseDocument> parse_document(std::string bytes, const std::string& name,
                                             const std::vector<Coordinate>& coordinates,
                                             const DocumentOptions& options) {
  return std::move(parse_documents({{std::move(bytes), name}}, coordinates, options).front());
}

using readers::Program;
using testing::HasSubstr;

std::vector<Coordinate> six_joints() {
  std::vector<Coordinate> coordinates;
  for (int j = 1; j <= 6; ++j) {
    Coordinate c;
    c.name = "joint_a" + std::to_string(j);
    c.unit = "rad";
    c.lower = -4;
    c.upper = 4;
    c.speed = 2;
    coordinates.push_back(c);
  }
  return coordinates;
}

/// Every joint a little further, each by an amount of its own.
std::vector<double> moved(const PoseList& poses) {
  std::vector<double> all;
  for (const std::vector<double>& q : poses.configurations)
    for (std::size_t i = 0; i < q.size(); ++i) all.push_back(q[i] + 0.001 * double(i + 1));
  return all;
}

std::string rewritten(const PoseDocument& document, const std::vector<double>& values) {
  return document.text({values, {}, {}}, std::string(compensated_mark) + ": joints");
}

struct Case {
  std::string format;
  std::size_t file;  ///< of those exported, that has the points
  ExportOptions options;
  std::function<Program(const Exported&)> read;
  std::vector<double> unit;  ///< of the program's numbers in rad, one or one a joint
  double coupling = 0;
  double limit = 1e-6;
};

std::map<std::string, std::string> by_name(const Exported& exported) {
  std::map<std::string, std::string> files;
  for (const ExportedFile& file : exported.files) files[file.name.substr(file.name.find('/') + 1)] = file.bytes;
  return files;
}

std::vector<Case> cases() {
  const std::vector<double> degrees(6, std::numbers::pi / 180);
  std::vector<Case> all;
  all.push_back(
      {"kuka-krl",
       1,
       {},
       [](const Exported& e) { return readers::read_krl(e.files.at(0).bytes, e.files.at(1).bytes, "CALPOSES"); },
       degrees});
  ExportOptions abb, fanuc, yaskawa;
  abb.coupling = -1;
  fanuc.coupling = 1;
  yaskawa.controller = parse_controller_settings(
      "sign: [1, -1, 1, -1, 1, 1]\nzero_deg: [0, 0, 0, 0, 0, 0]\n"
      "pulses_per_degree: [1435.1, 1435.1, 1300.5, 1024, 1024, 568.9]\ncoupling: 0\n",
      "robot.yaml");
  all.push_back(
      {"abb-rapid", 0, abb, [](const Exported& e) { return readers::read_rapid(e.files.at(0).bytes); }, degrees, -1});
  all.push_back(
      {"fanuc-tp", 0, fanuc, [](const Exported& e) { return readers::read_tp(e.files.at(0).bytes); }, degrees, 1});
  all.push_back({"urscript",
                 0,
                 {},
                 [](const Exported& e) { return readers::read_urscript(e.files.at(0).bytes); },
                 std::vector<double>(6, 1.0)});
  std::vector<double> pulses;
  const double sign[] = {1, -1, 1, -1, 1, 1}, per_degree[] = {1435.1, 1435.1, 1300.5, 1024, 1024, 568.9};
  for (int i = 0; i < 6; ++i) pulses.push_back(sign[i] * std::numbers::pi / 180 / per_degree[i]);
  all.push_back({"yaskawa-inform", 0, yaskawa,
                 [](const Exported& e) { return readers::read_inform(e.files.at(0).bytes); }, pulses, 0, 3.5e-5});
  all.push_back(
      {"staubli-val3", 0, {}, [](const Exported& e) { return readers::read_val3(by_name(e), "CALPOSES"); }, degrees});
  return all;
}

/// Joint values of a move, by what the format's description says of its numbers.
std::vector<double> joints_of(const Case& c, const std::vector<double>& numbers) {
  std::vector<double> q;
  for (std::size_t i = 0; i < 6; ++i) q.push_back(numbers[i] * c.unit[i]);
  q[2] += c.coupling * q[1];
  return q;
}

TEST(PoseDocument, OfEveryProgramIsReadBackWithTheOtherJointsAndTheSameWayThroughThem) {
  for (const Case& c : cases())
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      Exported exported = find_pose_format(c.format).write(random_route(6, 5, seed), c.options);
      std::size_t place = c.file;
      for (std::size_t i = 0; i < exported.files.size(); ++i)
        if (exported.files[i].name.ends_with(".dtx")) place = i;
      const Program before = c.read(exported);
      DocumentOptions options;
      options.format = c.format;
      options.controller = c.options.controller;
      options.coupling = c.options.coupling;
      std::vector<DocumentFile> files;
      for (std::size_t i = 0; i < exported.files.size(); ++i)
        files.push_back({exported.files[i].bytes, exported.files[i].name, i != place});
      const auto document = std::move(parse_documents(files, six_joints(), options).front());
      exported.files[place].bytes = rewritten(*document, moved(document->poses()));
      const Program after = c.read(exported);
      ASSERT_EQ(after.moves.size(), before.moves.size()) << c.format;
      EXPECT_EQ(after.measured, before.measured);
      EXPECT_EQ(after.stops, before.stops);
      int stayed = 0;
      for (std::size_t k = 0; k < before.moves.size(); ++k) {
        const std::vector<double> a = joints_of(c, before.moves[k]), b = joints_of(c, after.moves[k]);
        // Home, where formats name it, stays where it is.
        const bool home = std::abs(b[5] - a[5]) < 0.003;
        stayed += home ? 1 : 0;
        for (std::size_t i = 0; i < 6; ++i)
          EXPECT_NEAR(b[i] - a[i], home ? 0.0 : 0.001 * double(i + 1), 2 * c.limit) << c.format << " move " << k;
      }
      EXPECT_EQ(stayed, c.format == "kuka-krl" || c.format == "abb-rapid" ? 2 : 0) << c.format;
    }
}

TEST(PoseDocument, OfAProgramThatPeopleWroteKeepsEverythingElse) {
  const std::string krl =
      "&ACCESS RV\r\nDEFDAT  WELD\r\n;FOLD EXTERNAL {A1 1,A2 1,A3 1,A4 1,A5 1,A6 1}\r\n"
      "DECL E6AXIS XSTART={A1 10,A2 -90.5,A3 +91.25,A4 0.0,A5 1.5E1,A6 0,E1 100.0,E2 0.0,E3 0.0,E4 0.0,E5 0.0,E6 "
      "0.0}\r\n"
      "DECL FDAT FSTART={TOOL_NO 2,BASE_NO 3,IPO_FRAME #BASE,POINT2[] \" \"}\r\n"
      "DECL E6POS XSEAM={X 1200.5,Y 10.0,Z 300.0,A 0.0,B 90.0,C 0.0,S 2,T 35}\r\nENDDAT\r\n";
  DocumentOptions options;
  options.format = "kuka-krl";
  const auto document = parse_document(krl, "weld.dat", six_joints(), options);
  ASSERT_EQ(document->poses().configurations.size(), 1U);
  EXPECT_EQ(document->poses().lines.front(), 4);
  EXPECT_NEAR(document->poses().configurations[0][2], 91.25 * std::numbers::pi / 180, 1e-15);
  EXPECT_EQ(document->account()->entries[1].what, "XSEAM");
  EXPECT_EQ(document->account()->entries[1].treatment, Treatment::not_compensated);
  std::vector<double> same = document->poses().configurations[0];
  std::string text = rewritten(*document, same);
  const std::string remark = ";Written by posewright compensate: joints\r\n";
  ASSERT_NE(text.find(remark), std::string::npos);
  text.erase(text.find(remark), remark.size());
  EXPECT_EQ(text, krl) << "not one byte where nothing changes";
  same[1] += std::numbers::pi / 180;
  text = rewritten(*document, same);
  text.erase(text.find(remark), remark.size());
  std::string expected = krl;
  expected.replace(expected.find("A1 10,A2 -90.5,A3 +91.25,A4 0.0,A5 1.5E1,A6 0,"), 46,
                   "A1 10.00000,A2 -89.50000,A3 91.25000,A4 0.00000,A5 15.00000,A6 0.00000,");
  EXPECT_EQ(text, expected);
}

TEST(PoseDocument, OfAUrscriptTakesJointsForJointsOnly) {
  const std::string script =
      "def p():\n  set_payload(2.0, [0,0,0.05], [0.1, 0.1, 0.1, 0, 0, 0])\n  q = [0.1, -1.2, 1.3, 0, 0.5, 0]\n"
      "  movej(q, a=1, v=1)\n  # movej([9,9,9,9,9,9])\n  movel(p[0.4, 0.1, 0.3, 0, 3.1, 0])\n"
      "  movej([0.2, -1.0, 1.0, 0, 0.5, 0], a=1)\nend\n";
  const auto document = parse_document(script, "p.script", six_joints(), {});
  ASSERT_EQ(document->poses().configurations.size(), 2U);
  EXPECT_EQ(document->poses().lines, (std::vector<int>{3, 7}));
  EXPECT_EQ(document->account()->count(Treatment::not_compensated), 1U);
}

TEST(PoseDocument, RefusesProgramsWithoutJointsAxesOrSettingsWithFileAndLine) {
  const auto message = [](const std::string& text, const std::string& name,
                          DocumentOptions options = {}) -> std::string {
    return message_of<InputError>([&] { parse_document(text, name, six_joints(), options); });
  };
  EXPECT_THAT(message("DEFDAT X\nENDDAT\n", "x.dat"), HasSubstr("x.dat: has neither points nor motions"));
  EXPECT_THAT(message("MODULE M\nENDMODULE\n", "m.mod"), HasSubstr("abb-rapid needs --coupling F"));
  EXPECT_THAT(message("DEFDAT X\nDECL E6AXIS XP={A1 1,A2 2,A3 300,A4 4,A5 5,A6 6}\nENDDAT\n", "x.dat"),
              HasSubstr("x.dat:2: 'joint_a3' is 5.2"));
  EXPECT_THAT(
      message(
          "DEFDAT X\n;Written by posewright compensate: x\nDECL E6AXIS XP={A1 1,A2 2,A3 3,A4 4,A5 5,A6 6}\nENDDAT\n",
          "x.dat"),
      HasSubstr("is compensated already"));
  DocumentOptions ranges;
  ranges.format = "kuka-krl";
  ranges.controller =
      parse_controller_settings("range_deg: [[-5, 5], [-5, 5], [-5, 5], [-5, 5], [-5, 5], [-5, 5]]\n", "k.yaml");
  const auto document = parse_document("DEFDAT X\n\nDECL E6AXIS XP={A1 1,A2 2,A3 3,A4 4,A5 4.9,A6 4}\nENDDAT\n",
                                       "x.dat", six_joints(), ranges);
  EXPECT_THAT(message_of<CannotDo>([&] { rewritten(*document, moved(document->poses())); }),
              HasSubstr("x.dat:3: axis A5 of the controller would be at 5.186; k.yaml allows -5 to 5"));
}

TEST(PoseDocument, OfAListKeepsCommentsColumnsUnitsAndLineEnds) {
  const std::string csv =
      "\xef\xbb\xbf# by hand\r\nname, joint_a2 [deg],joint_a1,joint_a3 [mrad],joint_a4,joint_a5,joint_a6,remark\r\n"
      "one, 90 ,0.1,100,0,\"0\",0,\"a, b\"\r\n\r\n# between\r\ntwo,-45,0,0,0,0,0.5,\r\n";
  const auto document = parse_document(csv, "list.csv", six_joints(), {});
  std::vector<double> values;
  for (const auto& q : document->poses().configurations) values.insert(values.end(), q.begin(), q.end());
  values[0] = 0.25;
  values[2] = 0.2;
  values[6 + 1] = -std::numbers::pi / 2;
  const std::string text = rewritten(*document, values);
  EXPECT_EQ(text,
            "\xef\xbb\xbf# Written by posewright compensate: joints\r\n# by hand\r\n"
            "name, joint_a2 [deg],joint_a1,joint_a3 [mrad],joint_a4,joint_a5,joint_a6,remark\r\n"
            "one, 90 ,0.25,200,0,\"0\",0,\"a, b\"\r\n\r\n# between\r\ntwo,-90,0,0,0,0,0.5,\r\n");
  EXPECT_THROW(parse_document(text, "list.csv", six_joints(), {}), InputError) << "once is enough";
}

TEST(PoseDocument, OfARouteMovesPosesViaPointsAndEndsOfMotionsButNotHome) {
  const PoseSequence route = random_route(6, 4, 3);
  nlohmann::ordered_json json = {{"schema", "posewright/route/1"},
                                 {"names", route.names},
                                 {"units", route.units},
                                 {"home", route.home},
                                 {"from_home", true},
                                 {"closed", true},
                                 {"seconds", {{"settle", 1.0}}},
                                 {"other", "kept"}};
  for (const SequencePose& pose : route.poses)
    json["poses"].push_back({{"id", pose.id}, {"configuration", pose.values}});
  for (const SequenceMotion& motion : route.motions)
    json["motions"].push_back(
        {{"from", motion.from}, {"to", motion.to}, {"seconds", motion.seconds}, {"points", motion.points}});
  const auto document = parse_document(json.dump(), "route.json", six_joints(), {});
  const std::string text = rewritten(*document, moved(document->poses()));
  const PoseSequence again = parse_sequence(text, "route.json");  // motions still lead from pose to pose
  EXPECT_EQ(again.home, route.home);
  EXPECT_EQ(parse_json(text)["other"], "kept");
  const auto shifted = [](std::vector<double> q) {
    for (std::size_t i = 0; i < q.size(); ++i) q[i] += 0.001 * double(i + 1);
    return q;
  };
  for (std::size_t k = 0; k < route.poses.size(); ++k) EXPECT_EQ(again.poses[k].values, shifted(route.poses[k].values));
  for (std::size_t m = 0; m < route.motions.size(); ++m) {
    const auto &old = route.motions[m].points, &now = again.motions[m].points;
    ASSERT_EQ(old.size(), now.size());
    // As much longer as the way, at 2 rad/s.
    double more = 0;
    for (std::size_t i = 1; i < old.size(); ++i) {
      double was = 0, is = 0;
      for (std::size_t k = 0; k < 6; ++k) {
        was = std::max(was, std::abs(old[i][k] - old[i - 1][k]));
        is = std::max(is, std::abs(now[i][k] - now[i - 1][k]));
      }
      more += (is - was) / 2;
    }
    EXPECT_NEAR(again.motions[m].seconds - route.motions[m].seconds, std::max(0.0, more), 1e-12);
    for (std::size_t i = 0; i < old.size(); ++i) EXPECT_EQ(now[i], old[i] == route.home ? route.home : shifted(old[i]));
  }
  EXPECT_THROW(parse_document(text, "route.json", six_joints(), {}), InputError);
}

TEST(PoseDocument, OfOtherListsIsReadBackByTheirFormat) {
  const PoseSequence sequence = random_sequence(6, 5, 2);
  for (const char* name : {"moveit", "srdf", "robot-calibration", "figaroh", "industrial-calibration", "pybotics-npy",
                           "robodk-csv", "joint-trajectory"}) {
    const std::string bytes = find_pose_format(name).write(sequence, {}).files.front().bytes;
    DocumentOptions options;
    options.format = name;
    const auto document = parse_document(bytes, "list", six_joints(), options);
    const std::vector<double> values = moved(document->poses());
    const PoseList again = read_poses_text(document->text({values, {}, {}}, "remark"), "list", six_joints(), name);
    const PoseList before = read_poses_text(bytes, "list", six_joints(), name);
    ASSERT_EQ(again.configurations.size(), before.configurations.size()) << name;
    for (std::size_t k = 0; k < before.configurations.size(); ++k)
      for (std::size_t i = 0; i < 6; ++i)
        EXPECT_NEAR(again.configurations[k][i], before.configurations[k][i] + 0.001 * double(i + 1), 1e-6) << name;
  }
}

}  // namespace
}  // namespace posewright
