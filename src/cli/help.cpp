#include "help.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "posewright/support/near_words.hpp"

namespace posewright::cli {
namespace {

std::string command_names() {
  std::string names;
  for (const Command& command : commands()) names += (names.empty() ? "" : ", ") + command.name;
  return names;
}

}  // namespace

std::string general_help() {
  std::string text = fmt::format("posewright: {}\n\nUsage: posewright COMMAND [options]\n\nCommands:\n", purpose);
  constexpr std::size_t column = 28;
  for (const Command& command : commands()) {
    const std::string call = command.name + " " + command.arguments;
    text += fmt::format("  {:<{}}{}{}\n", call, column, call.size() < column ? "" : "  ", command.summary);
  }
  text += fmt::format(
      "  {:<28}{}\n  {:<28}{}\n  {:<28}{}\n  {:<28}{}\n\nExample:\n  {}\n\n"
      "Exit status: 0 done; 1 well-formed but cannot be done; 2 bad usage or input; 130 interrupted (best plan "
      "written).\n",
      "help COMMAND", "Options of a command.", "help --man", "The manual page, for man -l.", "help --keys",
      "Keys of design and options of commands, as JSON.", "completion bash|zsh",
      "Completion for a shell: source <(posewright completion bash)", general_example);
  return text;
}

std::string command_help(const Command& command) {
  const po::options_description options = command.options(), common = common_options();
  const unsigned column = std::max(options.get_option_column_width(), common.get_option_column_width());
  std::ostringstream text;
  text << "Usage: posewright " << command.name << " " << command.arguments << " [options]\n\n"
       << command.summary << "\n\n";
  options.print(text, column);
  text << "\n";
  common.print(text, column);
  text << "\nExample:\n  " << command.example << "\n";
  return text.str();
}

const Command& find_command(const std::string& name) {
  const auto found =
      std::find_if(commands().begin(), commands().end(), [&](const Command& c) { return c.name == name; });
  std::vector<std::string> names = {"help", "completion"};
  for (const Command& command : commands()) names.push_back(command.name);
  if (found == commands().end())
    throw InputError({}, "unknown command '" + name + "'" + meant_instead(name, names),
                     "commands of this version: " + command_names());
  return *found;
}

}  // namespace posewright::cli
