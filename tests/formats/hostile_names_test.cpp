// Names come from files of others: none of them may become a line, an instruction or the end of a text in a program.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <regex>
#include <set>
#include <sstream>

#include "posewright/formats/pose_formats.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/json.hpp"
#include "posewright/support/text.hpp"

namespace posewright {
namespace {

using nlohmann::json;

const std::vector<std::string> hostile = {"A\nHALT",
                                          "A\r\nPTP HOME",
                                          "A\"; Stop; \"",
                                          "A'); movej([0,0,0,0,0,0])",
                                          "A;FOLD",
                                          "A!x",
                                          "A // x",
                                          "A # x",
                                          "A*/",
                                          "A]]><x>",
                                          "A-->",
                                          "&ACCESS",
                                          "END",
                                          "ENDPROC",
                                          "/END",
                                          "NOP",
                                          "end",
                                          "]]>",
                                          "{A}",
                                          "A\\",
                                          "A\tB",
                                          "A\x01",
                                          "\u00e4",
                                          "A,B",
                                          "a: b",
                                          "- a",
                                          "null",
                                          "true",
                                          "1e3",
                                          "~",
                                          "%s{}",
                                          "A\u2028B",
                                          "'",
                                          "''",
                                          "\"\""};

/// Two poses at two stations, under two loads, with reference targets; every label is `label` and a number.
PoseSequence labelled(const std::string& label) {
  json written = {{"schema", "posewright/plan/1"}};
  for (const int id : {1, 2}) {
    json pose = {{"id", id},
                 {"names", {"joint_1", "joint_2", "joint_3", "joint_4", "joint_5", "joint_6"}},
                 {"units", {"rad", "rad", "rad", "rad", "rad", "rad"}},
                 {"configuration", {0.1 * id, -0.2, 0.3, -0.4, 0.5, -0.6}}};
    written["poses"].push_back(pose);
  }
  PoseSequence sequence = parse_sequence(written.dump(), "p.json");
  for (SequencePose& pose : sequence.poses) {
    // Reading refuses control characters; writers do not rely on it.
    pose.choices = {{"load_case", label + std::to_string(pose.id + 2)}, {"station", label + std::to_string(pose.id)}};
    pose.references = {label + "5"};
    pose.tool_pose = Eigen::Isometry3d::Identity();
  }
  return sequence;
}

ExportOptions options_for(const PoseFormat& format) {
  ExportOptions options;
  if (format.name == "abb-rapid" || format.name == "fanuc-tp") options.coupling = 0;
  if (format.name == "yaskawa-inform")
    options.controller = parse_controller_settings(
        "sign: [1, 1, 1, 1, 1, 1]\nzero_deg: [0, 0, 0, 0, 0, 0]\npulses_per_degree: [1e3, 1e3, 1e3, 1e3, 1e3, 1e3]\n"
        "coupling: 0\n",
        "r.yaml");
  return options;
}

std::vector<std::string> lines_of(const std::string& bytes) {
  std::vector<std::string> lines;
  std::istringstream stream(bytes);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// What stands in `line` where `plain` has the label; fails if the rest differs.
std::string middle_of(const std::string& line, const std::string& plain, const std::string& label) {
  const std::size_t at = plain.find(label), after = plain.size() - at - label.size();
  EXPECT_NE(at, plain.npos) << plain << "\n" << line;
  if (at == plain.npos || line.size() < at + after) return {};
  EXPECT_EQ(line.substr(0, at), plain.substr(0, at));
  return line.substr(at, line.size() - at - after);
}

TEST(HostileNames, StayInTheCommentOrMessageThatNamesThem) {
  int differing = 0;
  for (const PoseFormat& format : pose_formats()) {
    if (!format.controller || format.name == "hexapod-gcs") continue;
    const Exported plain = export_poses(format, labelled("LABEL"), options_for(format));
    for (const std::string& label : hostile) {
      const Exported exported = export_poses(format, labelled(label), options_for(format));
      ASSERT_EQ(exported.files.size(), plain.files.size());
      for (std::size_t f = 0; f < plain.files.size(); ++f) {
        const auto lines = lines_of(exported.files[f].bytes), usual = lines_of(plain.files[f].bytes);
        ASSERT_EQ(lines.size(), usual.size()) << format.name << " " << label;
        for (std::size_t i = 0; i < lines.size(); ++i) {
          if (lines[i] == usual[i]) continue;
          ++differing;
          const std::string middle = middle_of(lines[i], usual[i], "LABEL");
          for (const char c : middle)
            EXPECT_TRUE(c >= ' ' && c <= '~' && std::string("\";\\[]").find(c) == std::string::npos)
                << format.name << ": " << lines[i];
        }
      }
    }
  }
  EXPECT_GT(differing, 500);
}

TEST(HostileNames, ComeBackFromListsAsTheyWere) {
  for (const std::string& label : hostile) {
    if (has_control_character(label)) continue;  // no plan has such names: its reader refuses them
    const PoseSequence sequence = labelled(label);
    for (const PoseFormat& format : pose_formats()) {
      if (format.read == nullptr || format.moves_robot()) continue;
      PoseTable table;
      try {
        const Exported exported = export_poses(format, sequence, {});
        table = format.read(exported.files.front().bytes, "list");
      } catch (const CannotDo&) {
        continue;  // formats without a place for stations may refuse
      }
      ASSERT_EQ(table.rows.size(), 2U) << format.name << " " << label;
      const auto column = std::find(table.names.begin(), table.names.end(), "station");
      if (column == table.names.end()) continue;
      const PoseCell& cell = table.rows[0].cells[std::size_t(column - table.names.begin())];
      EXPECT_EQ(std::get<std::string>(cell), label_of(sequence.poses[0].choices, "station")) << format.name;
    }
  }
}

TEST(HostileNames, OfTargetsAreOneFieldOfTheirList) {
  const std::regex comment("// [ -~]*"), point("[\\w-]+,P[12]_[\\w-]*(,-?[0-9]+\\.[0-9]{3}){3}"),
      guided("P[12]_[\\w-]*(\t-?[0-9]+\\.[0-9]{3}){3}");
  for (const std::string& label : hostile) {
    PoseSequence sequence = labelled(label);
    for (SequencePose& pose : sequence.poses)
      pose.targets = {{label, label, {1, 2, 3}, false}, {label + "2", label, {1, 2, 4}, false}};
    for (const char* format : {"spatial-analyzer", "powerinspect"}) {
      std::set<std::string> names;
      int points = 0;
      for (std::string line : lines_of(export_poses(find_pose_format(format), sequence, {}).files.front().bytes)) {
        ASSERT_EQ(line.back(), '\r');
        line.pop_back();
        if (std::regex_match(line, comment)) continue;
        ++points;
        EXPECT_TRUE(std::regex_match(line, std::string(format) == "powerinspect" ? guided : point)) << line;
        names.insert(line.substr(
            0, line.find_first_of(",\t", line.find("P1_") != line.npos ? line.find("P1_") : line.find("P2_"))));
      }
      EXPECT_EQ(points, 4);
      EXPECT_EQ(names.size(), 4U) << label;
    }
  }
}

TEST(HostileNames, OfProgramsAreRefused) {
  for (const PoseFormat& format : pose_formats()) {
    if (!format.controller || std::find(format.options.begin(), format.options.end(), "name") == format.options.end())
      continue;
    for (const std::string& name : hostile) {
      if (std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isalpha(c) != 0; })) continue;
      ExportOptions options = options_for(format);
      options.name = name;
      EXPECT_THROW(export_poses(format, labelled("A"), options), InputError) << format.name << " " << name;
    }
  }
}

TEST(HostileNames, OfJointsAreTextInYamlAndXml) {
  for (const std::string& name : hostile) {
    PoseSequence sequence = labelled("A");
    sequence.names[2] = name;
    for (SequencePose& pose : sequence.poses) pose.choices.clear();
    for (const char* format :
         {"joint-trajectory", "moveit", "robot-calibration", "figaroh", "industrial-calibration"}) {
      const Exported exported = export_poses(find_pose_format(format), sequence, {});
      const YAML::Node root = YAML::Load(exported.files.front().bytes);
      if (std::string(format) == "joint-trajectory") {
        EXPECT_EQ(root["joint_names"][2].as<std::string>(), name);
      }
      std::function<bool(const YAML::Node&)> has = [&](const YAML::Node& node) {
        if (node.IsScalar()) return node.Scalar() == name;
        for (const auto& item : node)
          if (node.IsMap() ? has(item.first) || has(item.second) : has(item)) return true;
        return false;
      };
      EXPECT_TRUE(std::string(format) == "industrial-calibration" || has(root)) << format << " " << name;
    }
  }
}

}  // namespace
}  // namespace posewright
