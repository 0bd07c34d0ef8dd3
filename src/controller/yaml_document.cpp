#include "posewright/controller/yaml_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "posewright/support/read_number.hpp"
#include "posewright/support/text.hpp"

namespace posewright::yaml {

int Document::line(const YAML::Node& node) const { return std::max(node.Mark().line + 1, 0); }

void Document::fail(const YAML::Node& node, const std::string& what, const std::string& allowed) const {
  throw InputError({file_, node.IsDefined() ? line(node) : 0}, what, allowed);
}

YAML::Node Document::at(const YAML::Node& mapping, const std::string& key) const {
  if (!mapping.IsMap()) fail(mapping, "is not a mapping with '" + key + "'", "key: value");
  const YAML::Node value = mapping[key];
  if (!value.IsDefined()) fail(mapping, "has no '" + key + "'", "it is needed here");
  return value;
}

std::vector<YAML::Node> Document::items(const YAML::Node& node, const std::string& what) const {
  if (!node.IsSequence() || node.size() == 0)
    fail(node, what + " is not a list", "a list that is not empty is expected");
  return {node.begin(), node.end()};
}

std::string Document::text(const YAML::Node& node, const std::string& what) const {
  if (!node.IsScalar() || node.Scalar().empty()) fail(node, what + " is not text", "a text is expected");
  return node.Scalar();
}

std::vector<std::string> Document::texts(const YAML::Node& node, const std::string& what) const {
  std::vector<std::string> result;
  for (const YAML::Node& item : items(node, what)) result.push_back(text(item, what));
  return result;
}

double Document::number(const YAML::Node& node, const std::string& what) const {
  const std::string written = node.IsScalar() ? node.Scalar() : std::string();
  const std::optional<double> value = read_double(std::string_view(written).substr(written.starts_with('+') ? 1 : 0));
  if (!value || !std::isfinite(*value))
    fail(node, fmt::format("{}: {} is not a number", what, in_quotes(written)), "a finite number is expected");
  return *value == 0 ? 0.0 : *value;
}

std::vector<double> Document::numbers(const YAML::Node& node, const std::string& what) const {
  std::vector<double> result;
  for (const YAML::Node& item : items(node, what)) result.push_back(number(item, what));
  return result;
}

}  // namespace posewright::yaml
