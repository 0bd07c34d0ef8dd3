#include "option_facts.hpp"

#include <algorithm>
#include <map>
#include <sstream>

#include "planners/planner_registry.hpp"
#include "posewright/criterion/registry.hpp"
#include "posewright/formats/pose_formats.hpp"
#include "posewright/tasks/known_cameras.hpp"

namespace posewright::cli {
namespace {

/// "allow|forbid|k" → allow, forbid: what is written in small letters stands for itself; single letters do not.
std::vector<std::string> literal_words(const std::string& value) {
  std::vector<std::string> words;
  std::istringstream parts(value);
  for (std::string part; std::getline(parts, part, '|');)
    if (part.size() > 1 && std::all_of(part.begin(), part.end(), [](char c) { return c >= 'a' && c <= 'z'; }))
      words.push_back(part);
  return words;
}

Expected expected_of(const std::string& value) {
  static const std::map<std::string, std::vector<std::string>> files = {
      {"PROBLEM", {"yaml", "yml"}},
      {"PLAN", {"json"}},
      {"POSES", {"csv", "json"}},
      {"BLOCKS", {"npy", "csv"}},
      {"FILE", {"*"}},
      {"FILE|DIR", {"*"}},
      {"ROBOT", {"urdf", "xacro"}},
      {"[PLAN...]", {"json", "csv"}},
      {"RESULT", {"json"}},
      {"[PLAN]", {"json"}},
      {"LOG...", {"log"}},
      {"PROBLEM...", {"yaml", "yml"}},
  };
  Expected expected;
  if (const auto found = files.find(value); found != files.end()) expected.suffixes = found->second;
  else expected.words = literal_words(value);
  expected.folder = value.find("DIR") != std::string::npos;
  expected.many = value.ends_with("...]") || value.ends_with("...");
  return expected;
}

OptionFacts facts_of(const po::option_description& option) {
  OptionFacts facts;
  facts.name = option.long_name();
  const std::string shown = option.format_name();
  if (shown.size() > 1 && shown[1] != '-') facts.letter = shown.substr(1, 1);
  facts.description = option.description();
  if (option.semantic()->max_tokens() == 0) return facts;
  facts.value = option.format_parameter();
  facts.many = option.semantic()->is_composing();
  facts.expected = expected_of(facts.value);
  if (facts.name == "criterion") facts.expected.words = registered_names(criterion_registry());
  if (facts.name == "to" || facts.name == "from")
    for (const PoseFormat& format : pose_formats())
      if (facts.name == "to" || format.read != nullptr) facts.expected.words.push_back(format.name);
  if (facts.name == "camera") {
    facts.expected.words = registered_names(known_cameras());
    facts.expected.words.push_back("list");
  }
  if (facts.name == "method") facts.expected.words = registered_names(planner_registry());
  return facts;
}

}  // namespace

std::vector<OptionFacts> common_option_facts() {
  std::vector<OptionFacts> facts;
  // The description lives as long as the options that it hands out.
  const po::options_description common = common_options();
  for (const auto& option : common.options()) facts.push_back(facts_of(*option));
  return facts;
}

std::vector<OptionFacts> option_facts(const Command& command) {
  std::vector<OptionFacts> facts;
  const po::options_description own = command.options();
  for (const auto& option : own.options()) facts.push_back(facts_of(*option));
  for (const OptionFacts& option : common_option_facts()) facts.push_back(option);
  return facts;
}

std::vector<Expected> argument_facts(const Command& command) {
  std::vector<Expected> facts;
  std::istringstream words(command.arguments);
  for (std::string word; words >> word;) facts.push_back(expected_of(word));
  return facts;
}

}  // namespace posewright::cli
