#include "posewright/problem/read_problem.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <numbers>

#include "example_files.hpp"
#include "posewright/problem/design_words.hpp"
#include "posewright/support/repeats.hpp"
#include "posewright/support/sha256.hpp"

namespace posewright {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;
using example::replaced;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double degree = std::numbers::pi / 180;

std::vector<std::string> values(const std::vector<Located<std::string>>& texts) {
  std::vector<std::string> result;
  for (const auto& text : texts) result.push_back(text.value);
  return result;
}

Problem parse(const std::string& text) { return parse_problem(text, "folder/problem.yaml"); }

TEST(Sha256, AgreesWithThePublishedDigests) {
  EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_hex(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST(ReadProblem, FileAndHashAreKept) {
  const Problem problem = parse(example::serial);
  EXPECT_EQ(problem.file, "folder/problem.yaml");
  EXPECT_EQ(problem.sha256, sha256_hex(example::serial));
  EXPECT_EQ(problem.at(3).file, "folder/problem.yaml");
}

TEST(ReadProblem, SerialArmIsReadFieldByField) {
  const Problem problem = parse(example::serial);
  EXPECT_EQ(problem.robot_line, 2);
  const auto& arm = std::get<SerialArmSpec>(problem.robot);
  EXPECT_EQ(arm.urdf, "folder/kr270.urdf");
  EXPECT_EQ(arm.line, 3);
  EXPECT_EQ(arm.base->value, "base_link");
  EXPECT_EQ(arm.base->line, 4);
  EXPECT_EQ(arm.tip->value, "flange");
  EXPECT_EQ(arm.tip->line, 5);
  EXPECT_TRUE(arm.placement.position.isApprox(Vector3d(1, 0.02, 0)));
  EXPECT_TRUE(arm.placement.rpy.isApprox(Vector3d(0, 0, 90 * degree)));
  EXPECT_DOUBLE_EQ(arm.encoder_noise, 0.001 * degree);
  ASSERT_EQ(arm.parameter_names.size(), 2U);
  EXPECT_EQ(arm.parameter_names[0].first, "px1");
  EXPECT_EQ(arm.parameter_names[0].second.value, "joint_a2.x");
  EXPECT_EQ(arm.parameter_names[0].second.line, 8);
  EXPECT_EQ(arm.parameter_names[1].first, "py1");
}

TEST(ReadProblem, PointsMeasurementIsReadFieldByField) {
  const MeasurementSpec measurement = parse(example::serial).measurement;
  EXPECT_EQ(measurement.line, 9);
  EXPECT_EQ(measurement.repeats, 3);
  EXPECT_DOUBLE_EQ(measurement.repeatability.translation, 30e-6);
  const auto& points = std::get<PointsMeasurement>(measurement.instrument);
  ASSERT_EQ(points.targets.size(), 2U);
  EXPECT_EQ(points.targets[0].name, "P1");
  EXPECT_EQ(points.targets[0].line, 12);
  EXPECT_TRUE(points.targets[0].position.isApprox(Vector3d(0.27723, -0.04653, -0.09387)));
  EXPECT_EQ(points.targets[1].name, "P2");
  EXPECT_TRUE(points.targets[1].position.isApprox(Vector3d(0.27649, -0.04825, 0.09405)));
  EXPECT_TRUE(std::get<GaussianNoise>(points.noise).covariance.isApprox(1e-8 * Eigen::Matrix3d::Identity()));
  EXPECT_THAT(points.components, ElementsAre(0, 2));
}

TEST(ReadProblem, VariantsKeepTheirOrderAndLines) {
  const std::vector<VariantSpec> variants = parse(example::serial).variants;
  ASSERT_EQ(variants.size(), 2U);
  const VariantSpec& geometric = variants[0];
  EXPECT_EQ(geometric.name, "geometric");
  EXPECT_EQ(geometric.line, 19);
  EXPECT_FALSE(geometric.automatic);
  EXPECT_THAT(values(geometric.parameters), ElementsAre("px1", "joint_2.*"));
  EXPECT_EQ(geometric.parameters[1].line, 20);
  EXPECT_THAT(values(geometric.nuisance), ElementsAre("base.*"));
  EXPECT_THAT(values(geometric.fixed), ElementsAre("base.rz"));
  using Kind = Quantity;
  ASSERT_EQ(geometric.tolerance.size(), 3U);
  EXPECT_EQ(geometric.tolerance[0].pattern.value, "*.x");
  EXPECT_EQ(geometric.tolerance[0].pattern.line, 23);
  EXPECT_EQ(geometric.tolerance[0].quantity, Kind::length);
  EXPECT_DOUBLE_EQ(geometric.tolerance[0].value, 5e-4);
  EXPECT_EQ(geometric.tolerance[1].quantity, Kind::angle);
  EXPECT_DOUBLE_EQ(geometric.tolerance[1].value, 0.05 * degree);
  EXPECT_EQ(geometric.tolerance[2].quantity, Kind::number);
  EXPECT_DOUBLE_EQ(geometric.tolerance[2].value, 0.001);
  EXPECT_EQ(variants[1].name, "everything");
  EXPECT_TRUE(variants[1].automatic);
  EXPECT_TRUE(variants[1].parameters.empty());
}

TEST(ReadProblem, JointWorkspaceIsReadFieldByField) {
  const WorkspaceSpec workspace = parse(example::serial).workspace;
  EXPECT_DOUBLE_EQ(workspace.joint_margin.value(), 5 * degree);
  EXPECT_DOUBLE_EQ(workspace.joint_margin_length.value(), 1e-3);
  ASSERT_EQ(workspace.limits.size(), 3U);
  EXPECT_EQ(workspace.limits[0].name.value, "joint_a1");
  EXPECT_EQ(workspace.limits[0].name.line, 30);
  EXPECT_DOUBLE_EQ(workspace.limits[0].lower, -90 * degree);
  EXPECT_DOUBLE_EQ(workspace.limits[0].upper, 90 * degree);
  EXPECT_EQ(workspace.limits[0].quantity, Quantity::angle);
  EXPECT_EQ(workspace.limits[1].quantity, Quantity::length);
  EXPECT_DOUBLE_EQ(workspace.limits[1].upper, 3);
  EXPECT_EQ(workspace.limits[2].quantity, Quantity::number);
}

TEST(ReadProblem, DesignIsReadFieldByField) {
  const DesignSpec design = parse(example::serial).design;
  EXPECT_EQ(design.line, 31);
  EXPECT_EQ(design.variant->value, "everything");
  EXPECT_EQ(design.variant->line, 32);
  EXPECT_EQ(design.criterion.value, "o3");
  EXPECT_EQ(design.criterion.line, 33);
  EXPECT_EQ(design.method.value, "greedy");
  EXPECT_EQ(design.poses->value, 18);
  EXPECT_EQ(design.poses->line, 35);
  EXPECT_EQ(design.candidates.value, 20000);
  EXPECT_EQ(design.restarts.value, 7);
  EXPECT_EQ(design.repeats, Repeats{Repeats::any_number});
}

TEST(ReadProblem, RequirementsAreReadAxisByAxis) {
  const auto axes_of = [](const char* text) {
    return parse(example::replaced(example::serial, "restarts: 7", std::string("require: ") + text))
        .design.require.axes;
  };
  const auto every = axes_of("{position: 0.1 mm, rotation: 1 mrad}");
  for (std::size_t k = 0; k < 6; ++k) EXPECT_DOUBLE_EQ(*every[k], k < 3 ? 1e-4 : 1e-3);
  const auto some = axes_of("{position: {z: 10 um}, rotation: {x: 1 mrad, y: 2 mrad}}");
  EXPECT_FALSE(some[0] || some[1] || some[5]);
  EXPECT_DOUBLE_EQ(*some[2], 1e-5);
  EXPECT_DOUBLE_EQ(*some[3], 1e-3);
  EXPECT_DOUBLE_EQ(*some[4], 2e-3);
}

TEST(DesignWords, AreReadBackAsTheyAreWritten) {
  for (const Scaling scaling : {Scaling::tolerance, Scaling::norm, Scaling::none})
    EXPECT_EQ(scaling_of(scaling_text(scaling)), scaling);
  for (const int most : {1, 2, 1000000, Repeats::any_number})
    EXPECT_EQ(repeats_of(repeats_text({most})), Repeats{most});
}

TEST(DesignWords, OtherWordsAreNone) {
  for (const char* word : {"", "Norm", "unit"}) EXPECT_EQ(scaling_of(word), std::nullopt) << word;
  for (const char* word : {"", "Allow", "0", "-1", "+2", "2.5", "2 ", "1000001", "99999999999"})
    EXPECT_EQ(repeats_of(word), std::nullopt) << word;
}

TEST(ReadProblem, SixPusIsReadFieldByField) {
  const Problem problem = parse(example::six_pus);
  const auto& robot = std::get<SixLegsSpec>(problem.robot);
  EXPECT_EQ(robot.line, 2);
  EXPECT_TRUE(robot.reference.position.isApprox(Vector3d(0, 0, 0.4837)));
  EXPECT_TRUE(robot.reference.rpy.isApprox(Vector3d(0, 0, 0.01)));
  EXPECT_DOUBLE_EQ(robot.travel_lower, -1.3e-3);
  EXPECT_DOUBLE_EQ(robot.travel_upper, 1.3e-3);
  EXPECT_DOUBLE_EQ(robot.actuator_noise, 1e-6);
  ASSERT_EQ(robot.legs.size(), 6U);
  EXPECT_EQ(robot.legs[0].line, 7);
  EXPECT_EQ(robot.legs[5].line, 12);
  EXPECT_TRUE(robot.legs[0].a.isApprox(Vector3d(0.1, 0, 0)));
  EXPECT_TRUE(robot.legs[0].b.isApprox(Vector3d(0.05, 0, 0)));
  EXPECT_TRUE(robot.legs[0].u.isApprox(Vector3d::UnitZ()));
  EXPECT_DOUBLE_EQ(robot.legs[0].l, 0.5);
  EXPECT_TRUE(robot.legs[1].a.isApprox(Vector3d(0, 0.15, 0.002)));
  EXPECT_TRUE(robot.legs[1].b.isApprox(Vector3d(0.1, 0, 0)));
  EXPECT_TRUE(robot.legs[1].u.isApprox(Vector3d::UnitZ()));

  const auto& pose = std::get<PoseMeasurement>(problem.measurement.instrument);
  EXPECT_DOUBLE_EQ(pose.covariance(0, 0), 1e-8);
  EXPECT_DOUBLE_EQ(pose.covariance(5, 5), 1e-8);
  EXPECT_THAT(pose.components, ElementsAre(0, 5));
}

TEST(ReadProblem, PoseLimitsComeInTheOrderOfThePose) {
  const WorkspaceSpec workspace = parse(example::six_pus).workspace;
  std::vector<std::string> names;
  for (const CoordinateLimits& limits : workspace.limits) names.push_back(limits.name.value);
  EXPECT_THAT(names, ElementsAre("x", "y", "z", "rx", "ry", "rz"));
  EXPECT_DOUBLE_EQ(workspace.limits[0].lower, -2e-3);
  EXPECT_DOUBLE_EQ(workspace.limits[5].upper, 6 * degree);
  EXPECT_EQ(workspace.limits[0].name.line, 21);
  EXPECT_EQ(workspace.limits[0].quantity, Quantity::length);
  EXPECT_EQ(workspace.limits[5].quantity, Quantity::angle);
}

TEST(ReadProblem, LeftOutKeysTakeTheirDefaults) {
  const Problem problem = parse(R"(posewright: 1
robot: {urdf: /robots/arm.urdf}
measurement: {type: position, target: [0, 0, "1 mm"], device: {type: isotropic, noise: [1e-4, "0.2 mm", 3e-4]}}
variants: {all: {parameters: auto}}
)");
  const auto& arm = std::get<SerialArmSpec>(problem.robot);
  EXPECT_EQ(arm.urdf, "/robots/arm.urdf");
  EXPECT_FALSE(arm.base.has_value());
  EXPECT_TRUE(arm.placement.position.isZero());
  EXPECT_EQ(arm.encoder_noise, 0.0);
  const auto& points = std::get<PointsMeasurement>(problem.measurement.instrument);
  ASSERT_EQ(points.targets.size(), 1U);
  EXPECT_EQ(points.targets[0].name, "target");
  EXPECT_TRUE(points.targets[0].position.isApprox(Vector3d(0, 0, 1e-3)));
  EXPECT_TRUE(std::get<GaussianNoise>(points.noise).covariance.diagonal().isApprox(Vector3d(1e-8, 4e-8, 9e-8)));
  EXPECT_THAT(points.components, ElementsAre(0, 1, 2));
  EXPECT_EQ(problem.measurement.repeats, 1);
  EXPECT_TRUE(problem.workspace.limits.empty());
  EXPECT_FALSE(problem.design.variant.has_value());
  EXPECT_FALSE(problem.design.poses.has_value());
  EXPECT_EQ(problem.design.criterion.value, "auto");
  EXPECT_EQ(problem.design.repeats, Repeats{1});
}

TEST(ReadProblem, AnchorsWindowsLineEndsAndByteOrderMarkAreAccepted) {
  const std::string shared = replaced(replaced(example::six_pus, "- {a: [0, 0.1, 0]", "- &leg {a: [0, 0.1, 0]"),
                                      "    - {a: [0, 0.1, 0], b: [0, 0.05, 0], l: 0.5}\n", "    - *leg\n");
  EXPECT_EQ(std::get<SixLegsSpec>(parse(shared).robot).legs[3].a.y(), 0.1);
  std::string windows = "\xEF\xBB\xBF";
  for (const char c : example::serial) windows += c == '\n' ? "\r\n" : std::string(1, c);
  EXPECT_EQ(parse(windows).design.poses->line, 35);
}

TEST(ReadProblem, NumbersOfTheDirectionMayBeHugeOrTiny) {
  const Problem problem = parse(replaced(example::six_pus, "u: [0, 0, 2]", "u: [0, 1e-300, 1e300]"));
  EXPECT_TRUE(std::get<SixLegsSpec>(problem.robot).legs[0].u.isApprox(Vector3d::UnitZ()));
  const Problem tiny = parse(replaced(example::six_pus, "u: [0, 0, 2]", "u: [0, 1e-300, 1e-300]"));
  EXPECT_TRUE(std::get<SixLegsSpec>(tiny.robot).legs[0].u.isApprox(Vector3d(0, 1, 1).normalized()));
}

class ReadProblemFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("posewright_problem_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path write(const std::string& bytes) const {
    const fs::path file = folder_ / "problem.yaml";
    std::ofstream(file, std::ios::binary) << bytes;
    return file;
  }
  static std::string error(const fs::path& file) {
    try {
      read_problem(file);
    } catch (const InputError& e) {
      return e.what();
    }
    return "no error";
  }

  fs::path folder_;
};

TEST_F(ReadProblemFile, GoodFileIsReadAndPathsAreRelativeToIt) {
  const Problem problem = read_problem(write(example::serial));
  EXPECT_EQ(std::get<SerialArmSpec>(problem.robot).urdf, folder_ / "kr270.urdf");
  EXPECT_EQ(problem.sha256, sha256_hex(example::serial));
}

TEST_F(ReadProblemFile, WhatIsNoTextFileIsRefused) {
  EXPECT_THAT(error(folder_ / "absent.yaml"), HasSubstr("absent.yaml: cannot be read: No such file"));
  EXPECT_THAT(error(folder_), HasSubstr("is a folder"));
  EXPECT_THAT(error("/dev/zero"), HasSubstr("is a device"));
  EXPECT_THAT(error(write(std::string(10'000'001, '#'))), HasSubstr("has 10000001 bytes"));
  EXPECT_THAT(error(write(std::string("posewright: 1\n\0\1\2", 17))),
              HasSubstr("problem.yaml:2: byte 0x00 is not text"));
  EXPECT_THAT(error(write("posewright: 1\n# \xFF\n")), HasSubstr("problem.yaml:2: byte 0xff is not text"));
  EXPECT_THAT(error(write("")), HasSubstr("problem.yaml: is empty"));
  EXPECT_THAT(error(write("# nothing\n")), HasSubstr("problem.yaml: is empty"));
}

TEST(ReadProblem, AKeyChangedAgainHasItsLastValueAndTheHashOfThat) {
  const auto changed = [](const KeyEdits& edits) { return parse_problem(example::serial, "problem.yaml", {}, edits); };
  const KeyEdit noise = {"measurement.device.noise", "0.2 mm"}, gear = {"variants.geometric.tolerance.*.gear", "0.002"};
  const Problem once = changed({noise, gear});
  EXPECT_EQ(changed({{noise.key, "0.3 mm"}, gear, noise}).sha256, once.sha256);
  EXPECT_EQ(changed({noise, gear, gear, noise}).changed.size(), 2U);
  EXPECT_NE(changed({{noise.key, "0.3 mm"}, gear}).sha256, once.sha256);

  const std::string limits = "workspace.joints.limits", axis = limits + ".joint_a1";
  const Problem nested = changed({{axis, "[-1, 1]"}, {limits, "{joint_a1: [-2, 2]}"}, {axis, "[-0.5, 0.5]"}});
  EXPECT_EQ(nested.changed.size(), 3U);
  ASSERT_EQ(nested.workspace.limits.size(), 1U);
  EXPECT_EQ(nested.workspace.limits.front().lower, -0.5);
}

// The second road: a file in which a person wrote the values.
TEST(ReadProblem, ChangedKeysAreReadAsIfTheFileHadThem) {
  const KeyEdits changed = {{"measurement.device.noise", "0.2 mm"},
                            {"measurement.targets.P2", "[0.1, 0.2, 0.3]"},
                            {"variants.geometric.tolerance.*.gear", "0.002"},
                            {"variants.geometric.parameters.2", "joint_3.*"},
                            {"workspace.joints.limits.joint_a1", "[-1, 1]"}};
  const Problem found = parse_problem(example::serial, "folder/problem.yaml", {}, changed);
  std::string text = replaced(example::serial, R"(noise: "0.1 mm")", R"(noise: "0.2 mm")");
  text = replaced(text, "[0.27649, -0.04825, 0.09405]", "[0.1, 0.2, 0.3]");
  text = replaced(text, R"("*.gear": 0.001)", R"("*.gear": 0.002)");
  text = replaced(text, R"("joint_2.*")", R"("joint_3.*")");
  text = replaced(text, R"(joint_a1: ["-90 deg", "90 deg"])", "joint_a1: [-1, 1]");
  const Problem written = parse(text);
  const auto& points = std::get<PointsMeasurement>(found.measurement.instrument);
  const auto& expected = std::get<PointsMeasurement>(written.measurement.instrument);
  EXPECT_EQ(std::get<GaussianNoise>(points.noise).covariance, std::get<GaussianNoise>(expected.noise).covariance);
  ASSERT_EQ(points.targets.size(), 2U);
  EXPECT_EQ(points.targets[1].position, expected.targets[1].position);
  EXPECT_EQ(values(found.variants[0].parameters), values(written.variants[0].parameters));
  ASSERT_EQ(found.variants[0].tolerance.size(), 3U);
  EXPECT_EQ(found.variants[0].tolerance[2].value, 0.002);
  ASSERT_EQ(found.workspace.limits.size(), written.workspace.limits.size());
  EXPECT_NE(found.sha256, sha256_hex(example::serial));
  EXPECT_EQ(found.at(-1).file, "--set measurement.device.noise");
}

TEST(ReadProblem, ChangedKeyThatIsWrongIsNamed) {
  const std::vector<std::pair<KeyEdit, std::string>> wrong = {
      {{"measurement.device.noise", "fast"}, "--set: measurement.device.noise"},
      {{"measurement.device.speed", "1"}, "--set measurement.device: unknown key 'speed'"},
      {{"speed", "1"}, "--set: unknown key 'speed'"},
      {{"workspace.collision.speed", "1"}, "--set workspace.collision: unknown key 'speed'"},
      {{"variants.geometric.parameters.9", "a"}, "its entries are 1 to 2"},
      {{"robot.urdf.name", "a"}, "goes through a value that has no keys"},
      {{"", "1"}, "has an empty name"},
      {{"robot.", "1"}, "ends with a point"},
      {{"measurement.targets", "{P1: ["}, "is not valid YAML"}};
  for (const auto& [edit, said] : wrong) {
    try {
      parse_problem(example::serial, "folder/problem.yaml", {}, {edit});
      ADD_FAILURE() << edit.key;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(said)) << edit.key;
    }
  }
}

}  // namespace
}  // namespace posewright
