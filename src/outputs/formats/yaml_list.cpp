#include "yaml_list.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "text.hpp"

namespace posewright::formats {

PoseTable YamlList::read(const std::string& bytes, const std::string& file,
                         const std::function<PoseTable(const YamlList&, const YAML::Node&)>& body) {
  const YamlList list(file);
  try {
    const YAML::Node root = YAML::Load(bytes);
    PoseTable table = body(list, root);
    if (table.rows.empty()) throw InputError({file, 0}, "has no poses", "at least one is needed");
    return table;
  } catch (const YAML::Exception& error) {
    throw InputError({file, std::max(error.mark.line + 1, 0)}, "is no valid YAML: " + ascii(error.msg), "");
  }
}

int YamlList::line(const YAML::Node& node) const { return std::max(node.Mark().line + 1, 0); }

void YamlList::fail(const YAML::Node& node, const std::string& what, const std::string& allowed) const {
  throw InputError({file_, node.IsDefined() ? line(node) : 0}, what, allowed);
}

YAML::Node YamlList::at(const YAML::Node& mapping, const std::string& key) const {
  if (!mapping.IsMap()) fail(mapping, "is no mapping with '" + key + "'", "key: value");
  const YAML::Node value = mapping[key];
  if (!value.IsDefined()) fail(mapping, "has no '" + key + "'", "it is needed here");
  return value;
}

std::vector<YAML::Node> YamlList::items(const YAML::Node& node, const std::string& what) const {
  if (!node.IsSequence() || node.size() == 0) fail(node, what + " is no list", "a list that is not empty is expected");
  return {node.begin(), node.end()};
}

std::string YamlList::text(const YAML::Node& node, const std::string& what) const {
  if (!node.IsScalar() || node.Scalar().empty()) fail(node, what + " is no text", "a text is expected");
  return node.Scalar();
}

std::vector<std::string> YamlList::texts(const YAML::Node& node, const std::string& what) const {
  std::vector<std::string> result;
  for (const YAML::Node& item : items(node, what)) result.push_back(text(item, what));
  return result;
}

double YamlList::number(const YAML::Node& node, const std::string& what) const {
  const std::string written = node.IsScalar() ? node.Scalar() : std::string();
  const char* begin = written.data() + (written.starts_with('+') ? 1 : 0);
  double value = 0;
  const auto [end, code] = std::from_chars(begin, written.data() + written.size(), value);
  if (written.empty() || code != std::errc() || end != written.data() + written.size() || !std::isfinite(value))
    fail(node, fmt::format("{}: {} is no number", what, in_quotes(written)), "a finite number is expected");
  return value == 0 ? 0.0 : value;
}

std::vector<double> YamlList::numbers(const YAML::Node& node, const std::string& what) const {
  std::vector<double> result;
  for (const YAML::Node& item : items(node, what)) result.push_back(number(item, what));
  return result;
}

PoseRow YamlList::row(const YAML::Node& node, const std::string& what, std::size_t names) const {
  PoseRow row;
  row.line = line(node);
  for (const double value : numbers(node, what)) row.cells.emplace_back(value);
  if (names > 0 && row.cells.size() != names)
    fail(node, fmt::format("{} has {} numbers", what, row.cells.size()), fmt::format("{} joints are named", names));
  return row;
}

std::string yaml_head(const std::string& what) { return fmt::format("# {}: {}\n", export_mark, what); }

}  // namespace posewright::formats
