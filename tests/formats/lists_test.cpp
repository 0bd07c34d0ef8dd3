// Pose lists read by readers of their own (list_readers.cpp), by those of the program and as other tools write them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <numbers>
#include <regex>
#include <sstream>

#include "list_readers.hpp"
#include "posewright/support/error.hpp"
#include "sequences.hpp"
#include "tests/kit/message_of.hpp"

namespace posewright {
namespace {

using Rows = std::vector<std::vector<double>>;
using testing::HasSubstr;

void expect_near(const Rows& found, const Rows& wanted, double limit, const std::string& what) {
  ASSERT_EQ(found.size(), wanted.size()) << what;
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    ASSERT_EQ(found[k].size(), wanted[k].size()) << what;
    for (std::size_t i = 0; i < wanted[k].size(); ++i) EXPECT_NEAR(found[k][i], wanted[k][i], limit) << what;
  }
}

TEST(PoseLists, EveryFormatOfATableHasAReaderHere) {
  const auto readers = readers::list_readers();
  for (const PoseFormat& format : pose_formats())
    EXPECT_EQ(readers.count(format.name) > 0, format.read != nullptr) << format.name;
}

TEST(PoseLists, OtherReadersFindTheValuesOfThePlan) {
  for (const auto& [name, read] : readers::list_readers())
    for (const int joints : {1, 6, 7})
      for (const int poses : {1, 11}) {
        const PoseSequence sequence = random_sequence(joints, poses, std::uint64_t(joints * 100 + poses));
        const std::string text = text_in(name, sequence);
        const readers::List found = read(text, std::size_t(joints));
        expect_near(found.rows, values_of(sequence), 1e-12, name);
        EXPECT_TRUE(found.names.empty() || found.names == sequence.names) << name;
        EXPECT_FALSE(std::regex_search(text, std::regex(R"(-0(\.0*)?(e\+00)?[,\n \]"])"))) << name;
      }
}

/// Cells as SI numbers; texts are SI where the column says nothing else.
Rows numbers_of(const PoseTable& table, const std::vector<std::string>& names) {
  Rows rows;
  for (const PoseRow& row : table.rows) {
    rows.emplace_back();
    for (std::size_t i = 0; i < names.size(); ++i) {
      std::size_t column = i;
      if (!table.names.empty())
        column = std::size_t(std::find(table.names.begin(), table.names.end(), names[i]) - table.names.begin());
      const PoseCell& cell = row.cells.at(column);
      const double value =
          std::holds_alternative<double>(cell) ? std::get<double>(cell) : std::stod(std::get<std::string>(cell));
      const bool degrees = !table.units.empty() && table.units.at(column) == degrees_or_millimetres;
      rows.back().push_back(degrees ? value * (std::numbers::pi / 180) : value);
    }
  }
  return rows;
}

TEST(PoseLists, OwnReadersGiveTheSameNumbersBitForBitInSiAndToTheLastDigitInDegrees) {
  for (const PoseFormat& format : pose_formats()) {
    if (format.read == nullptr) continue;
    for (const int joints : {1, 6, 7})
      for (const PoseSequence& sequence : {random_sequence(joints, 9, 3), random_route(joints, 4, 8)}) {
        const PoseTable table = format.read(text_in(format.name, sequence), "list");
        const Rows found = numbers_of(table, sequence.names);
        const bool degrees = !table.units.empty() && table.units.back() == degrees_or_millimetres;
        expect_near(found, values_of(sequence), degrees ? 1e-15 * 4 : 0.0, format.name);
      }
  }
}

TEST(PoseLists, KeepNamesThatNeedQuotes) {
  PoseSequence sequence = random_sequence(4, 2, 1);
  sequence.names = {"yes", "a, \"b\"", "1.5", "größe <&> x"};
  for (const char* name :
       {"robot-calibration", "figaroh", "moveit", "joint-trajectory", "srdf", "csv", "figaroh-csv", "json"}) {
    const PoseTable table = find_pose_format(name).read(text_in(name, sequence), "list");
    for (const std::string& joint : sequence.names) EXPECT_THAT(table.names, testing::Contains(joint)) << name;
    expect_near(numbers_of(table, sequence.names), values_of(sequence), 0, name);
  }
}

TEST(PoseLists, SlidingJointsAreMillimetresBesideDegreesAndMetresBesideRadians) {
  PoseSequence sequence = random_sequence(2, 1, 1);
  sequence.units[1] = "m";
  sequence.poses[0].values = {0.5, 0.25};
  EXPECT_THAT(text_in("robodk-csv", sequence), HasSubstr(",250\n"));
  EXPECT_THAT(text_in("figaroh", sequence), HasSubstr("- [0.5, 0.25]\n"));
}

TEST(PoseLists, ATrajectoryMovesNoFasterThanTheRouteSays) {
  const PoseSequence planned = random_route(6, 5, 4);
  ExportOptions options;
  options.settle = 1;
  options.wait = 2;
  const YAML::Node root = YAML::Load(find_pose_format("joint-trajectory").write(planned, options).files[0].bytes);
  const auto time = [&](std::size_t i) {
    const YAML::Node t = root["points"][i]["time_from_start"];
    return t["sec"].as<double>() + 1e-9 * t["nanosec"].as<double>();
  };
  const Path path = path_of(planned);
  std::size_t point = 0;  // of the trajectory: home, then via points and poses twice
  EXPECT_DOUBLE_EQ(time(0), 5.0);
  for (const SequenceMotion& motion : planned.motions) {
    const double start = time(point);
    point += motion.points.size() - 1;
    EXPECT_GE(time(point) - start, 1.5 * motion.seconds * (1 - 1e-9)) << "a cubic peaks at 1.5 times its mean speed";
    if (motion.to == 0) continue;
    EXPECT_NEAR(time(point + 1) - time(point), 3.0, 1e-9);
    ++point;
  }
  EXPECT_EQ(root["points"].size(), point + 1);
  EXPECT_EQ(root["points"].size(), path.points.size() + path.measured.size());
}

TEST(PoseLists, ATrajectoryWithoutHoldsIsAListOfPosesAndRepeatedPosesStayTwo) {
  const PoseFormat& format = find_pose_format("joint-trajectory");
  const std::string head = "joint_names: [a]\npoints:\n";
  EXPECT_EQ(format.read(head + "- positions: [1.0]\n- positions: [2.0]\n", "t").rows.size(), 2U);
  PoseSequence sequence = random_sequence(1, 3, 1);
  sequence.poses[1].values = sequence.poses[0].values;
  EXPECT_EQ(format.read(text_in("joint-trajectory", sequence), "t").rows.size(), 3U);
  sequence.poses[1].choices = {{"load_case", "heavy"}};
  EXPECT_THROW(format.write(sequence, {}), CannotDo);
}

TEST(PoseLists, MeasurementCsvSaysThatPositionsArePredictedAndHidesHiddenOnes) {
  const PoseSequence sequence = random_sequence(6, 3, 1);
  const Exported exported = find_pose_format("figaroh-csv").write(sequence, {});
  std::istringstream lines(exported.files[0].bytes);
  std::string header, first, second;
  std::getline(lines, header), std::getline(lines, first), std::getline(lines, second);
  EXPECT_THAT(header, testing::StartsWith("posewright,x1,y1,z1,x2,y2,z2,joint_a1,"));
  EXPECT_THAT(first, testing::StartsWith("predicted,"));
  EXPECT_THAT(second, HasSubstr(",nan,nan,nan,"));
  EXPECT_THAT(exported.notes, testing::Contains(HasSubstr("are predictions; replace them")));
  PoseSequence bare = sequence;
  for (SequencePose& pose : bare.poses) pose.targets.clear();
  EXPECT_THAT(text_in("figaroh-csv", bare), HasSubstr("\nto be measured,nan,nan,nan,"));
}

Eigen::Isometry3d transform_of(const YAML::Node& p, const YAML::Node& q) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() = Eigen::Quaterniond(q["w"].as<double>(), q["x"].as<double>(), q["y"].as<double>(), q["z"].as<double>())
                   .toRotationMatrix();
  X.translation() = Eigen::Vector3d(p["x"].as<double>(), p["y"].as<double>(), p["z"].as<double>());
  return X;
}

TEST(PoseLists, HandEyeSamplesHaveTheRobotAsTheirToolWritesItAndWaitForWhatIsTracked) {
  const PoseSequence sequence = random_sequence(6, 5, 3);
  for (const bool in_hand : {true, false}) {
    const YAML::Node root = YAML::Load(text_in(in_hand ? "easy-handeye2" : "easy-handeye2-on-base", sequence));
    EXPECT_EQ(root["parameters"]["calibration_type"].as<std::string>(), in_hand ? "eye_in_hand" : "eye_on_base");
    EXPECT_EQ(root["parameters"].size(), 9U) << "the fields of HandeyeCalibrationParameters";
    ASSERT_EQ(root["samples"].size(), sequence.poses.size());
    for (std::size_t k = 0; k < sequence.poses.size(); ++k) {
      const YAML::Node sample = root["samples"][k];
      const Eigen::Isometry3d robot = transform_of(sample["robot"]["translation"], sample["robot"]["rotation"]);
      // Of a camera at the base the tool looks up the base in the effector's frame.
      const Eigen::Isometry3d product =
          in_hand ? robot.inverse() * *sequence.poses[k].tool_pose : robot * *sequence.poses[k].tool_pose;
      EXPECT_TRUE(product.isApprox(Eigen::Isometry3d::Identity(), 1e-9)) << k;
      EXPECT_TRUE(std::isnan(sample["tracking"]["translation"]["x"].as<double>()));
      EXPECT_TRUE(std::isnan(sample["tracking"]["rotation"]["w"].as<double>()));
    }
  }
}

TEST(PoseLists, HandEyeDataAreAListAndAFileAPose) {
  const PoseSequence sequence = random_sequence(6, 5, 4);
  const Exported exported = find_pose_format("industrial-calibration-hand-eye").write(sequence, {});
  ASSERT_EQ(exported.files.size(), sequence.poses.size() + 1);
  const YAML::Node list = YAML::Load(exported.files.front().bytes)["data"];
  for (std::size_t k = 0; k < sequence.poses.size(); ++k) {
    const ExportedFile& file = exported.files[k + 1];
    EXPECT_EQ(list[k]["pose"].as<std::string>(), file.name);
    EXPECT_THAT(list[k]["image"].as<std::string>(), testing::StartsWith("images/"));
    const YAML::Node pose = YAML::Load(file.bytes);
    YAML::Node quaternion;
    for (const char* axis : {"x", "y", "z", "w"}) quaternion[axis] = pose[std::string("q") + axis];
    EXPECT_TRUE(transform_of(pose, quaternion).isApprox(*sequence.poses[k].tool_pose, 1e-9));
  }
  PoseSequence bare = sequence;
  bare.poses[2].tool_pose.reset();
  EXPECT_THROW(find_pose_format("industrial-calibration-hand-eye").write(bare, {}), CannotDo);
  EXPECT_THROW(find_pose_format("easy-handeye2").write(bare, {}), CannotDo);
}

TEST(PoseLists, TagPosesAreThoseOfThePlan) {
  const PoseSequence sequence = random_sequence(6, 6, 2);
  const Rows rows = readers::table(text_in("delmia", sequence), '\t', 1, 1);
  const Rows matrices = readers::table(text_in("pybotics-csv", sequence), ',', 1, 0);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    using Eigen::AngleAxisd, Eigen::Vector3d;
    const double r = std::numbers::pi / 180;
    const Eigen::Isometry3d& X = *sequence.poses[k].tool_pose;
    const Eigen::Matrix3d R =
        (AngleAxisd(rows[k][5] * r, Vector3d::UnitZ()) * AngleAxisd(rows[k][4] * r, Vector3d::UnitY()) *
         AngleAxisd(rows[k][3] * r, Vector3d::UnitX()))
            .toRotationMatrix();
    EXPECT_LT((R - X.linear()).norm(), 1e-9);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(rows[k][std::size_t(i)], 1e3 * X.translation()[i], 1e-8);
    for (int i = 0; i < 16; ++i)
      EXPECT_NEAR(matrices[k][std::size_t(6 + i)], X.matrix()(i / 4, i % 4) * (i % 4 == 3 && i < 12 ? 1e3 : 1), 1e-9);
  }
}

