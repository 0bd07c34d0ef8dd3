#include <gmock/gmock.h>

#include <ostream>

#include "example_files.hpp"
#include "posewright/problem/read_problem.hpp"

namespace posewright {
namespace {

using example::replaced;
using testing::HasSubstr;

/// A good file with one thing replaced, and the message that follows.
struct BadFile {
  const char* name;
  const std::string& good;
  const char* from;
  const char* to;
  int line;
  const char* message;
};

void PrintTo(const BadFile& bad, std::ostream* out) { *out << bad.name; }

const std::string& arm = example::serial;
const std::string& platform = example::six_pus;
const std::string& cell = example::cell;

class BadProblem : public testing::TestWithParam<BadFile> {};

TEST_P(BadProblem, NamesLineAndReason) {
  const BadFile& bad = GetParam();
  const std::string text = replaced(bad.good, bad.from, bad.to);
  try {
    parse_problem(text, "bad.yaml");
    FAIL() << "was accepted";
  } catch (const InputError& error) {
    const std::string what = error.what();
    EXPECT_EQ(error.place().line, bad.line) << what;
    EXPECT_THAT(what,
                testing::StartsWith(bad.line == 0 ? "bad.yaml: " : "bad.yaml:" + std::to_string(bad.line) + ": "));
    EXPECT_THAT(what, HasSubstr(bad.message));
    EXPECT_EQ(what.find_first_of("\n\r"), std::string::npos) << what;
  }
}

std::string test_name(const testing::TestParamInfo<BadFile>& info) { return info.param.name; }

const BadFile root[] = {
    {"UnclosedFlowList", arm, "[z, x]", "[z, x", 15, "valid YAML"},
    {"TabIndent", arm, "  base: base_link", "\tbase: base_link", 4, "valid YAML"},
    {"UndefinedAlias", arm, "tip: flange", "tip: *nowhere", 5, "valid YAML: the referenced anchor is not defined"},
    {"SecondDocument", arm, "measurement:", "---\nmeasurement:", 9,
     "holds a second YAML document; only one is allowed"},
    {"CommaAtTheBeginning", arm, "posewright", ",posewright", 1, "holds a second YAML document"},
    {"ListAtTop", arm, arm.c_str(), "- 1\n- 2\n", 1, "the file is a list; a mapping (key: value) is expected"},
    {"TextAtTop", arm, arm.c_str(), "hello\n", 1, "the file is 'hello'; a mapping"},
    {"VersionMissing", arm, "posewright: 1\n", "", 1, "the file has no key 'posewright'; it is required"},
    {"VersionUnknown", arm, "posewright: 1", "posewright: 2", 1, "is '2'; the only known schema version is 1"},
    {"RootKeyUnknown", arm, "design:", "desing:", 31,
     "unknown key 'desing' (did you mean 'design'?); allowed: posewright, robot, measurement, variants, workspace, "
     "design"},
    {"RootKeyTwice", arm, "design:", "robot:", 31, "duplicate key 'robot'; first given on line 2"},
    {"KeyIsAList", arm, "  base: base_link", "  [base]: base_link", 4, "a key of robot is a list"},
    {"SectionMissing", arm, arm.c_str(), "posewright: 1\nrobot: {urdf: a}\n", 1,
     "the file has no key 'measurement'; it is required"},
    {"SectionEmpty", platform, "workspace:\n  pose:", "workspace:\n#", 20, "workspace is empty; a mapping"},
    {"MergeKey", arm, "  base: base_link", "  <<: {base: base_link}", 4, "unknown key '<<'"},
};

const BadFile serial_robot[] = {
    {"RobotKeyUnknown", arm, "base: base_link", "bse: base_link", 4,
     "unknown key 'bse' (did you mean 'base'?); allowed: urdf, xacro, srdf, group, base, tip, tips, hold, placement, "
     "encoder_noise, parameter_names, "
     "elastostatic"},
    {"RobotKeyTwice", arm, "tip: flange", "base: flange", 5, "duplicate key 'base'; first given on line 4"},
    {"RobotIsText", arm, arm.c_str(), "posewright: 1\nrobot: six_pus\n", 2, "robot is 'six_pus'; a mapping"},
    {"NeitherUrdfNorModel", arm, "  urdf: kr270.urdf\n", "", 2,
     "has neither urdf nor model nor poses; one of them is required"},
    {"BothUrdfAndModel", arm, "base: base_link", "model: six_pus", 4, "one of urdf, model is allowed"},
    {"UrdfEmpty", arm, "urdf: kr270.urdf", "urdf: ''", 3, "robot.urdf is empty; a file name is expected"},
    {"UrdfNull", arm, "urdf: kr270.urdf", "urdf:", 3, "robot.urdf is empty; a file name is expected"},
    {"BaseIsAList", arm, "base: base_link", "base: [a, b]", 4, "robot.base is a list"},
    {"PositionTooShort", arm, "[1, \"20 mm\", 0]", "[1, 2]", 6,
     "robot.placement.position has 2 entries; expected 3 numbers"},
    {"PositionIsANumber", arm, "[1, \"20 mm\", 0]", "5", 6, "robot.placement.position is '5'; expected 3 numbers"},
    {"PositionInDegrees", arm, "20 mm", "20 deg", 6,
     "robot.placement.position[2] is wrong: '20 deg' has the wrong unit"},
    {"EncoderNoiseNegative", arm, "\"0.001 deg\"", "-1e-6", 7, "is '-1e-6'; a value >= 0 is expected"},
    {"EncoderNoiseNotANumber", arm, "\"0.001 deg\"", ".nan", 7, "not a finite number"},
    {"ParameterNameTaken", arm, "joint_a2.y", "joint_a2.x", 8, "already has the name 'px1'"},
    {"ParameterNameTwice", arm, "py1:", "px1:", 8, "duplicate key 'px1'"},
    {"ParameterNameGlob", arm, "joint_a2.y", "\"joint_*\"", 8, "* and ? are not allowed in a name"},
    {"ParameterKeyGlob", arm, "py1:", "\"p?\":", 8, "a plain name is expected"},
    {"ParameterNameEmpty", arm, "joint_a2.y", "''", 8, "is empty; a name is expected"},
};

const BadFile parallel_robot[] = {
    {"ModelUnknown", platform, "six_pus", "hexapod", 3,
     "robot.model is 'hexapod'; allowed: six_pus, gough, five_bar, delta, compensator"},
    {"ReferenceMissing", platform, "  reference:", "  urdf_placement:", 4,
     "unknown key 'urdf_placement'; allowed: model, placement, reference, actuators, legs"},
    {"ReferenceWithoutPosition", platform, "position: [0, 0, \"483.7 mm\"], ", "", 4,
     "robot.reference has no key 'position'"},
    {"TravelReversed", platform, "[\"-1.3 mm\", \"1.3 mm\"]", "[1, -1]", 5,
     "is an empty range; lower < upper is needed"},
    {"TravelTooLong", platform, "[\"-1.3 mm\", \"1.3 mm\"]", "[1, 2, 3]", 5, "has 3 entries; expected 2 numbers"},
    {"DecimalComma", platform, "\"-1.3 mm\"", "\"-1,3 mm\"", 5, "'-1,3 mm' has a decimal comma; write a decimal point"},
    {"ActuatorNoiseNegative", platform, "\"1 um\"", "\"-1 um\"", 5, "a value >= 0 is expected"},
    {"FiveLegs", platform, "    - {a: [0, 0.1, 0], b: [0, 0.05, 0], l: 0.5}\n", "", 6,
     "robot.legs has 5 entries; exactly 6 legs are expected"},
    {"LegIsText", platform, "{a: [0, 0.1, 0], b: [0, 0.05, 0], l: 0.5}", "leg", 9, "robot.legs[3] is 'leg'; a mapping"},
    {"LegIsNull", platform, "{a: [0, 0.1, 0], b: [0, 0.05, 0], l: 0.5}", "~", 6, "robot.legs[3] is empty; a mapping"},
    {"LegLengthZero", platform, "\"500 mm\"", "0", 7, "robot.legs[1].l is '0'; a value > 0 is expected"},
    {"LegDirectionHorizontal", platform, "u: [0, 0, 2]", "u: [1, 0, 0.01]", 7,
     "robot.legs[1].u is (nearly) horizontal"},
    {"LegDirectionZero", platform, "u: [0, 0, 2]", "u: [0, 0, 0]", 7, "robot.legs[1].u has length zero"},
    {"LegKeyMissing", platform, "b: [0.05, 0, 0], ", "", 7, "robot.legs[1] has no key 'b'"},
    {"RadiusZero", platform, "radius: 0.1", "radius: 0", 8, "robot.legs[2].b.radius is '0'; a value > 0"},
    {"RadiusMissing", platform, "radius: 0.1, ", "", 8, "robot.legs[2].b has no key 'radius'"},
    {"PolarKeyUnknown", platform, "angle: 0}", "phi: 0}", 8, "unknown key 'phi'; allowed: radius, angle, z"},
};

const BadFile measurements[] = {
    {"MeasurementKindUnknown", arm, "type: points", "type: crystal_ball", 10,
     "measurement.type is 'crystal_ball'; allowed: pose, points, position, distance, plane, line, inclination, "
     "camera, joints"},
    {"MeasurementKindMissing", arm, "  type: points\n", "", 9, "measurement has no key 'type'"},
    {"TargetsForPose", arm, "type: points", "type: pose", 11,
     "unknown key 'targets'; allowed: type, name, of, in, mount, components, joined, device, repeats, repeatability, "
     "line_of_sight, most, reading, setup, unmodelled, load"},
    {"TargetsForPosition", arm, "type: points", "type: position", 11,
     "unknown key 'targets' (did you mean 'target'?); allowed: type, name, of, in, target,"},
    {"TargetTwice", arm, "    P2:", "    P1:", 13, "duplicate key 'P1'; first given on line 12"},
    {"TargetTooShort", arm, "[0.27649, -0.04825, 0.09405]", "[1, 2]", 13, "P2 has 2 entries; expected 3 numbers"},
    {"TargetNameGlob", arm, "    P2:", "    'P*':", 13, "a plain name is expected"},
    {"ComponentUnknown", arm, "[z, x]", "[z, rx]", 14, "is 'rx'; allowed: x, y, z"},
    {"ComponentTwice", arm, "[z, x]", "[z, z]", 14, "measurement.components[2] is 'z'; it is already in the list"},
    {"ComponentsEmpty", arm, "[z, x]", "[]", 14, "measurement.components is empty; allowed: x, y, z"},
    {"DeviceUnknown", arm, "isotropic", "crystal_ball", 15,
     "is 'crystal_ball'; allowed: isotropic, diagonal, covariance, laser_tracker, photogrammetry"},
    {"DeviceNoiseZero", arm, "\"0.1 mm\"", "0", 15, "measurement.device.noise is '0'; a value > 0 is expected"},
    {"DeviceNoiseMissing", arm, ", noise: \"0.1 mm\"", "", 15, "measurement.device has no key 'noise'"},
    {"PoseNoiseIsALength", platform, "{position: \"0.1 mm\", rotation: \"0.1 mrad\"}", "\"1 mm\"", 16,
     "measurement.device.noise is '1 mm'; a mapping"},
    {"PoseNoiseWithoutRotation", platform, ", rotation: \"0.1 mrad\"", "", 16, "has no key 'rotation'"},
    {"RepeatsZero", arm, "repeats: 3", "repeats: 0", 16, "is '0'; a whole number from 1 to"},
    {"RepeatsFraction", arm, "repeats: 3", "repeats: 2.5", 16, "is '2.5'; a whole number from 1 to"},
    {"RepeatabilityNegative", arm, "\"30 um\"", "-1", 17, "a value >= 0 is expected"},
};

const BadFile rest[] = {
    {"VariantKeyUnknown", arm, "    fixed:", "    fix:", 22,
     "unknown key 'fix'; allowed: parameters, nuisance, fixed, tolerance, nominal"},
    {"VariantIsNull", arm, "    parameters: auto", "", 24, "variants.everything is empty; a mapping"},
    {"ParametersMissing", arm, "    parameters: auto", "    fixed: []", 24, "has no key 'parameters'"},
    {"ParametersEmpty", arm, "[px1, \"joint_2.*\"]", "[]", 20, "is empty; a list of names or one of the words auto"},
    {"ParametersSingle", arm, "auto", "px1", 25,
     "is a single name; a list of names or one of the words auto, dh, mdh is expected"},
    {"ParametersNested", arm, "[px1,", "[[px1],", 20, "variants.geometric.parameters[1] is a list"},
    {"NuisanceIsText", arm, "[\"base.*\"]", "base", 21, "variants.geometric.nuisance is 'base'; a list of names"},
    {"ToleranceZero", arm, "0.001}", "0}", 23, "variants.geometric.tolerance.*.gear is '0'; a value > 0"},
    {"ToleranceInSeconds", arm, "0.5 mm", "0.5 s", 23, "wrong unit 's'; allowed: m, mm, um, nm, rad, mrad, urad, deg"},
    {"TolerancePatternTwice", arm, "\"*.gear\"", "\"*.x\"", 23, "duplicate key '*.x'"},
    {"JointsOfPlatform", platform, "  pose: {", "  joints: {", 21, "unknown key 'joints'; allowed: pose"},
    {"PoseOfArm", arm, "  joints:", "  pose:", 27, "unknown key 'pose'; allowed: joints"},
    {"MarginInMillimetres", arm, "\"5 deg\"", "\"5 mm\"", 28, "wrong unit 'mm'; allowed: rad, mrad, urad, deg"},
    {"MarginNegative", arm, "\"5 deg\"", "-0.1", 28, "a value >= 0 is expected"},
    {"LimitsMixed", arm, "[0, \"3 m\"]", "[\"1 deg\", \"3 m\"]", 30, "both ends need the same unit"},
    {"LimitsEqual", arm, "[-1, 1.5]", "[1, 1]", 30, "workspace.joints.limits.joint_a2 is an empty range"},
    {"PoseIncomplete", platform, "z: [-0.1, 0.1], ", "", 21, "workspace.pose has no key 'z'"},
    {"PoseRangeReversed", platform, "[-0.2, 0.1]", "[0.2, 0.1]", 21, "workspace.pose.ry is an empty range"},
    {"VariantUnknown", arm, "variant: everything", "variant: other", 32,
     "design.variant is 'other'; allowed: geometric, everything"},
    {"CriterionIsAList", arm, "criterion: o3", "criterion: [o3]", 33, "design.criterion is a list"},
    {"PosesZero", arm, "poses: 18", "poses: 0", 35, "design.poses is '0'; a whole number from 1 to"},
    {"PosesText", arm, "poses: 18", "poses: many", 35, "design.poses is 'many'; a whole number from 1 to"},
    {"CandidatesTooMany", arm, "20000", "10000001", 36, "a whole number from 1 to 10000000 is expected"},
    {"CandidatesExponent", arm, "20000", "2e4", 36, "is '2e4'; a whole number"},
    {"RestartsOverflow", arm, "restarts: 7", "restarts: 99999999999", 37,
     "a whole number from 1 to 1000000 is expected"},
    {"RepeatsWord", arm, "repeats: allow", "repeats: yes", 38,
     "design.repeats is 'yes'; allowed: allow, forbid, or how often"},
    {"LineBreakInName", arm, "criterion: o3", "criterion: \"o\\n3\"", 33, "is 'o\\x0a3'; control characters"},
    {"LineBreakInKey", arm, "criterion: o3", "\"o\\n3\": 1", 33, "is 'o\\x0a3'; control characters"},
};

INSTANTIATE_TEST_SUITE_P(Root, BadProblem, testing::ValuesIn(root), test_name);
INSTANTIATE_TEST_SUITE_P(SerialRobot, BadProblem, testing::ValuesIn(serial_robot), test_name);
INSTANTIATE_TEST_SUITE_P(ParallelRobot, BadProblem, testing::ValuesIn(parallel_robot), test_name);
INSTANTIATE_TEST_SUITE_P(Measurement, BadProblem, testing::ValuesIn(measurements), test_name);
INSTANTIATE_TEST_SUITE_P(Rest, BadProblem, testing::ValuesIn(rest), test_name);

const BadFile requirements[] = {
    {"AccuracyWithoutUnit", arm, "restarts: 7", "require: {accuracy: 0.1}", 37, "has no unit; allowed: m, mm, um, nm"},
    {"PositionWithoutUnit", arm, "restarts: 7", "require: {position: {x: 0.1}}", 37, "require.position.x has no unit"},
    {"RotationInMillimetres", arm, "restarts: 7", "require: {rotation: \"1 mm\"}", 37, "wrong unit"},
    {"PositionOfNoAxis", arm, "restarts: 7", "require: {position: {}}", 37, "is empty"},
    {"PositionNegative", arm, "restarts: 7", "require: {position: \"-1 mm\"}", 37, "> 0"},
    {"RequireNothing", arm, "restarts: 7", "require: {}", 37, "is empty; allowed: accuracy, position, rotation, sigma"},
};
INSTANTIATE_TEST_SUITE_P(Require, BadProblem, testing::ValuesIn(requirements), test_name);

TEST(ReadProblem, UnknownKeyNamesLineAndAllowedKeys) {
  try {
    parse_problem(replaced(arm, "candidates: 20000", "candidate: 20000"), "bad.yaml");
    FAIL() << "was accepted";
  } catch (const InputError& error) {
    EXPECT_STREQ(
        error.what(),
        "bad.yaml:36: unknown key 'candidate' (did you mean 'candidates'?); allowed: variant, truth, variants, "
        "criterion, method, poses, "
        "require, candidates, candidates_from, restarts, repeats, minimum_distance, scaling, prior, reserve, robust, "
        "measured, fixed, test_poses");
  }
}

TEST(ReadProblem, MisspeltRequiredKeyIsReportedAsUnknownNotAsMissing) {
  try {
    parse_problem(replaced(arm, "targets:", "target:"), "bad.yaml");
    FAIL() << "was accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("bad.yaml:11: unknown key 'target'"));
  }
}

TEST(ReadProblem, LongAndDeepNonsenseGivesAShortMessage) {
  for (const std::string& text :
       {replaced(arm, "o3", "[" + std::string(5000, 'x') + "]"), replaced(arm, "20000", std::string(100'000, '9')),
        std::string(300'000, '['), std::string(300'000, '{'), "a: " + std::string(300'000, '-')}) {
    try {
      parse_problem(text, "bad.yaml");
      ADD_FAILURE() << "was accepted";
    } catch (const InputError& error) {
      EXPECT_LT(std::string(error.what()).size(), 400U);
    }
  }
}

const BadFile cells[] = {
    {"CoupledWithoutNames", cell, "sum: {j2: 1, j3: -1}", "sum: {}", 10, "is empty"},
    {"CoupledWithoutRange", cell, ", range: [\"-90 deg\", \"60 deg\"]", "", 10, "has no key 'range'"},
    {"ToolLimitsNothing", cell, ", z: [0, \"2 m\"]", "", 11, "has no limits"},
    {"ToolInDegrees", cell, "\"2 m\"", "\"2 deg\"", 11, "wrong unit"},
    {"SingularityNegative", cell, "smallest: 0.05", "smallest: -1", 12, "> 0"},
    {"UncalibratedNegative", cell, "uncalibrated: 3", "uncalibrated: -3", 13, ">= 0"},
    {"ReadableForNegative", cell, "uncalibrated: 3", "readable_for: -1", 13, "0 to 1000"},
    {"SamplerUnknown", cell, "gaussian: 1", "gauss: 1", 14, "unknown key 'gauss'"},
    {"SamplersDrawNothing", cell, "{even: 2, boundary: 1, obstacle_based: 1, gaussian: 1, clearance: 0}", "{even: 0}",
     14, "has no sampler"},
    {"SamplerShareTooLarge", cell, "even: 2", "even: 1e308", 14, "too large"},
    {"SelfIsAWord", cell, "self: true", "self: maybe", 16, "allowed: true, false"},
    {"ClearanceNegative", cell, "clearance: \"20 mm\"", "clearance: -1", 17, ">= 0"},
    {"IgnoreOfThree", cell, "[upper, hand]", "[upper, hand, base]", 21, "3 entries"},
    {"CylinderWithoutLength", cell, ", length: 0.2}", "}", 22, "has no key 'length'"},
    {"BoxOfTwo", cell, "[1, 2, \"50 mm\"]", "[1, 2]", 24, "2 entries"},
    {"PlaneWithoutDirection", cell, "plane: [0, 0, 2]", "plane: [0, 0, 0]", 25, "is zero"},
    {"ShapeUnknown", cell, "plane: [0, 0, 2]", "cone: 1", 25, "unknown key 'cone'"},
    {"ScaleWithoutMesh", cell, "plane: [0, 0, 2]", "plane: [0, 0, 2], scale: 2", 25, "needs a mesh"},
    {"ScaleZero", cell, "scale: 0.001", "scale: 0", 26, "> 0"},
    {"VisibleNone", cell, "visible: 1", "visible: 0", 28, "from 1 to"},
    {"RangeBelowZero", cell, "[\"0.5 m\", 20]", "[-1, 20]", 29, "below zero"},
    {"ElevationTurnedRound", cell, "[\"-60 deg\", \"77 deg\"]", "[1, -1]", 30, "empty range"},
    {"ConeTooWide", cell, "half_angle: \"40 deg\"", "half_angle: \"200 deg\"", 32, "half turn"},
    {"AcceptanceWithoutNormals", cell, "    normals: {P1: [0, 0, 1], \"*\": [1, 0, 0]}\n", "", 33, "needs normals"},
    {"NormalsWithoutAcceptance", cell, "    acceptance: \"30 deg\"\n", "", 33, "need acceptance"},
    {"BeamZero", cell, "beam: \"4 mm\"", "beam: 0", 35, "> 0"},
    {"ReferencesWithoutEvery", cell, "    every: 5\n", "", 27, "one of references, every"},
    {"ChooseTooMany", cell, "choose: 1", "choose: 7", 40, "from 1 to 6"},
    {"PointsWithoutRange", cell, "z: 0.5, points: [3, 2, 1]", "z: 0.5, points: [3, 2, 2]", 41, "is one place"},
    {"PlacesTwice", cell, "choose: 1", "among: {A: [0, 0, 0]}", 41, "cannot be combined with among"},
    {"VelocityInMetres", cell, "\"100 deg/s\"", "\"100 mm\"", 43, "wrong unit"},
    {"VelocityZero", cell, "\"100 deg/s\"", "0", 43, "> 0"},
    {"SpeedMoreThanAll", cell, "speed: 0.5", "speed: 1.5", 46, "more than 1"},
    {"SettleInMetres", cell, "\"5 s\"", "\"5 m\"", 47, "wrong unit"},
    {"ReachableIsANumber", cell, "reachable: true", "reachable: 1", 50, "allowed: true, false"},
};
INSTANTIATE_TEST_SUITE_P(Cell, BadProblem, testing::ValuesIn(cells), test_name);

TEST(GoodProblem, EveryKeyOfACellIsRead) {
  const WorkspaceSpec w = parse_problem(cell, "good.yaml").workspace;
  EXPECT_EQ(w.coupled.front().factors.back().second, -1);
  EXPECT_EQ(w.tool->upper.z(), 2);
  EXPECT_EQ(w.singularity->length, 0.5);
  EXPECT_EQ(w.samplers.size(), 4U);
  EXPECT_EQ(w.collision->obstacles.size(), 3U);
  EXPECT_EQ(w.collision->obstacles.back().name, "obstacle 3");
  EXPECT_EQ(w.collision->obstacles.back().station, "A");
  EXPECT_EQ(std::get<HalfSpaceShape>(w.collision->obstacles[1].shape).normal.z(), 1);
  EXPECT_EQ(w.line_of_sight->visible, 1);
  EXPECT_EQ(w.line_of_sight->every, 5);
  EXPECT_EQ(w.stations->list.size(), 6U);
  EXPECT_EQ(w.stations->list.back().placement.position, Eigen::Vector3d(3, 1, 0.5));
  EXPECT_DOUBLE_EQ(w.motion.station_change, 600);
  EXPECT_TRUE(w.motion.reachable);
}

}  // namespace
}  // namespace posewright
