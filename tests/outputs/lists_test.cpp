// Pose lists: read by parsers of this file, by the program's own readers, and after damage.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tinyxml2.h>
#include <yaml-cpp/yaml.h>

#include <bit>
#include <cstring>
#include <functional>
#include <nlohmann/json.hpp>
#include <numbers>
#include <regex>
#include <sstream>

#include "posewright/outputs/route.hpp"
#include "posewright/outputs/write_plan.hpp"
#include "posewright/support/error.hpp"
#include "sequences.hpp"
#include "tests/kit/mutate.hpp"

namespace posewright {
namespace {

using Rows = std::vector<std::vector<double>>;
using testing::HasSubstr;

struct Read {
  std::vector<std::string> names;  ///< empty where the format has none
  Rows rows;                       ///< rad, m
};

Rows rows_of(const YAML::Node& node) { return node.as<Rows>(); }

/// Cells between separators, numbers only; `skip` cells in front of each line are passed over.
Rows table(const std::string& text, char separator, int lines, std::size_t skip) {
  std::istringstream stream(text);
  Rows rows;
  int number = 0;
  for (std::string line; std::getline(stream, line);) {
    if (number++ < lines) continue;
    std::istringstream cells(line);
    rows.emplace_back();
    std::size_t k = 0;
    for (std::string cell; std::getline(cells, cell, separator);)
      if (k++ >= skip) rows.back().push_back(std::stod(cell));
  }
  return rows;
}

Rows in_radians(Rows rows) {
  for (auto& row : rows)
    for (double& x : row) x *= std::numbers::pi / 180;
  return rows;
}

Rows columns(const Rows& rows, std::size_t from, std::size_t count) {
  Rows result;
  for (const auto& row : rows) result.emplace_back(row.begin() + long(from), row.begin() + long(from + count));
  return result;
}

Read read_npy(const std::string& bytes, std::size_t joints) {
  EXPECT_EQ(bytes.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
  const std::size_t length = static_cast<unsigned char>(bytes[8]) + 256U * static_cast<unsigned char>(bytes[9]);
  EXPECT_EQ((10 + length) % 64, 0U);
  EXPECT_EQ(bytes[9 + length], '\n');
  const std::string header = bytes.substr(10, length);
  EXPECT_THAT(header, HasSubstr("'descr': '<f8', 'fortran_order': False, 'shape': ("));
  Read read;
  for (std::size_t at = 10 + length; at < bytes.size(); at += 8 * joints) {
    read.rows.emplace_back(joints);
    std::memcpy(read.rows.back().data(), bytes.data() + at, 8 * joints);
  }
  EXPECT_THAT(header, HasSubstr("(" + std::to_string(read.rows.size()) + ", " + std::to_string(joints) + ")"));
  return read;
}

/// A reader for each format, from its description.
std::map<std::string, std::function<Read(const std::string&, std::size_t)>> independent_readers() {
  std::map<std::string, std::function<Read(const std::string&, std::size_t)>> r;
  r["robot-calibration"] = [](const std::string& text, std::size_t) {
    Read read;
    for (const YAML::Node& item : YAML::Load(text)) {
      read.names = item["joints"].as<std::vector<std::string>>();
      read.rows.push_back(item["positions"].as<std::vector<double>>());
    }
    return read;
  };
  r["figaroh"] = [](const std::string& text, std::size_t) {
    const YAML::Node root = YAML::Load(text);
    EXPECT_EQ(root.size(), 2U) << "exactly two keys";
    return Read{root["calibration_joint_names"].as<std::vector<std::string>>(),
                rows_of(root["calibration_joint_configurations"])};
  };
  r["moveit"] = [](const std::string& text, std::size_t) {
    const YAML::Node root = YAML::Load(text);
    return Read{root["joint_names"].as<std::vector<std::string>>(), rows_of(root["joint_values"])};
  };
  r["caljob"] = [](const std::string& text, std::size_t) {
    Read read;
    for (const YAML::Node& item : YAML::Load(text)["poses"])
      read.rows.push_back(item["joint_values"].as<std::vector<double>>());
    return read;
  };
  r["industrial-calibration"] = [](const std::string& text, std::size_t) {
    Read read;
    for (const auto& item : YAML::Load(text)) {
      EXPECT_TRUE(std::isnan(item.second["pose"]["qw"].as<double>()));
      EXPECT_EQ(item.second["camera_joints"].size(), 0U);
      read.rows.push_back(item.second["target_joints"].as<std::vector<double>>());
    }
    return read;
  };
  r["joint-trajectory"] = [](const std::string& text, std::size_t) {
    Read read;
    double time = 0;
    std::vector<double> before;
    for (const YAML::Node& point : YAML::Load(text)["points"]) {
      const double now =
          point["time_from_start"]["sec"].as<double>() + 1e-9 * point["time_from_start"]["nanosec"].as<double>();
      EXPECT_GT(now, time) << "time must rise";
      time = now;
      for (const double v : point["velocities"].as<std::vector<double>>()) EXPECT_EQ(v, 0);
      const auto q = point["positions"].as<std::vector<double>>();
      if (q == before) read.rows.push_back(q);
      before = q;
    }
    read.names = YAML::Load(text)["joint_names"].as<std::vector<std::string>>();
    return read;
  };
  r["srdf"] = [](const std::string& text, std::size_t) {
    tinyxml2::XMLDocument document;
    EXPECT_EQ(document.Parse(text.c_str()), tinyxml2::XML_SUCCESS);
    Read read;
    for (const auto* s = document.RootElement()->FirstChildElement("group_state"); s != nullptr;
         s = s->NextSiblingElement()) {
      EXPECT_STREQ(s->Attribute("group"), "manipulator");
      read.names.clear();
      read.rows.emplace_back();
      for (const auto* j = s->FirstChildElement("joint"); j != nullptr; j = j->NextSiblingElement()) {
        read.names.emplace_back(j->Attribute("name"));
        read.rows.back().push_back(std::stod(j->Attribute("value")));
      }
    }
    return read;
  };
  r["pybotics-npy"] = read_npy;
  r["pybotics-csv"] = [](const std::string& text, std::size_t n) {
    return Read{{}, in_radians(columns(table(text, ',', 1, 0), 0, n))};
  };
  r["delmia"] = [](const std::string& text, std::size_t n) {
    return Read{{}, in_radians(columns(table(text, '\t', 1, 1), 6, n))};
  };
  r["robodk-csv"] = [](const std::string& text, std::size_t) { return Read{{}, in_radians(table(text, ',', 1, 0))}; };
  r["lt-irb120"] = [](const std::string& text, std::size_t) { return Read{{}, in_radians(table(text, ' ', 0, 0))}; };
  r["mukca"] = [](const std::string& text, std::size_t) { return Read{{}, table(text, ',', 0, 0)}; };
  r["csv"] = [](const std::string& text, std::size_t) { return Read{{}, table(text, ',', 1, 1)}; };
  r["figaroh-csv"] = [](const std::string& text, std::size_t n) {
    return Read{{}, columns(table(text, ',', 1, 1), 6, n)};
  };
  r["json"] = [](const std::string& text, std::size_t) {
    const auto json = nlohmann::json::parse(text);
    Read read{json["names"], {}};
    for (const auto& pose : json["poses"]) read.rows.push_back(pose["values"]);
    return read;
  };
  return r;
}

Rows values_of(const PoseSequence& sequence) {
  Rows rows;
  for (const SequencePose& pose : sequence.poses) rows.push_back(pose.values);
  return rows;
}

std::string text_in(const std::string& format, const PoseSequence& sequence) {
  return find_pose_format(format).write(sequence, {}).files.at(0).bytes;
}

void expect_near(const Rows& found, const Rows& wanted, double limit, const std::string& what) {
  ASSERT_EQ(found.size(), wanted.size()) << what;
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    ASSERT_EQ(found[k].size(), wanted[k].size()) << what;
    for (std::size_t i = 0; i < wanted[k].size(); ++i) EXPECT_NEAR(found[k][i], wanted[k][i], limit) << what;
  }
}

TEST(PoseLists, EveryFormatOfATableHasAReaderHere) {
  const auto readers = independent_readers();
  for (const PoseFormat& format : pose_formats())
    EXPECT_EQ(readers.count(format.name) > 0, format.read != nullptr) << format.name;
}

TEST(PoseLists, OtherReadersFindTheValuesOfThePlan) {
  for (const auto& [name, read] : independent_readers())
    for (const int joints : {1, 6, 7})
      for (const int poses : {1, 11}) {
        const PoseSequence sequence = random_sequence(joints, poses, std::uint64_t(joints * 100 + poses));
        const std::string text = text_in(name, sequence);
        const Read found = read(text, std::size_t(joints));
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
  const PoseSequence route = random_route(6, 5, 4);
  ExportOptions options;
  options.settle = 1;
  options.wait = 2;
  const YAML::Node root = YAML::Load(find_pose_format("joint-trajectory").write(route, options).files[0].bytes);
  const auto time = [&](std::size_t i) {
    const YAML::Node t = root["points"][i]["time_from_start"];
    return t["sec"].as<double>() + 1e-9 * t["nanosec"].as<double>();
  };
  const Path path = path_of(route);
  std::size_t point = 0;  // of the trajectory: home, then via points and poses twice
  EXPECT_DOUBLE_EQ(time(0), 5.0);
  for (const SequenceMotion& motion : route.motions) {
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
  sequence.poses[1].load_case = "heavy";
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
  EXPECT_THAT(exported.notes, testing::Contains(HasSubstr("predictions to be replaced")));
  PoseSequence bare = sequence;
  for (SequencePose& pose : bare.poses) pose.targets.clear();
  EXPECT_THAT(text_in("figaroh-csv", bare), HasSubstr("\nto be measured,nan,nan,nan,"));
}

TEST(PoseLists, TagPosesAreThoseOfThePlan) {
  const PoseSequence sequence = random_sequence(6, 6, 2);
  const Rows rows = table(text_in("delmia", sequence), '\t', 1, 1);
  const Rows matrices = table(text_in("pybotics-csv", sequence), ',', 1, 0);
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
  EXPECT_EQ(rows("caljob",
                 "reference_frame: base\nscenes:\n-\n     scene_id: 0\n     joint_values:\n        - 0.27\n     "
                 "observations:\n     -\n          camera: c\n"),
            1U);
  EXPECT_EQ(rows("delmia", "Tag\tX\tY\tZ\tR\tP\tY\tJ1\nt1\t1\t2\t3\t4\t5\t6\t7\n"), 1U);
  EXPECT_EQ(rows("delmia", "t1\t1\t2\t3\t4\t5\t6\t7\n"), 1U) << "without a header";
  EXPECT_EQ(rows("srdf",
                 "<robot name=\"r\"><group name=\"g\"/><group_state name=\"s\" group=\"g\"><joint name=\"a\" "
                 "value=\"1\"/></group_state>"
                 "<group_state name=\"open\" group=\"hand\"><joint name=\"f\" value=\"1\"/></group_state></robot>"),
            1U);
  EXPECT_EQ(rows("lt-irb120", "7.146259286060064220e+00 -8.351622121791540954e-01 4.491617826092437582e+01\n"), 1U);
  EXPECT_EQ(rows("figaroh-csv", "x1,y1,z1,phix1,shoulder\n0.9,0.3,1.2,-1.1,1.5\n"), 1U);
  // Another order of the joints is the same pose.
  const PoseTable table =
      find_pose_format("robot-calibration")
          .read("- {joints: [b, a], positions: [1, 2]}\n- {joints: [a, b], positions: [2, 1]}\n", "f");
  EXPECT_EQ(table.rows[0].cells, table.rows[1].cells);
}

struct Bad {
  const char* format;
  std::string text, message;
};

TEST(PoseLists, BadListsNameTheLineAndWhatIsAllowed) {
  for (const Bad& bad : std::vector<Bad>{
           {"robot-calibration", "- joints: [a, b]\n  positions: [1]\n",
            "f:2: positions has 1 numbers; 2 joints are named"},
           {"robot-calibration", "- joints: [a]\n  positions: [1]\n- joints: [c]\n  positions: [1]\n",
            "f:3: has other joints"},
           {"robot-calibration", "a: 1\n", "f:1: the file is no list"},
           {"robot-calibration", "", "the file is no list"},
           {"figaroh", "calibration_joint_names: [a]\n", "f:1: has no 'calibration_joint_configurations'"},
           {"moveit", "joint_names: [a]\njoint_values: [[x]]\n", "f:2: joint_values: 'x' is no number"},
           {"moveit", "joint_names: [a]\njoint_values: [[.nan]]\n", "is no number; a finite number"},
           {"caljob", "poses:\n- {joint_values: []}\n", "f:2: joint_values is no list"},
           {"industrial-calibration", "a: {camera_joints: [], target_joints: []}\n",
            "joints of both camera and target, or of none"},
           {"joint-trajectory", "joint_names: [a]\npoints: [{positions: [1, 2]}]\n",
            "f:2: positions has 2 numbers; 1 joints"},
           {"srdf",
            "<robot><group_state name=\"a\" group=\"g\"><joint name=\"a\" value=\"1,5\"/></group_state></robot>",
            "f:1: joint without"},
           {"srdf", "<robot name=\"a\"/>", "has no <group_state>"},
           {"srdf", "<robot", "is no valid XML"},
           {"pybotics-npy", "abc", "is no .npy array"},
           {"pybotics-csv", "1,2,3\n", "f:1: has 3 numbers; joints, then the 16 numbers of a pose"},
           {"delmia", "t\t1\t2\n", "f:1: has 2 numbers; tag, X, Y, Z"},
           {"robodk-csv", "J1,J2\n1,2\n1\n", "f:3: has 1 numbers; the rows before have 2"},
           {"mukca", "1,2\n1,a\n", "f:2: 'a' is no number"},
           {"lt-irb120", "\n", "f: has no poses"},
           {"csv", "a,b\n1\n", "f:2: has 1 cells; the header has 2"},
           {"json", "{\"schema\": \"posewright/plan/9\", \"poses\": []}",
            "has schema 'posewright/plan/9'; allowed: posewright/plan/1"},
           {"json", "[", "is no plan"},
       }) {
    try {
      find_pose_format(bad.format).read(bad.text, "f");
      ADD_FAILURE() << "accepted: " << bad.text;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(bad.message)) << bad.format;
    }
  }
  EXPECT_THROW(find_pose_format("excel"), InputError);
  EXPECT_THROW(find_readable_format("kuka-krl"), InputError);
}

TEST(PoseSequence, ReadsPlansAndRoutesAsTheyAreWritten) {
  Plan plan;
  Route route;
  const PoseSequence wanted = random_route(6, 4, 9);
  for (const SequencePose& pose : wanted.poses) {
    PlannedPose planned;
    planned.id = pose.id;
    for (std::size_t i = 0; i < 6; ++i) planned.configuration.push_back({wanted.names[i], "rad", pose.values[i]});
    planned.load_case = "heavy";
    planned.station = "Süd";
    planned.tool_pose = pose.tool_pose;
    for (const SequenceTarget& target : pose.targets) {
      TargetSight sight;
      sight.target = target.name;
      sight.station = target.station;
      sight.position = target.position;
      sight.hidden_by = target.hidden ? "table" : "";
      planned.sights.push_back(sight);
    }
    plan.poses.push_back(planned);
    route.poses.push_back(planned);
  }
  plan.poses[1].measured = true;
  route.names = wanted.names;
  route.units = wanted.units;
  route.home = wanted.home;
  route.closed = route.from_home = true;
  route.settle = 2.5;
  for (const SequenceMotion& motion : wanted.motions)
    route.motions.push_back({motion.from, motion.to, motion.points, motion.seconds, 0, "straight"});
  TargetSight reference;
  reference.target = "R1";
  route.references.push_back({2, {reference}});
  for (const PoseSequence& found :
       {parse_sequence(plan_json(plan), "plan.json"), parse_sequence(route_json(route), "route.json")}) {
    EXPECT_EQ(found.names, wanted.names);
    EXPECT_EQ(values_of(found), values_of(wanted));
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_EQ(found.poses[k].id, wanted.poses[k].id);
      EXPECT_EQ(found.poses[k].station, "Süd");
      EXPECT_LT((found.poses[k].tool_pose->matrix() - wanted.poses[k].tool_pose->matrix()).norm(), 1e-14);
      EXPECT_EQ(found.poses[k].targets[1].hidden, wanted.poses[k].targets[1].hidden);
      EXPECT_EQ(found.poses[k].measured, !found.is_route && k == 1);
    }
  }
  const PoseSequence found = parse_sequence(route_json(route), "route.json");
  EXPECT_TRUE(found.is_route && found.closed && found.from_home);
  EXPECT_DOUBLE_EQ(found.settle, 2.5);
  for (std::size_t k = 0; k < wanted.motions.size(); ++k) EXPECT_EQ(found.motions[k].points, wanted.motions[k].points);
  for (const SequencePose& pose : found.poses) EXPECT_EQ(pose.references.size(), pose.id == 2 ? 1U : 0U);
  // A list as poses.csv has it.
  EXPECT_EQ(text_in("csv", parse_sequence(plan_json(plan), "plan.json")), poses_csv(plan));
  // A route whose motions were edited is not followed.
  route.motions[1].points.back()[0] += 0.1;
  EXPECT_THROW(parse_sequence(route_json(route), "route.json"), InputError);
  EXPECT_THROW(parse_sequence("{\"schema\": \"posewright/plan/1\", \"poses\": [{\"id\": 1}]}", "blocks.json"),
               InputError);
}

int case_count() {
  const char* text = std::getenv("POSEWRIGHT_FUZZ_CASES");
  return text == nullptr ? 2000 : std::atoi(text);
}

template <class Parse>
void sweep(const std::string& name, const std::string& good, const Parse& parse) {
  int accepted = 0;
  for (int i = 0; i < case_count(); ++i) {
    Random random(17, std::uint64_t(i));
    const std::string text = mutated(good, random);
    try {
      parse(text);
      ++accepted;
    } catch (const InputError& error) {
      const std::string what = error.what();
      ASSERT_TRUE(what.starts_with("fuzz")) << name << ": " << what << "\ncase " << i;
      ASSERT_EQ(what.find('\n'), what.npos) << name << ": " << what << "\ncase " << i;
      ASSERT_LE(error.place().line, std::count(text.begin(), text.end(), '\n') + 1) << name << ": " << what;
    } catch (const std::exception& error) {
      FAIL() << name << " case " << i << ": " << error.what() << "\n" << text;
    }
  }
  EXPECT_GT(accepted, 0) << name;
  EXPECT_LT(accepted, case_count()) << name;
}

TEST(FuzzPoseLists, MutatedListsAreReadOrGiveOneLineThatStartsWithTheFile) {
  for (const PoseFormat& format : pose_formats())
    if (format.read != nullptr)
      sweep(format.name, text_in(format.name, random_sequence(3, 4, 1)), [&](const std::string& text) {
        for (const PoseRow& row : format.read(text, "fuzz").rows) ASSERT_FALSE(row.cells.empty());
      });
}

TEST(FuzzPoseLists, MutatedRoutesPlansAndSettingsAreReadOrGiveOneLineThatStartsWithTheFile) {
  Plan plan;
  Route route;
  const PoseSequence sequence = random_route(3, 3, 2);
  for (const SequencePose& pose : sequence.poses) {
    PlannedPose planned;
    planned.id = pose.id;
    planned.tool_pose = pose.tool_pose;
    for (std::size_t i = 0; i < 3; ++i) planned.configuration.push_back({sequence.names[i], "rad", pose.values[i]});
    plan.poses.push_back(planned);
    route.poses.push_back(planned);
  }
  route.names = sequence.names;
  route.units = sequence.units;
  route.home = sequence.home;
  route.closed = route.from_home = true;
  for (const SequenceMotion& m : sequence.motions)
    route.motions.push_back({m.from, m.to, m.points, m.seconds, 0, "straight"});
  for (const std::string& text : {plan_json(plan), route_json(route)})
    sweep("sequence", text, [](const std::string& mutant) {
      const PoseSequence read = parse_sequence(mutant, "fuzz.json");
      ExportOptions options;
      options.coupling = 1;
      for (const char* name : {"csv", "joint-trajectory", "json"}) try {
          find_pose_format(name).write(read, options);
        } catch (const CannotDo&) {
        }
    });
  sweep("settings",
        "sign: [1, -1, 1]\nzero_deg: [0, 90.5, -90]\npulses_per_degree: [1, 2, 3]\ncoupling: 1\naxes: [A1, "
        "A2]\ndecimals: 5\npivot_mm: [1, 2, 3]\n",
        [](const std::string& text) { parse_controller_settings(text, "fuzz.yaml"); });
}

}  // namespace
}  // namespace posewright