TEST(PoseLists, ReadersTakeWhatTheToolsOwnFilesLookLike) {
  const auto rows = [](const char* format, const std::string& text) {
    return find_pose_format(format).read(text, "f").rows.size();
  };
  EXPECT_EQ(rows("robot-calibration",
                 "- joints: [b, a]\n  positions: [1, 2]\n  features: [f]\n- joints:\n  - a\n  - b\n  positions:\n  - "
                 "0.4\n  - 0.5\n"),
            2U);
  EXPECT_EQ(rows("figaroh",
                 "{calibration_joint_names: [arm_1,\n    arm_2], calibration_joint_configurations: [\n    [1.37, "
                 "0.25], [2.3,\n -1.1]]}"),
            2U);
  EXPECT_EQ(rows("moveit", "joint_names:\n  - a\njoint_values:\n  -\n    - 0.10000000000000001\n"), 1U);
  EXPECT_EQ(rows("industrial-calibration",
                 "'1593701755':\n  camera_joints: []\n  pose: {qw: 0.3}\n  target_joints:\n  - -0.52\n  - 0.0002\n"),
            1U);
  EXPECT_EQ(rows("delmia", "Tag\tX\tY\tZ\tR\tP\tY\tJ1\nt1\t1\t2\t3\t4\t5\t6\t7\n"), 1U);
  EXPECT_EQ(rows("delmia", "t1\t1\t2\t3\t4\t5\t6\t7\n"), 1U) << "without a header";
  EXPECT_EQ(rows("srdf",
                 "<robot name=\"r\"><group name=\"g\"/><group_state name=\"s\" group=\"g\"><joint name=\"a\" "
                 "value=\"1\"/></group_state>"
                 "<group_state name=\"open\" group=\"hand\"><joint name=\"f\" value=\"1\"/></group_state></robot>"),
            1U);
  EXPECT_EQ(rows("figaroh-csv", "x1,y1,z1,phix1,shoulder\n0.9,0.3,1.2,-1.1,1.5\n"), 1U);
  // Another order of the joints is the same pose.
  const PoseTable table =
      find_pose_format("robot-calibration")
          .read("- {joints: [b, a], positions: [1, 2]}\n- {joints: [a, b], positions: [2, 1]}\n", "f");
  EXPECT_EQ(table.rows[0].cells, table.rows[1].cells);
}

}  // namespace

