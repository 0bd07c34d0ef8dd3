#pragma once

#include <string>
#include <vector>

#include "command.hpp"

namespace posewright::cli {

/// Names of a registry's entries, in its order.
template <class Registry>
std::vector<std::string> registered_names(const Registry& registry) {
  std::vector<std::string> names;
  for (const auto& entry : registry) names.push_back(entry.name);
  return names;
}

/// Allowed values of an argument or an option.
struct Expected {
  std::vector<std::string> words;     ///< these words
  std::vector<std::string> suffixes;  ///< files that end so ("yaml"); "*": any file
  bool folder = false;                ///< a folder
  bool many = false;                  ///< any number of them, the last argument
};

/// One option as manual page and completion need it.
struct OptionFacts {
  std::string name;         ///< without dashes
  std::string letter;       ///< short name without dash, empty if there is none
  std::string value;        ///< what the help calls the value; empty for an option without value
  std::string description;  ///< as in the help
  bool many = false;        ///< may be given several times
  Expected expected;
};

/// The command's own options, then those that every command has.
std::vector<OptionFacts> option_facts(const Command& command);
std::vector<OptionFacts> common_option_facts();

/// One entry for each word of Command::arguments.
std::vector<Expected> argument_facts(const Command& command);

}  // namespace posewright::cli
