// Accounts of programs: every motion and point is compensated, left for a reason, or said not to be understood.

#include "posewright/programs/program_document.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "posewright/support/error.hpp"
#include "tests/kit/message_of.hpp"

namespace posewright {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

ProgramRobot six_axes() {
  ProgramRobot robot{{"j1", "j2", "j3", "j4", "j5", "j6"}, std::vector<std::string>(6, "rad"), {}, 0.0, "no inverse"};
  robot.settings.pulses_per_degree = std::vector<double>(6, 1000);
  return robot;
}

std::vector<std::unique_ptr<ProgramDocument>> read(const std::vector<ProgramFile>& files) {
  return read_programs(files, six_axes());
}

/// "line what: treatment", with C, L, N, ? for the treatments.
std::vector<std::string> lines_of(const ProgramDocument& document) {
  std::vector<std::string> lines;
  for (const ProgramEntry& entry : document.account().entries)
    lines.push_back(std::to_string(entry.line) + " " + entry.what + ": " + "CLN?"[int(entry.treatment)]);
  return lines;
}

std::vector<std::string> account(const std::string& format, const std::string& text, const std::string& name = "p") {
  return lines_of(*read({{format, text, name}}).front());
}

std::string why(const ProgramDocument& document, int line) {
  for (const ProgramEntry& entry : document.account().entries)
    if (entry.line == line) return entry.why;
  return "no entry";
}

/// A text with other values for all its points.
std::string moved(const ProgramDocument& document) {
  std::vector<std::optional<ProgramDocument::Values>> values;
  for (const ProgramDocument::Point& point : document.points()) {
    values.emplace_back(ProgramDocument::Values{{point.joints}, point.X_BaseTip});
    for (double& value : values.back()->stand.joints) value += 0.01;
  }
  return document.text(values, "Written by posewright compensate: x");
}

constexpr const char* krl_zero = "{A1 0,A2 10,A3 20,A4 0,A5 30,A6 0}";

TEST(KrlProgram, LeavesRelativeMotionsAndNamesThem) {
  const std::string text = std::string("DEF REL()\nPTP ") + krl_zero +
                           "\nPTP_REL {A1 0,A2 0,A3 5,A4 0,A5 0,A6 0}\nLIN_REL {Z 10}\nptp_rel {A3 -5} C_PTP\nEND\n";
  const auto document = std::move(read({{"kuka-krl", text, "rel.src"}}).front());
  EXPECT_THAT(lines_of(*document), ElementsAre("2 PTP: C", "3 PTP_REL: L", "4 LIN_REL: L", "5 ptp_rel: L"));
  const std::string after = moved(*document);
  EXPECT_THAT(after, HasSubstr("PTP_REL {A1 0,A2 0,A3 5,A4 0,A5 0,A6 0}\nLIN_REL {Z 10}\nptp_rel {A3 -5} C_PTP"));
  EXPECT_THAT(after, HasSubstr("DEF REL()\n;Written by posewright compensate: x\nPTP {A1 0.57296,A2 10.57296"));
}

TEST(KrlProgram, TakesPointsOfItsDataFileByTheirUse) {
  const std::string data = std::string("DEFDAT W\nDECL E6AXIS XP1=") + krl_zero +
                           "\nDECL E6AXIS XHOMEPLATE1=" + krl_zero + "\nDECL E6AXIS XHOME=" + krl_zero +
                           "\nDECL E6AXIS XSTEP=" + krl_zero + "\nDECL E6AXIS XNEVER=" + krl_zero +
                           "\nDECL E6POS XSEAM={X 1,Y 2,Z 3,A 0,B 0,C 0,S 2,T 35}\nENDDAT\n";
  const std::string source =
      "DEF W()\nPTP XHOME\n;PTP XNEVER\nPTP XP1 C_PTP\nPTP XHOMEPLATE1\nPTP_REL XSTEP\nLIN XSEAM C_DIS\n"
      "LIN XSEAM:{Z 50}\nPTP $AXIS_ACT\nPTP XOTHER\nEND\n";
  const auto documents = read({{"kuka-krl", source, "w.src"}, {"kuka-krl", data, "w.dat"}});
  EXPECT_THAT(lines_of(*documents[1]),
              ElementsAre("2 XP1: C", "3 XHOMEPLATE1: C", "4 XHOME: L", "5 XSTEP: L", "6 XNEVER: L", "7 XSEAM: N"));
  EXPECT_THAT(lines_of(*documents[0]),
              ElementsAre("2 PTP XHOME: L", "4 PTP XP1: C", "5 PTP XHOMEPLATE1: C", "6 PTP_REL XSTEP: L",
                          "7 LIN XSEAM: N", "8 LIN: L", "9 PTP: L", "10 PTP XOTHER: ?"));
  EXPECT_THAT(why(*documents[0], 10), HasSubstr("XOTHER has no value in these files: give the .dat file too"));
  EXPECT_THAT(why(*documents[1], 6), HasSubstr("no motion of these files uses it"));
  EXPECT_EQ(documents[0]->text({}, "remark"), source) << "no point of its own: byte for byte";
}

TEST(KrlProgram, DoesNotUnderstandPointsThatTheProgramChangesOrLeavesOpen) {
  const std::string text = std::string("DEF C()\nDECL E6AXIS A\nDECL E6AXIS B\nA=") + krl_zero + "\nB=" + krl_zero +
                           "\nB.A1=B.A1+90\nPTP A\nPTP B\nPTP {A1 30}\nPTP {A1 nA,A2 0,A3 0,A4 0,A5 0,A6 0}\n"
                           "MoveTo(A)\nPTP P[I]\nEND\n";
  const auto document = std::move(read({{"kuka-krl", text, "c.src"}}).front());
  EXPECT_THAT(lines_of(*document),
              ElementsAre("4 A: C", "5 B: ?", "7 PTP A: C", "8 PTP B: ?", "9 PTP: ?", "10 PTP: ?", "12 PTP P: ?"));
  EXPECT_EQ(why(*document, 9), "has no axis A2: it stays where it is");
  EXPECT_EQ(why(*document, 5), "the program changes it (line 6)");
}

TEST(KrlProgram, TakesBothPointsOfACircleAndNoFrames) {
  EXPECT_THAT(account("kuka-krl",
                      "DEF C()\n$BASE={X 1,Y 2,Z 3,A 0,B 0,C 0}\n$TOOL=TOOL_DATA[1]\nBAS (#VEL_PTP,20)\n"
                      "CIRC {X 1,Y 2,Z 3,A 0,B 0,C 0},{X 2,Y 2,Z 3,A 0,B 0,C 0},CA 180 C_DIS\nASYPTP {E1 30}\nEND\n",
                      "c.src"),
              ElementsAre("5 CIRC: N", "5 CIRC: N", "6 ASYPTP: L"));
}

constexpr const char* none = ",[9E9,9E9,9E9,9E9,9E9,9E9]]";

TEST(RapidProgram, SortsTargetsByTheirUseOverLineBreaks) {
  const std::string text =
      std::string("%%%\n VERSION:1\n LANGUAGE:ENGLISH\n%%%\nMODULE Weld (\n  SYSMODULE,\n  NOSTEPIN)\n") +
      "  CONST jointtarget jA:=[[10,10,20,0,30,0]" + none + ";\n  LOCAL PERS jointtarget jPath{2}:=[\n" +
      "    [[1,2,3,4,5,6]" + none + ",\n    [[2,2,3,4,5,6]" + none + "];\n" +
      "  CONST jointtarget jB:=[[nA1,10,20,0,30,0]" + none +
      ";\n  CONST jointtarget jNever:=[[0,0,5,0,0,0],[0,0,0,0,0,0]];\n" +
      "  CONST robtarget pS:=[[600,0,500],[0,0,1,0],[0,0,0,0]" + none + ";\n" +
      "  PROC main()\n    MoveAbsJ jA\\NoEOffs,v100,fine,tool0;\n    ! MoveAbsJ jNever,v1,fine,tool0;\n" +
      "    TPWrite \"MoveAbsJ jNever\";\n    MoveAbsJ jPath{i},v100,\n      z10,tool0;\n" +
      "    IF ready MoveL Offs(pS,0,0,100),v100,fine,tool0\\WObj:=wobj0;\n    MoveL pS,v100,fine,tool0;\n" +
      "    MoveJ \\Conc, CRobT(),v1,fine,tool0;\n    MoveAbsJ CalcJointT(pS,tool0),v1,fine,tool0;\n  "
      "ENDPROC\nENDMODULE\n";
  const auto document = std::move(read({{"abb-rapid", text, "weld.mod"}}).front());
  EXPECT_THAT(lines_of(*document), ElementsAre("8 jA: C", "10 jPath: C", "11 jPath: C", "12 jB: ?", "13 jNever: L",
                                               "14 pS: N", "16 MoveAbsJ jA: C", "19 MoveAbsJ jPath: C", "21 MoveL: L",
                                               "22 MoveL pS: N", "23 MoveJ: L", "24 MoveAbsJ: ?"));
  const std::string after = moved(*document);
  EXPECT_THAT(after,
              HasSubstr("  NOSTEPIN)\n  ! Written by posewright compensate: x\n  CONST jointtarget jA:=[[10.573"));
  EXPECT_THAT(after, HasSubstr("jNever:=[[0,0,5,0,0,0],[0,0,0,0,0,0]]"));
}

const std::string tp_positions =
    "P[1]{\n   GP1:\n\tUF : 0, UT : 1,\n\tJ1= 0.000 deg,\tJ2= 10.000 deg,\tJ3= 20.000 deg,\n\tJ4= 0.000 deg,\tJ5= "
    "30.000 deg,\tJ6= 0.000 deg\n};\nP[2:\"HOME\"]{\n   GP1:\n\tUF : 0, UT : 1,\n\tJ1= 0.000 deg,\tJ2= 0.000 deg,\tJ3= "
    "5.000 deg,\n\tJ4= 0.000 deg,\tJ5= 0.000 deg,\tJ6= 0.000 deg\n};\nP[3]{\n   GP1:\n\tUF : 1, UT : 1,\tCONFIG : 'N U "
    "T, 0, 0, 0',\n\tX = 600.000  mm,\tY = 0.000  mm,\tZ = 500.000  mm,\n\tW = 180.000 deg,\tP = 0.000 deg,\tR = 0.000 "
    "deg\n};\nP[4]{\n   GP1:\n\tUF : 0, UT : 1,\n\tJ1= 0.000 deg,\tJ2= 0.000 deg,\tJ3= 5.000 deg,\n\tJ4= 0.000 "
    "deg,\tJ5= "
    "0.000 deg,\tJ6= 0.000 deg\n};\n/END\n";

TEST(TpProgram, LeavesIncrementsAndOffsetsAndMarksTheFile) {
  const std::string text =
      "/PROG  INC\n/ATTR\nLINE_COUNT\t= 8;\n/MN\n   1:J P[1] 20% FINE    ;\n   2:  !J P[4] 20% FINE ;\n   3:J P[4] 20% "
      "FINE INC    ;\n"
      "   4:L P[3] 100mm/sec FINE    ;\n   5:L P[3] 100mm/sec CNT50 Offset,PR[1]    ;\n   6:J PR[2] 20% FINE    ;\n"
      "   7:J P[R[1]] 20% FINE    ;\n   8:J P[2:HOME] 20% FINE    ;\n/POS\n" +
      tp_positions;
  const auto document = std::move(read({{"fanuc-tp", text, "inc.ls"}}).front());
  EXPECT_THAT(lines_of(*document),
              ElementsAre("5 J P[1]: C", "7 J INC P[4]: L", "8 L P[3]: N", "9 L P[3]: L", "10 J: ?", "11 J: ?",
                          "12 J P[2]: L", "14 P[1]: C", "20 P[2] HOME: L", "26 P[3]: N", "32 P[4]: L"));
  const std::string after = moved(*document);
  EXPECT_THAT(after, HasSubstr("LINE_COUNT\t= 9;"));
  EXPECT_THAT(after, HasSubstr("FINE    ;\n   9:  !Written by posewright compensate ;\n/POS"));
  EXPECT_THAT(after, HasSubstr("P[4]{\n   GP1:\n\tUF : 0, UT : 1,\n\tJ1= 0.000 deg,\tJ2= 0.000 deg,\tJ3= 5.000 deg"));
}

TEST(TpProgram, LeavesRailAndPositionerWhereTheyAre) {
  const std::string others =
      ",\n\tE1= 500.000  mm\n   GP2:\n\tUF : 0, UT : 1,\n\tJ1= 30.000 deg,\tJ2= 90.000 deg\n};\n/END\n";
  const std::string text =
      "/PROG  G\n/ATTR\nLINE_COUNT\t= 1;\n/MN\n   1:J P[1] 20% FINE    ;\n/POS\nP[1]{\n   GP1:\n\tUF : 0, UT : "
      "1,\n\tJ1= "
      "0.000 deg,\tJ2= 10.000 deg,\tJ3= 20.000 deg,\n\tJ4= 0.000 deg,\tJ5= 30.000 deg,\tJ6= 0.000 deg" +
      others;
  const auto document = std::move(read({{"fanuc-tp", text, "g.ls"}}).front());
  EXPECT_THAT(lines_of(*document), ElementsAre("5 J P[1]: C", "7 P[1]: C"));
  const std::string after = moved(*document);
  EXPECT_THAT(after, HasSubstr(others));
  EXPECT_THAT(after, Not(HasSubstr("J1= 0.000 deg")));
}

TEST(KrlProgram, KeepsANumberApartFromTheNameBeforeIt) {
  const auto document =
      std::move(read({{"kuka-krl", "DEF W()\nPTP {A1 0,A2 0,A3 0,A4 0,A5 30,A6.5}\nEND\n", "w.src"}}).front());
  EXPECT_THAT(moved(*document), HasSubstr("A6 1.07296}"));
}

TEST(UrscriptProgram, ComputesConstantsAndSaysWhatItCannot) {
  const std::string text =
      "def prog():\n  q1 = [0.25, -0.5, 0.5, 0, 0.6, 0]\n  movej([0.15, -0.5, 0.5, 0, 0.6, 0], a=1.4, v=1.05)\n"
      "  movej([d2r(9), d2r(-29), d2r(29), d2r(0), d2r(34), d2r(0)], a=1.4)\n  movej([0.15, -pi/6, 0.5, 0, 0.6, 0])\n"
      "  movel(q1, a=1.2, v=0.25)\n  servoj(q1, t=0.1)\n  movej(get_inverse_kin(p[0.4,0,0.3,0,3.1,0]), a=1)\n"
      "  movel(p[0.4, 0.1, 0.3, 0, 3.1, 0])\n  movel(pose_trans(p1, p[0,0,0.1,0,0,0]))\n  movej([x, 0, 0, 0, 0, 0])\n"
      "  set_payload(2.0, [0,0,0.05], [0.1, 0.1, 0.1, 0, 0, 0])\n  path = [[0,0,0,0,0,1],[0,0,0,0,0,2]]\n  "
      "movej(path[i])\n"
      "  speedj([0.1,0,0,0,0,0], 0.5)\n  set_tcp(p[0,0,0.1,0,0,0])\n  popup(\"movej([1,2,3,4,5,6])\")\nend\n";
  const auto document = std::move(read({{"urscript", text, "p.script"}}).front());
  EXPECT_THAT(lines_of(*document),
              ElementsAre("2 q1: C", "3 movej: C", "4 movej: C", "5 movej: C", "6 movel q1: C", "7 servoj q1: C",
                          "8 movej: N", "9 movel: N", "10 movel: L", "11 movej: ?", "13 path: C", "13 path: C",
                          "14 movej path: C", "15 speedj: L"));
  EXPECT_NEAR(document->points()[2].joints[4], 34 * 0.017453292519943295, 1e-15);
  EXPECT_NEAR(document->points()[3].joints[1], -3.14159265358979 / 6, 1e-14);
  EXPECT_THAT(moved(*document),
              HasSubstr("movej([0.167080, -0.496145, 0.516145, 0.010000, 0.603412, 0.010000], a=1.4)"));
}

/// An arm whose poses are compensated, with tools and bases that programs name by number.
std::unique_ptr<ProgramDocument> read_poses(const std::vector<ProgramFile>& files) {
  ProgramRobot robot = six_axes();
  robot.why_no_poses.clear();
  robot.frames = {{{"1", {0, 0, 200, 0, 0, 0}}}, {{"2", {1000, 0, 0, 0, 0, 90}}}};
  return std::move(read_programs(files, robot).front());
}

TEST(UrscriptProgram, KnowsWhichMotionSurelyEndedWhereAPoseIsMovedToFrom) {
  const std::string text =
      "def prog():\n  set_tcp(p[0, 0, 0.1, 0, 0, 0])\n  home = [0, 0, 0, 0, 1, 0]\n  a = p[0.4, 0, 0.3, 0, 3, 0]\n"
      "  movel(a)\n  movej(home)\n  movel(a)\n  while (get_standard_digital_in(1)):\n    sync()\n  end\n"
      "  movej(p[0.4, 0.1, 0.3, 0, 3, 0])\n  if (x > 1):\n    movel(a)\n  else:\n    movel(a)\n  end\n  movel(a)\n"
      "  movej(get_inverse_kin(a, qnear=home))\n  movel(pose_trans(a, p[0, 0, 0.1, 0, 0, 0]))\n  movel(a)\nend\n";
  const auto document = read_poses({{"urscript", text, "p.script"}});
  EXPECT_NEAR(document->points()[0].X_BaseTip.translation().z(), 0.3 - 0.1 * std::cos(3.0), 1e-12);
  struct Expected {
    int line, from;
    bool joints, along;
  };
  // Points: a and the one in line 11; home is left, and its joints are known.
  const std::vector<Expected> expected = {{5, -1, false, true},  {6, 0, false, false},  {7, -1, true, true},
                                          {11, 0, false, false}, {13, 1, false, true},  {15, 1, false, true},
                                          {17, -1, false, true}, {18, -1, true, false}, {20, -1, false, true}};
  ASSERT_EQ(document->motions()->size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k) {
    const PointMotion& motion = (*document->motions())[k];
    EXPECT_EQ(motion.line, expected[k].line);
    EXPECT_EQ(motion.from, expected[k].from) << motion.line;
    EXPECT_EQ(!motion.joints.empty(), expected[k].joints) << motion.line;
    EXPECT_EQ(motion.along, expected[k].along) << motion.line;
  }
}

TEST(InformProgram, GivesAPoseAHeadingOfItsOwnWhereItsJointsNeedOne) {
  const std::string text =
      "/JOB\r\n//NAME W\r\n//POS\r\n///NPOS 2,0,0,0,0,0\r\n///USER 2\r\n///TOOL 1\r\n///POSTYPE USER\r\n"
      "///RECTAN\r\n///RCONF 0,0,0,0,0,0,0,0\r\nC00000=100.000,0.000,500.000,0.00,0.00,0.00\r\n"
      "C00001=200.000,0.000,500.000,0.00,0.00,0.00\r\n//INST\r\nNOP\r\nMOVL C00000 V=10.0\r\nMOVL C00001 V=10.0\r\n"
      "END\r\n";
  const auto document = read_poses({{"yaskawa-inform", text, "w.jbi"}});
  ASSERT_EQ(document->points().size(), 2U);
  EXPECT_LT((document->points()[0].X_BaseTip.translation() - Eigen::Vector3d(1, 0.1, 0.3)).norm(), 1e-12);
  std::vector<std::optional<ProgramDocument::Values>> values(2);
  values[0] = ProgramDocument::Values{{{0, 0, 0, 1.7, 0.5, 0}}, document->points()[0].X_BaseTip};
  EXPECT_THAT(
      document->text(values, ""),
      HasSubstr("///RCONF 0,0,0,0,0,0,0,0\r\n///RCONF 1,0,0,0,0,0,0,0\r\nC00000=100.0000,0.0000,500.0000,0.00000,"
                "0.00000,0.00000\r\n///RCONF 0,0,0,0,0,0,0,0\r\nC00001=200.000,"));
}

TEST(Val3Program, ComposesFramesAndToolsOfItsFiles) {
  const auto value = [](const char* type, const char* name, const std::string& values) {
    return std::string("<Data name=\"") + name + "\" type=\"" + type + "\"><Value key=\"0\" " + values + " /></Data>\n";
  };
  const std::string status = " rx=\"0\" ry=\"0\" rz=\"0\" shoulder=\"lefty\" elbow=\"epositive\" wrist=\"wpositive\" ";
  const std::string data =
      "<Database>\n" + value("frame", "fA", "x=\"100\" rz=\"90\" fatherId=\"world[0]\"") +
      value("frame", "fB", "x=\"10\" fatherId=\"fA[0]\"") + value("tool", "tA", "z=\"50\" fatherId=\"flange[0]\"") +
      value("pointRx", "p1", "x=\"1\" y=\"0\" z=\"0\"" + status + "fatherId=\"fB[0]\"") +
      value("pointRx", "p2", "x=\"1\" y=\"0\" z=\"0\"" + status + "fatherId=\"fC[0]\"") +
      value("pointRx", "p3", "x=\"1\" y=\"0\" z=\"0\" rx=\"0\" ry=\"0\" rz=\"0\" wrist=\"wsame\"") + "</Database>\n";
  const std::string code =
      "<Programs>\n<Code>begin\nmovel(p1,tA,m)\nmovel(p2,tA,m)\nmovel(p3,tA,m)\nend</Code></Programs>\n";
  const auto document = read_poses({{"staubli-val3", data, "d/d.dtx"}, {"staubli-val3", code, "d/start.pgx", true}});
  EXPECT_THAT(lines_of(*document), ElementsAre("5 p1: C", "6 p2: N", "7 p3: ?"));
  EXPECT_LT((document->points()[0].X_BaseTip.translation() - Eigen::Vector3d(0.1, 0.011, -0.05)).norm(), 1e-12);
  EXPECT_EQ(why(*document, 6), "fC has no value in these files: --base");
  EXPECT_EQ(why(*document, 7), "the controller chooses its wrist (wsame)");
}

TEST(InformProgram, LeavesIncrementsAndMarksTheJob) {
  const std::string text =
      "/JOB\r\n//NAME W\r\n//POS\r\n///NPOS 2,0,0,2,0,0\r\n///TOOL 0\r\n///POSTYPE PULSE\r\n///PULSE\r\n"
      "C00000=0,10000,20000,0,30000,0\r\nP00001=0,0,5000,0,0,0\r\n///POSTYPE BASE\r\n///RECTAN\r\n///RCONF "
      "0,0,0,0,0,0\r\n"
      "C00001=600.000,0.000,500.000,180.00,0.00,0.00\r\n//INST\r\n///DATE 2026/01/01 12:00\r\n///ATTR SC,RW\r\nNOP\r\n"
      "MOVJ C00000 VJ=10.00\r\n'MOVJ P001\r\nIMOV P001 V=100.0\r\nMOVL C00001 V=100.0\r\nMOVJ P[B001] "
      "VJ=10.00\r\nEND\r\n";
  const auto document = std::move(read({{"yaskawa-inform", text, "w.jbi"}}).front());
  EXPECT_THAT(lines_of(*document), ElementsAre("8 C0: C", "9 P1: L", "13 C1: N", "18 MOVJ C0: C", "20 IMOV P1: L",
                                               "21 MOVL C1: N", "22 MOVJ: ?"));
  EXPECT_THAT(moved(*document), HasSubstr("NOP\r\n'Written by posewright compensate\r\nMOVJ"));
}

TEST(Val3Program, TakesTheUseOfItsDataFromTheProgramsBesideThem) {
  const std::string data =
      "<?xml version=\"1.0\"?>\n<Database>\n<Datas>\n<Data name=\"jA\" type=\"jointRx\" size=\"1\">\n<Value key=\"0\" "
      "j1=\"1\" j2=\"2\" "
      "j3=\"3\" j4=\"4\" j5=\"5\" j6=\"6\" />\n</Data>\n<Data name=\"jStep\" type=\"jointRx\" size=\"1\">\n<Value "
      "key=\"0\" j1=\"0\" j2=\"0\" "
      "j3=\"5\" j4=\"0\" j5=\"0\" j6=\"0\" />\n</Data>\n<Data name=\"pA\" type=\"pointRx\" size=\"1\">\n<Value "
      "key=\"0\" x=\"600\" y=\"0\" z=\"5\" "
      "rx=\"0\" ry=\"180\" rz=\"0\" />\n</Data>\n</Datas>\n</Database>\n";
  const std::string code =
      "<Programs>\n<Program name=\"start\">\n<Code><![CDATA[begin\n  movej(jA,flange,mSlow)\n  // "
      "movej(jStep,flange,mSlow)\n  movej(jA+jStep,flange,mSlow)\n"
      "  movel(appro(pA,trZ),flange,mSlow)\n  movel(pA,flange,mSlow)\nend]]></Code>\n</Program>\n</Programs>\n";
  const auto documents = read({{"staubli-val3", data, "a/a.dtx"}, {"staubli-val3", code, "a/start.pgx", true}});
  ASSERT_EQ(documents.size(), 1U);
  EXPECT_THAT(lines_of(*documents[0]), ElementsAre("5 jA: C", "8 jStep: L", "11 pA: N"));
  EXPECT_THAT(moved(*documents[0]),
              HasSubstr("<?xml version=\"1.0\"?>\n<!-- Written by posewright compensate: x -->\n<Database>"));
  EXPECT_THAT(lines_of(*read({{"staubli-val3", data, "a/a.dtx"}, {"staubli-val3", code, "a/start.pgx"}})[1]),
              ElementsAre("4 movej jA: C", "6 movej: L", "7 movel: L", "8 movel pA: N"));
  EXPECT_THAT(account("staubli-val3", data, "a/a.dtx"), ElementsAre("5 jA: L", "8 jStep: L", "11 pA: L"));
}

/// The same robot, whose poses can be compensated.
std::unique_ptr<ProgramDocument> read_poses_of(const std::string& format, const std::string& text,
                                               const ProgramFrames& frames = {}) {
  ProgramRobot robot = six_axes();
  robot.why_no_poses.clear();
  robot.frames = frames;
  return std::move(read_programs({{format, text, "p"}}, robot).front());
}

TEST(KrlProgram, TakesToolAndBaseFromTheProgramOrTheUserAndSaysWhichIsMissing) {
  const std::string pose = "{X 600,Y 10,Z 500,A 0,B 90,C 0,S 2,T 35}";
  const auto program = [&](const std::string& lines) { return "DEF P()\n" + lines + "LIN " + pose + "\nEND\n"; };
  const auto reason = [&](const std::string& lines, const ProgramFrames& frames = {}) {
    const std::string text = program(lines);
    return read_poses_of("kuka-krl", text, frames)->account().entries.back().why;
  };
  EXPECT_EQ(reason("$TOOL={X 0,Y 0,Z 100,A 0,B 0,C 0}\n$BASE=$NULLFRAME\n"), "");
  EXPECT_EQ(reason("BAS(#TOOL,0)\nBAS(#BASE,0)\n"), "");
  EXPECT_EQ(reason("$BASE=$NULLFRAME\n"), "the program does not state its tool: --tool");
  EXPECT_EQ(reason("BAS (#TOOL,3)\nBAS (#BASE,0)\n"), "TOOL_DATA[3] has no value in these files: --tool");
  EXPECT_EQ(reason("TOOL_DATA[3]={X 0,Y 0,Z 100,A 0,B 0,C 0}\nBAS (#TOOL,3)\nBAS (#BASE,0)\n"), "");
  EXPECT_EQ(reason("DECL FDAT FP1={TOOL_NO 3,BASE_NO 0,IPO_FRAME #BASE}\nFDAT_ACT=FP1\n"),
            "TOOL_DATA[3] has no value in these files: --tool");
  ProgramFrames given;
  given.tools["3"] = {0, 0, 100, 0, 0, 0};
  EXPECT_EQ(reason("BAS (#TOOL,3)\nBAS (#BASE,0)\n", given), "");
  EXPECT_EQ(reason("$TOOL=$NULLFRAME\n$BASE=$NULLFRAME\n$IPO_MODE=#TCP\n"), "the tool is stationary ($IPO_MODE=#TCP)");

  const std::string text = program("$TOOL={X 0,Y 0,Z 100,A 0,B 0,C 0}\n$BASE={X 1000,Y 0,Z 0,A 90,B 0,C 0}\n");
  const auto document = read_poses_of("kuka-krl", text);
  // The tool points along x where B is 90 deg; then the base turns and displaces it.
  const Eigen::Vector3d tip = document->points()[0].X_BaseTip.translation();
  EXPECT_LT((tip - Eigen::Vector3d(0.99, 0.5, 0.5)).norm(), 1e-12) << tip.transpose();
}

TEST(KrlProgram, DoesNotUnderstandAPoseWithoutStatusOrWithSeveralTools) {
  const std::string frames = "$BASE=$NULLFRAME\n$TOOL=$NULLFRAME\n";
  const auto open = read_poses_of("kuka-krl", "DEF P()\n" + frames + "LIN {X 600,Y 10,Z 500,A 0,B 90,C 0}\nEND\n");
  EXPECT_THAT(lines_of(*open), ElementsAre("4 LIN: ?"));
  EXPECT_THAT(why(*open, 4), HasSubstr("has no S"));
  const auto two = read_poses_of("kuka-krl", "DEF P()\nXP={X 600,Y 10,Z 500,A 0,B 90,C 0,S 2,T 35}\n" + frames +
                                                 "LIN XP\n$TOOL={X 0,Y 0,Z 9,A 0,B 0,C 0}\nLIN XP\nEND\n");
  EXPECT_THAT(lines_of(*two), ElementsAre("2 XP: N", "5 LIN XP: N", "7 LIN XP: N"));
  EXPECT_THAT(why(*two, 2), HasSubstr("several tools or bases"));
}

TEST(RapidProgram, TakesTooldataAndWobjdataOfItsMotions) {
  const std::string target = "[[600,0,500],[0,0,1,0],[0,0,0,0]" + std::string(none);
  const std::string text =
      "MODULE M\n PERS tooldata tGun:=[TRUE,[[0,0,100],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];\n"
      " PERS wobjdata wA:=[FALSE,TRUE,\"\",[[1000,0,0],[1,0,0,0]],[[0,50,0],[1,0,0,0]]];\n CONST robtarget p1:=" +
      target + ";\n CONST robtarget p2:=" + target + ";\n PROC main()\n  MoveL p1,v100,fine,tGun\\WObj:=wA;\n" +
      "  MoveJ p2,v100,z10,tOther;\n ENDPROC\nENDMODULE\n";
  const auto document = read_poses_of("abb-rapid", text);
  EXPECT_THAT(lines_of(*document), ElementsAre("4 p1: C", "5 p2: N", "7 MoveL p1: C", "8 MoveJ p2: N"));
  EXPECT_EQ(why(*document, 5), "TOTHER has no value in these files: --tool");
  EXPECT_LT((document->points()[0].X_BaseTip.translation() - Eigen::Vector3d(1.6, 0.05, 0.6)).norm(), 1e-12);
  std::string displaced = text;
  displaced.replace(displaced.find("  MoveL"), 0, "  PDispOn p1,tGun;\n");
  EXPECT_THAT(why(*read_poses_of("abb-rapid", displaced), 4), HasSubstr("PDispOn displaces poses"));
}

TEST(TpProgram, MeansTheJointsOfItsConfiguration) {
  const std::string text = "/PROG  T\n/MN\n   1:L P[3] 100mm/sec FINE    ;\n/POS\n" + tp_positions;
  ProgramFrames frames;
  frames.tools["1"] = frames.bases[""] = {0, 0, 0, 0, 0, 0};
  const auto document = read_poses_of("fanuc-tp", text, frames);
  ASSERT_EQ(document->points().size(), 1U);
  const auto stand = [](double first, double fifth, bool behind) {
    return ArmStand{{first, 0.2, 0.1, 0.3, fifth, 0.1}, behind, false};
  };
  EXPECT_THAT(document->meant(0, {stand(0, 1, false), stand(0, -1, false), stand(0, -1, true), stand(4, -1, false)}),
              ElementsAre(1U));
  const std::string after =
      document->text({ProgramDocument::Values{stand(4, -1, true), document->points()[0].X_BaseTip}}, "r");
  EXPECT_THAT(after, HasSubstr("CONFIG : 'N U B, 1, 0, 0',\n\tX = 600.0000  mm"));
}

TEST(JointTrajectory, HasNoCoupling) {
  const std::string text =
      "joint_names: [j1, j2, j3, j4, j5, j6]\npoints:\n- positions: [0.1, 0.2, 0.3, 0.4, 0.5, 0.6]\n";
  ProgramRobot robot = six_axes();
  EXPECT_THAT(account("joint-trajectory", text), ElementsAre("3 positions: C"));
  robot.coupling = 1;
  EXPECT_THROW(read_programs({{"joint-trajectory", text, "t.yaml"}}, robot), InputError);
}

TEST(JointTrajectory, TakesNamesInBracketsOrOneALineAndRefusesPointsOfAnotherLength) {
  const std::string names = "joint_names:\n  - j1\n  - 'j2'\n  - j3  # elbow\n  - j4\n  - j5\n  - j6\npoints:\n";
  const std::string first = "  - positions: [0, 0.1, 0.2, 0, 0.3, 0]\n", short_one = "  - positions: [0, 0.1]\n";
  const auto document = std::move(read({{"joint-trajectory", names + first, "t.yaml"}}).front());
  EXPECT_THAT(lines_of(*document), ElementsAre("9 positions: C"));
  EXPECT_DOUBLE_EQ(document->points()[0].joints[4], 0.3);
  EXPECT_THAT(message_of<InputError>([&] {
                read({{"joint-trajectory", names + first + short_one, "t.yaml"}});
              }),
              HasSubstr("t.yaml:10: has positions that are no list in brackets"));
}

TEST(KrlProgram, ReadsTypedListsAndLeavesBrokenOnesAlone) {
  const std::string typed = "{E6AXIS: A1 0,A2 10,A3 20,A4 0,A5 30,A6 0}";
  const std::string text = "DEF T()\nPTP " + typed +
                           "\nPTP {A1 0,A2 (10,A3 20,A4 0,A5 30,A6 0}\nPTP {A1 0,A2 -(B),A3 20," +
                           "A4 0,A5 30,A6 0}\nEND\n";
  const auto document = std::move(read({{"kuka-krl", text, "t.src"}}).front());
  EXPECT_THAT(lines_of(*document), ElementsAre("2 PTP: C", "3 PTP: ?", "4 PTP: ?"));
  const std::string after = moved(*document);
  EXPECT_THAT(after, HasSubstr("PTP {E6AXIS: A1 0.57296,A2 10.57296"));
  EXPECT_THAT(after, HasSubstr("PTP {A1 0,A2 (10,A3 20,A4 0,A5 30,A6 0}"));
}

TEST(KrlProgram, TellsPosesFromStepsAndChangedDataThatNothingMovesTo) {
  const std::string text = std::string("DEF C()\nDECL E6AXIS XA\nDECL E6AXIS XB\nXA=") + krl_zero + "\nXB=" + krl_zero +
                           "\nPTP XA\nPTP_REL XA\nXB.A1=5\nEND\n";
  const auto document = std::move(read({{"kuka-krl", text, "c.src"}}).front());
  EXPECT_THAT(lines_of(*document), ElementsAre("4 XA: ?", "5 XB: L", "6 PTP XA: ?", "7 PTP_REL XA: L"));
  EXPECT_EQ(why(*document, 4), "is a pose (line 6) and a relative motion (line 7)");
  EXPECT_EQ(why(*document, 5), "the program changes it (line 8) and does not move to it");
}

TEST(InformProgram, DoesNotUnderstandValuesThatAreNoNumbersNorMotionsWithoutAPoint) {
  const std::string job =
      "/JOB\n//NAME W\n//POS\n///NPOS 1,0,0,0,0,0\n///POSTYPE PULSE\n///PULSE\nC00000=0,B,0,0,3000,0\n//INST\nNOP\n"
      "MOVJ C00000 VJ=5.00\nMOVJ VJ=5.00\nEND\n";
  const auto document = std::move(read({{"yaskawa-inform", job, "w.jbi"}}).front());
  EXPECT_THAT(lines_of(*document), ElementsAre("7 C0: ?", "10 MOVJ C0: ?", "11 MOVJ: ?"));
  EXPECT_EQ(why(*document, 11), "its point is not understood");
}

TEST(TpProgram, DoesNotUnderstandAPointWithoutBraces) {
  const auto document = std::move(
      read({{"fanuc-tp", "/PROG W\n/ATTR\n/MN\n   1:J P[1] 10% FINE ;\n/POS\nP[1]\n/END\n", "w.ls"}}).front());
  EXPECT_EQ(document->account().count(Treatment::compensated), 0U);
  EXPECT_GE(document->account().count(Treatment::not_understood), 1U);
}

TEST(Val3Program, DoesNotUnderstandAValueThatIsNoNumber) {
  const std::string data =
      "<Database>\n<Data name=\"jA\" type=\"jointRx\"><Value key=\"0\" j1=\"0\" j2=\"x\" j3=\"0\" j4=\"0\" j5=\"0\" "
      "j6=\"0\"/>"
      "</Data>\n</Database>\n";
  const auto document = std::move(read({{"staubli-val3", data, "w.dtx"}}).front());
  EXPECT_THAT(lines_of(*document), ElementsAre("2 jA: ?"));
}

TEST(Program, RefusesSettingsThatAreMissingOrOfAnotherRobot) {
  const auto refused = [](const std::string& format, const ProgramRobot& robot) -> std::string {
    return message_of([&] { read_programs({{format, "", "p", true}}, robot); });
  };
  ProgramRobot robot = six_axes();
  robot.settings.pulses_per_degree = {1000, 1000};
  EXPECT_THAT(refused("urscript", robot), HasSubstr("pulses_per_degree has 2 entries; the robot has 6 joints"));
  robot.settings.pulses_per_degree.clear();
  EXPECT_THAT(refused("yaskawa-inform", robot), HasSubstr("needs pulses_per_degree in --controller FILE"));
  robot.coupling.reset();
  EXPECT_THAT(refused("fanuc-tp", robot), HasSubstr("fanuc-tp needs --coupling F"));
  robot.coupling = 1.0;
  robot.names = {"j1", "j2"};
  robot.units = {"rad", "rad"};
  EXPECT_THAT(refused("kuka-krl", robot), HasSubstr("--coupling is for robots of three axes or more"));
  robot.coupling = 0.0;
  robot.names = std::vector<std::string>(7, "j");
  robot.units = std::vector<std::string>(7, "rad");
  EXPECT_THAT(refused("urscript", robot), HasSubstr("urscript has six turning axes, the robot 7 joints"));
  EXPECT_THAT(refused("kuka-krl", robot), HasSubstr("name the controller's axes in --controller FILE (axes)"));
}

}  // namespace
}  // namespace posewright