TEST(TargetLists, AreOfOneStationAndOfTargetsThatItSees) {
  PoseSequence sequence = random_sequence(6, 2, 1);
  const auto target = [](const char* name, const char* station, double x, bool hidden) {
    return SequenceTarget{name, station, Eigen::Vector3d(x, -0.0, 0.0012344), hidden};
  };
  sequence.poses[0].targets = {target("ball 1", "left", 1, false), target("ball_1", "left", 2, false),
                               target("ball 1", "right", 3, true)};
  sequence.poses[1].targets = {target("ball 1", "left", 4, true), target("ball 1", "right", 5, false)};
  const auto text = [&](const char* format, const char* station) {
    ExportOptions options;
    options.station = station;
    return export_poses(find_pose_format(format), sequence, options).files.at(0).bytes;
  };
  EXPECT_EQ(text("powerinspect", "left"),
            "P1_ball_1\t1000.000\t0.000\t1.234\r\nP1_ball_1_2\t2000.000\t0.000\t1.234\r\n");
  EXPECT_THAT(text("spatial-analyzer", "right"), testing::EndsWith("\r\nright,P2_ball_1,5000.000,0.000,1.234\r\n"));
  EXPECT_EQ(std::ranges::count(text("targets-csv", ""), '\n'), 1 + 3);
  const auto refusal_of = [&](const char* format, const char* station) -> std::string {
    return message_of([&] { text(format, station); }, "none");
  };
  EXPECT_THAT(refusal_of("spatial-analyzer", ""),
              HasSubstr("the plan has 2 stations, a list for spatial-analyzer one"));
  EXPECT_THAT(refusal_of("targets-csv", "top"), HasSubstr("--station 'top'; allowed: left, right"));
  for (SequencePose& pose : sequence.poses) pose.targets.clear();
  EXPECT_THAT(refusal_of("targets-csv", ""), HasSubstr("no pose has a target whose position is predicted"));
}

}  // namespace posewright
