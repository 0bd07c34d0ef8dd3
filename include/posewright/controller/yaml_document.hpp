#pragma once

#include <yaml-cpp/yaml.h>

#include <string>
#include <vector>

#include "posewright/support/error.hpp"

namespace posewright::yaml {

/// Short YAML files beside the problem: values by name. Everything here throws InputError with file and
/// line.
class Document {
 public:
  explicit Document(std::string file) : file_(std::move(file)) {}
  int line(const YAML::Node& node) const;
  SourcePlace place(const YAML::Node& node) const { return {file_, line(node)}; }
  [[noreturn]] void fail(const YAML::Node& node, const std::string& what, const std::string& allowed) const;
  /// The value of a key; fails at the mapping if it has none.
  YAML::Node at(const YAML::Node& mapping, const std::string& key) const;
  /// The entries of a list that is not empty.
  std::vector<YAML::Node> items(const YAML::Node& node, const std::string& what) const;
  std::string text(const YAML::Node& node, const std::string& what) const;
  std::vector<std::string> texts(const YAML::Node& node, const std::string& what) const;
  double number(const YAML::Node& node, const std::string& what) const;
  std::vector<double> numbers(const YAML::Node& node, const std::string& what) const;

 private:
  std::string file_;
};

}  // namespace posewright::yaml
