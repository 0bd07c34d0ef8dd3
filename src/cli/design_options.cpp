#include "design_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "option_facts.hpp"
#include "planners/planner_registry.hpp"
#include "posewright/criterion/registry.hpp"
#include "posewright/options/tables.hpp"
#include "posewright/problem/design_keys.hpp"
#include "posewright/support/json.hpp"
#include "problem_source.hpp"

namespace posewright::cli {
namespace {

using Json = nlohmann::ordered_json;

/// Names that the registries of later stages give; empty for other keys.
std::vector<std::string> names_for(const DesignKey& key) {
  if (key.path == "design.criterion") {
    std::vector<std::string> names = registered_names(criterion_registry());
    names.emplace_back(automatic_criterion);
    return names;
  }
  if (key.path == "design.method") return registered_names(planner_registry());
  return {};
}

/// A sentence of the table within a list: "number of poses (18)".
std::string option_help(const DesignKey& key) {
  std::string text = key.help.substr(0, key.help.size() - 1);
  text.front() = char(std::tolower(text.front()));
  std::erase(text, '`');
  if (const auto at = text.find("(default: "); at != std::string::npos) text.erase(at + 1, 9);
  if (const auto names = names_for(key); !names.empty()) text += fmt::format(": {}", fmt::join(names, ", "));
  if (key.standard.empty() || key.value.empty()) return text;
  const Json standard = Json::parse(key.standard);
  return text + " (" + (standard.is_string() ? standard.get<std::string>() : key.standard) + ")";
}

const char* type_name(OptionKind kind) {
  constexpr std::array names{"flag", "whole", "number", "text", "list", "blocks", "file", "poses", "size", "program"};
  return names[std::size_t(kind)];
}

bool is_among(const DesignKey& key, const DesignOptions& names) {
  return !key.option.empty() && std::find(names.begin(), names.end(), key.option) != names.end();
}

}  // namespace

void add_design_options(po::options_description& options, const DesignOptions& names) {
  for (const DesignKey& key : design_keys()) {
    if (!is_among(key, names)) continue;
    const std::string help = option_help(key);
    if (key.value.empty()) options.add_options()(key.option.c_str(), help.c_str());
    else options.add_options()(key.option.c_str(), text(key.value.c_str()), help.c_str());
  }
}

Problem designed_problem(const std::filesystem::path& file, const po::variables_map& values,
                         const DesignOptions& names) {
  Problem problem = given_problem(file, values);
  for (const DesignKey& key : design_keys())
    if (is_among(key, names) && values.count(key.option) > 0)
      set(problem, key.path, key.value.empty() ? "yes" : text_of(values, key.option), "--" + key.option);
  return problem;
}

std::string design_keys_json() {
  Json rows = Json::array();
  for (const DesignKey& key : design_keys()) {
    Json schema = Json::parse("{" + key.schema + "}");
    if (const auto names = names_for(key); !names.empty()) schema = Json{{"enum", names}};
    if (!key.standard.empty()) schema["default"] = Json::parse(key.standard);
    schema["description"] = key.help;
    rows.push_back({{"path", key.path}, {"option", key.option}, {"poses", key.lists_poses}, {"schema", schema}});
  }
  Json commands;
  for (const CommandRows& command : option_rows()) {
    Json options = Json::array();
    for (const OptionRow& row : command.rows)
      options.push_back({{"option", row.long_name()}, {"keyword", row.keyword()}, {"type", type_name(row.kind)}});
    commands[command.function] = {{"command", command.command}, {"options", options}};
  }
  return json_text(Json{{"design", rows}, {"functions", commands}});
}

}  // namespace posewright::cli
