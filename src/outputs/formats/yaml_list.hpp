#pragma once

#include <yaml-cpp/yaml.h>

#include <functional>
#include <string>
#include <vector>

#include "posewright/outputs/pose_formats.hpp"
#include "posewright/support/error.hpp"

/// Pose lists in YAML. Everything here throws InputError with file and line.
namespace posewright::formats {

class YamlList {
 public:
  /// Runs `body` on the first document of `bytes`; what yaml-cpp throws becomes an InputError.
  static PoseTable read(const std::string& bytes, const std::string& file,
                        const std::function<PoseTable(const YamlList&, const YAML::Node&)>& body);

  explicit YamlList(std::string file) : file_(std::move(file)) {}
  int line(const YAML::Node& node) const;
  [[noreturn]] void fail(const YAML::Node& node, const std::string& what, const std::string& allowed) const;
  /// The value of a key; fails at the mapping where it has none.
  YAML::Node at(const YAML::Node& mapping, const std::string& key) const;
  /// The entries of a list that is not empty.
  std::vector<YAML::Node> items(const YAML::Node& node, const std::string& what) const;
  std::string text(const YAML::Node& node, const std::string& what) const;
  std::vector<std::string> texts(const YAML::Node& node, const std::string& what) const;
  double number(const YAML::Node& node, const std::string& what) const;
  std::vector<double> numbers(const YAML::Node& node, const std::string& what) const;
  /// A row of as many numbers as there are names, where there are names.
  PoseRow row(const YAML::Node& node, const std::string& what, std::size_t names) const;

 private:
  std::string file_;
};

/// "# Written by posewright: what\n"
std::string yaml_head(const std::string& what);

}  // namespace posewright::formats
