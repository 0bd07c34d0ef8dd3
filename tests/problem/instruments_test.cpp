// Instruments and elastostatics in the problem file: what is read, and one clear line for each kind of nonsense.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "posewright/problem/read_problem.hpp"

namespace posewright {
namespace {

using testing::HasSubstr;

std::string with_measurement(const std::string& measurement) {
  return "posewright: 1\nrobot: {urdf: a.urdf}\nmeasurement: " + measurement + "\nvariants: {v: {parameters: auto}}\n";
}

std::string with_robot(const std::string& robot) {
  return "posewright: 1\nrobot: " + robot +
         "\nmeasurement: {type: pose, device: {type: isotropic, noise: {position: 1, rotation: 1}}}\n"
         "variants: {v: {parameters: auto}}\n";
}

std::string complaint(const std::string& text) {
  try {
    parse_problem(text, "p.yaml");
    return "accepted";
  } catch (const InputError& error) {
    return error.what();
  }
}

struct Bad {
  const char* name;
  const char* measurement;
  const char* message;
};
void PrintTo(const Bad& bad, std::ostream* out) { *out << bad.name; }

class BadInstrument : public testing::TestWithParam<Bad> {};

TEST_P(BadInstrument, GivesOneClearLine) {
  const std::string what = complaint(with_measurement(GetParam().measurement));
  EXPECT_THAT(what, testing::StartsWith("p.yaml:3: "));
  EXPECT_THAT(what, HasSubstr(GetParam().message));
  EXPECT_EQ(what.find('\n'), std::string::npos);
}

constexpr const char* tracker_points = "{type: points, targets: {A: [0, 0, 0]}, device: ";

const Bad bad_instruments[] = {
    {"ListWithoutInstruments", "[]", "is empty; at least one instrument is needed"},
    {"InstrumentWithoutName", "[{type: position, target: [0, 0, 0], device: {type: isotropic, noise: 1}}]",
     "has no key 'name'; it is required"},
    {"InstrumentsOfOneName",
     "[{name: a, type: position, target: [0, 0, 0], device: {type: isotropic, noise: 1}}, {name: a, type: position, "
     "target: [0, 0, 0], device: {type: isotropic, noise: 1}}]",
     "is 'a'; another instrument of the list has this name"},
    {"TogetherWithAnUnknown",
     "[{name: a, type: position, target: [0, 0, 0], device: {type: isotropic, noise: 1}}, {name: c, together: [a, b]}]",
     "is 'b'; instruments before it in the list: a"},
    {"TogetherWithItself",
     "[{name: a, type: position, target: [0, 0, 0], device: {type: isotropic, noise: 1}}, {name: c, together: [a, a]}]",
     "is 'a' once more"},
    {"TogetherAlone",
     "[{name: a, type: position, target: [0, 0, 0], device: {type: isotropic, noise: 1}}, {name: c, together: [a]}]",
     "is of one instrument; two or more"},
    {"TogetherWithAnotherRepeatability",
     "[{name: a, type: position, target: [0, 0, 0], device: {type: isotropic, noise: 1}}, {name: b, type: position, "
     "target: [0, 0, 0], device: {type: isotropic, noise: 1}, repeatability: 1 mm}, {name: c, together: [a, b]}]",
     "has another repeatability than a; one visit has one repeatability"},
    {"TogetherWithOtherRepeats",
     "[{name: a, type: position, target: [0, 0, 0], device: {type: isotropic, noise: 1}}, {name: b, type: position, "
     "target: [0, 0, 0], device: {type: isotropic, noise: 1}, repeats: 3}, {name: c, together: [a, b]}]",
     "has other repeats than a"},
    {"TogetherOfOtherTips",
     "[{name: a, type: position, target: [0, 0, 0], device: {type: isotropic, noise: 1}}, {name: b, type: position, "
     "of: "
     "left, target: [0, 0, 0], device: {type: isotropic, noise: 1}}, {name: c, together: [a, b]}]",
     "does not read the tip that a reads"},
    {"InstrumentNameWithADot", "[{name: a.b, type: position, target: [0, 0, 0], device: {type: isotropic, noise: 1}}]",
     "is 'a.b'; a name without any of . @"},
    {"JointSensorsInAList", "[{name: a, type: joints, device: {type: isotropic, noise: 1 mrad}}]",
     "does not read where the tip is, and stands in a list of instruments; allowed there: pose"},
    {"DistanceBetweenConfigurationsInAList",
     "[{name: a, type: distance, between: configurations, targets: {T: [0, 0, 0]}, device: {type: isotropic, noise: "
     "1}}]",
     "does not read where the tip is"},
    {"LoadDifferenceInAList",
     "[{name: a, type: position, target: [0, 0, 0], load: loaded_minus_unloaded, device: {type: isotropic, noise: 1}}]",
     "is loaded_minus_unloaded in a list of instruments; allowed there: absolute"},
    {"StationsToChooseFromInAList",
     "[{name: a, type: points, targets: {T: [0, 0, 0]}, device: {type: laser_tracker, stations: {A: [1, 0, 0], B: [2, "
     "0, 0]}}}]",
     "has several stations in a list of instruments; one station each"},
    {"UnmodelledBesideNone",
     "[{name: a, type: position, target: [0, 0, 0], unmodelled: 1 mm, device: {type: isotropic, noise: 1}}]",
     "unmodelled of 'a' stands beside no unmodelled of a variant; unmodelled: auto in variants"},
    {"UnmodelledTogether",
     "[{name: a, type: position, target: [0, 0, 0], unmodelled: 1 mm, device: {type: isotropic, noise: 1}}, {name: b, "
     "type: position, target: [0, 0, 0], device: {type: isotropic, noise: 1}}, {name: c, together: [a, b]}]",
     "has an unmodelled effect of its own; instruments that read together have none"},
    {"UnmodelledOfOneInstrument",
     "{type: position, target: [0, 0, 0], unmodelled: 1 mm, device: {type: isotropic, noise: 1}}",
     "is for an instrument of a list"},
    {"JoinedTipsOnTheHand",
     "{type: pose, mount: hand, joined: yes, device: {type: isotropic, noise: {position: 1, rotation: 1}}}",
     "is hand with joined tips; tips have no instrument: fixed"},
    {"NoTargets", "{type: points, targets: {}, device: {type: isotropic, noise: 1}}", "at least one target is needed"},
    {"CovarianceNotSymmetric",
     "{type: position, target: [0, 0, 0], device: {type: covariance, matrix: [[1, 0.5, 0], [0, 1, 0], [0, 0, 1]]}}",
     "is not symmetric; a covariance matrix is needed"},
    {"CovarianceNotPositiveDefinite",
     "{type: position, target: [0, 0, 0], device: {type: covariance, matrix: [[1, 2, 0], [2, 1, 0], [0, 0, 1]]}}",
     "is not positive definite"},
    {"CovarianceWithZeroVariance",
     "{type: position, target: [0, 0, 0], device: {type: covariance, matrix: [[1, 0, 0], [0, 0, 0], [0, 0, 1]]}}",
     "every variance must be > 0"},
    {"CovarianceTooSmall", "{type: pose, device: {type: covariance, matrix: [[1, 0], [0, 1]]}}",
     "6 rows of 6 numbers in SI are expected"},
    {"NoiseZero", "{type: position, target: [0, 0, 0], device: {type: isotropic, noise: 0}}",
     "a value > 0 is expected"},
    {"NoiseInDegrees", "{type: position, target: [0, 0, 0], device: {type: isotropic, noise: 1 deg}}",
     "has the wrong unit 'deg'"},
    {"TrackerWithoutNoiseAlong",
     "{type: points, targets: {A: [0, 0, 0]}, device: {type: laser_tracker, noise: {angle: 5 urad}}}",
     "has no noise along the beam"},
    {"TrackerWithoutNoiseAcross",
     "{type: points, targets: {A: [0, 0, 0]}, device: {type: laser_tracker, noise: {range: 5 um}}}",
     "has no noise across the beam"},
    {"TrackerNoiseNegative",
     "{type: points, targets: {A: [0, 0, 0]}, device: {type: laser_tracker, noise: {range: -5 um}}}",
     "a value >= 0 is expected"},
    {"StationsEmpty", "{type: points, targets: {A: [0, 0, 0]}, device: {type: laser_tracker, stations: {}}}",
     "at least one station is needed"},
    {"StationTwice",
     "{type: points, targets: {A: [0, 0, 0]}, device: {type: laser_tracker, stations: {A: [0, 0, 1], A: [1, 0, 0]}}}",
     "duplicate key 'A'"},
    {"PhotogrammetryOfTwoPoints",
     "{type: pose, device: {type: photogrammetry, noise: 1 um, points: {A: [0, 0, 0], B: [1, 0, 0]}}}",
     "has too few points; at least 3 not in line"},
    {"PhotogrammetryInLine",
     "{type: pose, device: {type: photogrammetry, noise: 1 um, points: {A: [0, 0, 0], B: [1, 0, 0], C: [3, 0, 0]}}}",
     "lie in line; three points not in line fix a pose"},
    {"DistanceWithoutAnchors", "{type: distance, targets: {A: [0, 0, 0]}, device: {type: isotropic, noise: 1 um}}",
     "measurement has no key 'anchors'"},
    {"DistanceBothWays",
     "{type: distance, between: configurations, targets: {A: [0, 0, 0]}, anchors: {B: [1, 0, 0]}, device: {type: "
     "isotropic, noise: 1 um}}",
     "one of anchors, between is allowed"},
    {"DistanceRangeReversed",
     "{type: distance, between: configurations, range: [2, 1], targets: {A: [0, 0, 0]}, device: {type: isotropic, "
     "noise: 1 um}}",
     "is an empty range"},
    {"DistanceBelowZero",
     "{type: distance, between: configurations, range: [-1, 1], targets: {A: [0, 0, 0]}, device: {type: isotropic, "
     "noise: 1 um}}",
     "distances are positive"},
    {"CameraWithoutFocalLength",
     "{type: camera, mount: hand, camera: {focal: [0, 900], centre: [1, 1], size: [9, 9]}, board: {rows: 3, columns: "
     "3, spacing: 1}, device: {type: isotropic, noise: 0.2}}",
     "a value > 0 is expected"},
    {"CameraDistortionTooShort",
     "{type: camera, mount: hand, camera: {focal: [9, 9], centre: [1, 1], size: [9, 9], distortion: [0, 0]}, board: "
     "{rows: 3, columns: 3, spacing: 1}, device: {type: isotropic, noise: 0.2}}",
     "expected 5 numbers k1, k2, p1, p2, k3"},
    {"PlaneWithoutARadius",
     "{type: plane, probe: [0, 0, 0], plane: {point: [0, 0, 0], normal: [0, 0, 1]}, range: [0, 1], device: {type: "
     "isotropic, noise: 1 um}}",
     "measurement.plane has no key 'radius'"},
    {"PlaneWithoutANormal",
     "{type: plane, probe: [0, 0, 0], plane: {point: [0, 0, 0], normal: [0, 0, 0], radius: 1}, range: [0, 1], device: "
     "{type: isotropic, noise: 1 um}}",
     "measurement.plane.normal is zero; a direction is needed"},
    {"LevelThatReachesTheVertical", "{type: inclination, range: 90 deg, device: {type: isotropic, noise: 1 mrad}}",
     "measurement.range reaches the vertical; less than 89 deg is needed"},
    {"LevelOfAnUnknownAxis", "{type: inclination, axes: [w], range: 30 deg, device: {type: isotropic, noise: 1 mrad}}",
     "is 'w'"},
    {"LevelInMillimetres", "{type: inclination, range: 30 deg, device: {type: isotropic, noise: 1 mm}}",
     "has the wrong unit 'mm'"},
    {"CameraOnTheMoon", "{type: camera, mount: moon, camera: {}, board: {}, device: {type: isotropic, noise: 0.2}}",
     "is 'moon'; allowed: hand, fixed"},
    {"BoardIsALine",
     "{type: camera, mount: hand, camera: {focal: [9, 9], centre: [1, 1], size: [9, 9]}, board: {rows: 1, columns: 9, "
     "spacing: 1}, device: {type: isotropic, noise: 0.2}}",
     "at least 2 rows and 2 columns are needed"},
    {"CameraNoiseInMillimetres",
     "{type: camera, mount: hand, camera: {focal: [9, 9], centre: [1, 1], size: [9, 9]}, board: {rows: 3, columns: 3, "
     "spacing: 1}, device: {type: isotropic, noise: 0.2 mm}}",
     "has a unit; a plain number is needed"},
    {"CameraWithRepeatabilityInNobodyKnowsWhat",
     "{type: camera, mount: hand, camera: {focal: [9, 9], centre: [1, 1], size: [9, 9]}, board: {rows: 3, columns: 3, "
     "spacing: 1}, device: {type: isotropic, noise: 0.2}, repeatability: 0.1}",
     "is a plain number beside a noise in pixels; random offset of the robot, with its unit: m, mm, um, nm"},
    {"LineWithoutWidth",
     "{type: line, line: {point: [0, 0, 0], direction: [1, 0, 0], length: 1}, range: [0.1, 0.2], device: {type: "
     "isotropic, noise: 1 um}}",
     "has no key 'width'"},
    {"LineWithoutDirection",
     "{type: line, line: {point: [0, 0, 0], direction: [0, 0, 0], length: 1}, range: [0.1, 0.2], width: 0.1, device: "
     "{type: isotropic, noise: 1 um}}",
     "direction"},
    {"NoSensors", "{type: joints, sensors: [], device: {type: isotropic, noise: 1 mrad}}", "at least one sensor"},
    {"LoadWord", "{type: position, target: [0, 0, 0], load: heavy, device: {type: isotropic, noise: 1 um}}",
     "is 'heavy'; allowed: absolute, loaded_minus_unloaded"},
};
INSTANTIATE_TEST_SUITE_P(All, BadInstrument, testing::ValuesIn(bad_instruments),
                         [](const auto& instance) { return std::string(instance.param.name); });

TEST(Instruments, ALaserTrackerWithoutNoiseHasItsDataSheets) {
  const Problem problem = parse_problem(
      with_measurement(std::string(tracker_points) + "{type: laser_tracker, stations: {A: [3, 0, 1], B: {position: "
                                                     "[0, 3, 1], rpy: [0, 0, 90 deg]}}}}"),
      "p.yaml");
  const auto& points = std::get<PointsMeasurement>(problem.measurement.instrument);
  const auto& noise = std::get<TrackerNoise>(points.noise);
  EXPECT_EQ(noise.range, 2.5e-6);
  EXPECT_EQ(noise.angle, 1.5e-6);
  ASSERT_EQ(points.stations.size(), 2U);
  EXPECT_EQ(points.stations[0].placement.position.x(), 3);
  EXPECT_NEAR(points.stations[1].placement.rpy.z(), 1.5707963, 1e-6);
}

TEST(Instruments, AWrittenDataSheetCountsAsItStands) {
  const Problem problem = parse_problem(
      with_measurement(std::string(tracker_points) +
                       "{type: laser_tracker, noise: {range: 10 um, range_per_m: 0.4 um, angle: 5 urad}}}"),
      "p.yaml");
  const auto& noise = std::get<TrackerNoise>(std::get<PointsMeasurement>(problem.measurement.instrument).noise);
  EXPECT_DOUBLE_EQ(noise.range, 1e-5);
  EXPECT_DOUBLE_EQ(noise.range_per_m, 4e-7);
  EXPECT_DOUBLE_EQ(noise.angle, 5e-6);
  EXPECT_EQ(noise.transverse, 0);
}

TEST(Elastostatic, IsReadFieldByField) {
  const Problem problem = parse_problem(
      with_robot("{urdf: a.urdf, elastostatic: {compliance: {j1: 0.6 urad/Nm}, link_weights: yes, listed: {joint: j2, "
                 "at: [0 deg, -30 deg]}, compensator: {joint: j3, L: 0.2, ax: 0.7, ay: 0.1, stiffness: 7 N/um, "
                 "free_length: 458 mm, joint_stiffness: 3e6}, loads: {none: {}, pull: {force: [0, 0, -2 kN], point: "
                 "[0.1, 0, 0]}, tool: {mass: 100, centre_of_mass: [0, 0, 0.2]}}}}"),
      "p.yaml");
  const ElastostaticSpec& spec = *std::get<SerialArmSpec>(problem.robot).elastostatic;
  EXPECT_DOUBLE_EQ(spec.compliance.front().second.value, 0.6e-6);
  EXPECT_TRUE(spec.link_gravity);
  EXPECT_EQ(spec.listed->at.size(), 2U);
  EXPECT_EQ(spec.listed->at.front(), 0) << "in the order of the file";
  EXPECT_DOUBLE_EQ(spec.compensator->stiffness, 7e6);
  ASSERT_EQ(spec.loads.size(), 3U);
  EXPECT_EQ(spec.loads[1].force.z(), -2000);
  EXPECT_EQ(spec.loads[2].mass, 100);
}

TEST(Elastostatic, NonsenseGivesOneClearLine) {
  const auto robot = [](const std::string& elastostatic) {
    return complaint(with_robot("{urdf: a.urdf, elastostatic: " + elastostatic + "}"));
  };
  EXPECT_THAT(robot("{loads: {}}"), HasSubstr("at least one load case is needed"));
  EXPECT_THAT(robot("{compliance: {}}"), HasSubstr("has no key 'loads'"));
  EXPECT_THAT(robot("{loads: {a: {mass: -3}}}"), HasSubstr("a value >= 0 is expected"));
  EXPECT_THAT(robot("{loads: {a: {force: [0, 0, 3 mm]}}}"), HasSubstr("wrong unit 'mm'"));
  EXPECT_THAT(robot("{compliance: {j1: -1}, loads: {a: {}}}"), HasSubstr("a value >= 0 is expected"));
  EXPECT_THAT(robot("{listed: {joint: j2, at: [1, 1]}, loads: {a: {}}}"), HasSubstr("has a position twice"));
  EXPECT_THAT(robot("{compensator: {joint: j2, L: 0.5, ax: 0.3, ay: 0.4, stiffness: 1, free_length: 1, "
                    "joint_stiffness: 1}, loads: {a: {}}}"),
              HasSubstr("must differ from L²"));
}

TEST(TestPoses, NonsenseGivesOneClearLine) {
  const auto design = [](const std::string& test_poses) {
    return complaint(with_robot("{urdf: a.urdf}") + "design: {test_poses: " + test_poses + "}\n");
  };
  EXPECT_THAT(design("{}"), HasSubstr("needs one of at, random"));
  EXPECT_THAT(design("{at: [[1, 2]], random: 3}"), HasSubstr("needs one of at, random"));
  EXPECT_THAT(design("{at: []}"), HasSubstr("at least one configuration is needed"));
  EXPECT_THAT(design("{at: [[1 kN]]}"), HasSubstr("wrong unit 'kN'"));
  EXPECT_THAT(design("{at: [[1], [2]], weights: [1]}"), HasSubstr("one weight for each configuration is expected"));
  EXPECT_THAT(design("{at: [[1]], weights: [0]}"), HasSubstr("a value > 0 is expected"));
  EXPECT_THAT(design("{random: 0}"), HasSubstr("a whole number from 1"));
}

TEST(ParallelRobots, NonsenseGivesOneClearLine) {
  EXPECT_THAT(complaint(with_robot("{model: delta, base_radius: 0.2, platform_radius: 0.1, arm: -1, forearm: 1, "
                                   "travel: [0, 1], range: {x: [0, 1], y: [0, 1], z: [0, 1]}}")),
              HasSubstr("robot.arm is '-1'; a value > 0 is expected"));
  EXPECT_THAT(complaint(with_robot("{model: five_bar, legs: [], range: {x: [0, 1], y: [0, 1]}}")),
              HasSubstr("exactly 2 legs are expected"));
  EXPECT_THAT(complaint(with_robot("{model: gough, reference: {position: [0, 0, 1]}, actuators: {travel: [0, 1]}, "
                                   "legs: [{a: [0, 0, 0], b: [0, 0, 0], u: [0, 0, 1]}, 2, 3, 4, 5, 6]}")),
              HasSubstr("unknown key 'u'; allowed: a, b, l"));
  EXPECT_THAT(complaint(with_robot("{model: compensator, L: 1, ax: 1, ay: 1, range: [0 mm, 1 mm]}")),
              HasSubstr("wrong unit 'mm'"));
}

}  // namespace
}  // namespace posewright
