#include "list_readers.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tinyxml2.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

namespace posewright::readers {
namespace {

using Rows = std::vector<std::vector<double>>;
using testing::HasSubstr;

Rows rows_of(const YAML::Node& node) { return node.as<Rows>(); }

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

List read_npy(const std::string& bytes, std::size_t joints) {
  EXPECT_EQ(bytes.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
  const std::size_t length = static_cast<unsigned char>(bytes[8]) + 256U * static_cast<unsigned char>(bytes[9]);
  EXPECT_EQ((10 + length) % 64, 0U);
  EXPECT_EQ(bytes[9 + length], '\n');
  const std::string header = bytes.substr(10, length);
  EXPECT_THAT(header, HasSubstr("'descr': '<f8', 'fortran_order': False, 'shape': ("));
  List read;
  for (std::size_t at = 10 + length; at < bytes.size(); at += 8 * joints) {
    read.rows.emplace_back(joints);
    std::memcpy(read.rows.back().data(), bytes.data() + at, 8 * joints);
  }
  EXPECT_THAT(header, HasSubstr("(" + std::to_string(read.rows.size()) + ", " + std::to_string(joints) + ")"));
  return read;
}

/// A reader for each format, from its description.
std::map<std::string, std::function<List(const std::string&, std::size_t)>> make_readers() {
  std::map<std::string, std::function<List(const std::string&, std::size_t)>> r;
  r["robot-calibration"] = [](const std::string& text, std::size_t) {
    List read;
    for (const YAML::Node& item : YAML::Load(text)) {
      read.names = item["joints"].as<std::vector<std::string>>();
      read.rows.push_back(item["positions"].as<std::vector<double>>());
    }
    return read;
  };
  r["figaroh"] = [](const std::string& text, std::size_t) {
    const YAML::Node root = YAML::Load(text);
    EXPECT_EQ(root.size(), 2U) << "exactly two keys";
    return List{root["calibration_joint_names"].as<std::vector<std::string>>(),
                rows_of(root["calibration_joint_configurations"])};
  };
  r["moveit"] = [](const std::string& text, std::size_t) {
    const YAML::Node root = YAML::Load(text);
    return List{root["joint_names"].as<std::vector<std::string>>(), rows_of(root["joint_values"])};
  };
  r["industrial-calibration"] = [](const std::string& text, std::size_t) {
    List read;
    for (const auto& item : YAML::Load(text)) {
      EXPECT_TRUE(std::isnan(item.second["pose"]["qw"].as<double>()));
      EXPECT_EQ(item.second["camera_joints"].size(), 0U);
      read.rows.push_back(item.second["target_joints"].as<std::vector<double>>());
    }
    return read;
  };
  r["joint-trajectory"] = [](const std::string& text, std::size_t) {
    List read;
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
    List read;
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
    return List{{}, in_radians(columns(table(text, ',', 1, 0), 0, n))};
  };
  r["delmia"] = [](const std::string& text, std::size_t n) {
    return List{{}, in_radians(columns(table(text, '\t', 1, 1), 6, n))};
  };
  r["robodk-csv"] = [](const std::string& text, std::size_t) { return List{{}, in_radians(table(text, ',', 1, 0))}; };
  r["csv"] = [](const std::string& text, std::size_t) { return List{{}, table(text, ',', 1, 1)}; };
  r["figaroh-csv"] = [](const std::string& text, std::size_t n) {
    return List{{}, columns(table(text, ',', 1, 1), 6, n)};
  };
  r["json"] = [](const std::string& text, std::size_t) {
    const auto json = nlohmann::json::parse(text);
    List read{json["names"], {}};
    for (const auto& pose : json["poses"]) read.rows.push_back(pose["values"]);
    return read;
  };
  return r;
}

}  // namespace

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

const std::map<std::string, std::function<List(const std::string& bytes, std::size_t joints)>>& list_readers() {
  static const auto readers = make_readers();
  return readers;
}

}  // namespace posewright::readers
