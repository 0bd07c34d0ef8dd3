#include "yaml_list.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "posewright/formats/format_text.hpp"

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
    throw InputError({file, std::max(error.mark.line + 1, 0)}, "is not valid YAML: " + ascii(error.msg), "");
  }
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
