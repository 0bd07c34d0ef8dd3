#include "help.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "option_facts.hpp"
#include "posewright/support/near_words.hpp"
#include "posewright/version.hpp"

namespace posewright::cli {
namespace {

std::string command_names() {
  std::string names;
  for (const Command& command : commands()) names += (names.empty() ? "" : ", ") + command.name;
  return names;
}

/// Code point at the front of UTF-8 text that is known to be valid, cut off.
unsigned take_code_point(std::string_view& text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const std::size_t length = byte(0) < 0x80 ? 1 : byte(0) < 0xE0 ? 2 : byte(0) < 0xF0 ? 3 : 4;
  unsigned code = length == 1 ? byte(0) : byte(0) & (0xFFU >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) code = code << 6 | (byte(i) & 0x3FU);
  text.remove_prefix(length);
  return code;
}

/// Text as roff prints it: minus signs that can be copied, ASCII throughout.
std::string roff(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const unsigned code = take_code_point(text);
    if (code == '-') result += "\\-";
    else if (code == '\\') result += "\\e";
    else if (code < 0x80) result += char(code);
    else result += fmt::format("\\[u{:04X}]", code);
  }
  return result;
}

/// A paragraph in short lines, none of which is taken for a request.
std::string paragraph(const std::string& text) {
  std::string result, line;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (line.size() + word.size() > 60) {
      result += line + "\n";
      line.clear();
    }
    if (line.empty() && (word.front() == '.' || word.front() == '\'')) line = "\\&";
    line += (line.empty() ? "" : " ") + roff(word);
  }
  return result + line + "\n";
}

std::string option_item(const OptionFacts& option) {
  std::string item = ".TP\n";
  if (!option.letter.empty()) item += fmt::format("\\fB\\-{}\\fR, ", option.letter);
  item += fmt::format("\\fB\\-\\-{}\\fR", roff(option.name));
  if (!option.value.empty()) item += fmt::format(" \\fI{}\\fR", roff(option.value));
  return item + "\n" + paragraph(option.description);
}

std::string command_section(const Command& command, std::size_t common_count) {
  std::string text = fmt::format(".SS \"posewright {} {} [options]\"\n{}", command.name, roff(command.arguments),
                                 paragraph(command.summary));
  const std::vector<OptionFacts> options = option_facts(command);
  for (std::size_t i = 0; i + common_count < options.size(); ++i) text += option_item(options[i]);
  return text + fmt::format(".PP\nExample:\n.PP\n.RS 4\n{}.RE\n", paragraph(command.example));
}

std::string exit_status() {
  return ".SH EXIT STATUS\n"
         ".TP\n0\nDone.\n"
         ".TP\n1\nWell\\-formed, but it cannot be done: infeasible, not identifiable,\na file cannot be written.\n"
         ".TP\n2\nBad usage or bad input. The message names file and line,\nthe mistake, and the allowed values.\n"
         ".TP\n130\nInterrupted by Ctrl\\-C. The best plan so far is written.\n";
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

std::string manual_page() {
  const std::vector<OptionFacts> common = common_option_facts();
  std::string text = fmt::format(
      ".TH POSEWRIGHT 1 {} \"posewright {}\" \"User Commands\"\n"
      ".SH NAME\nposewright \\- {}\n"
      ".SH SYNOPSIS\n.B posewright\n\\fICOMMAND\\fR [\\fIoptions\\fR]\n"
      ".PP\n.B posewright help\n\\fICOMMAND\\fR | \\fB\\-\\-man\\fR\n"
      ".PP\n.B posewright completion\nbash | zsh\n"
      ".PP\n.B posewright \\-\\-version\n"
      ".SH DESCRIPTION\nSearches for the poses that identify a robot's geometric or elastic\n"
      "parameters best, and bounds the distance to the best possible plan.\nTables go to "
      "standard output, progress and messages\nto standard error.\n"
      ".SH COMMANDS\n",
      release_date, version, roff(purpose));
  for (const Command& command : commands()) text += command_section(command, common.size());
  text += ".SH COMMON OPTIONS\nEvery command has them.\n";
  for (const OptionFacts& option : common) text += option_item(option);
  text += exit_status();
  text +=
      ".SH ENVIRONMENT\n"
      ".TP\n.B NO_COLOR\nNot empty: no bold or coloured text on a terminal.\n"
      ".TP\n.B ROS_PACKAGE_PATH, AMENT_PREFIX_PATH, GZ_SIM_RESOURCE_PATH, GAZEBO_MODEL_PATH\n"
      "Folders in which package://NAME/ and model://NAME/ of meshes and models are\nsearched.\n"
      ".SH FILES\nJSON Schemas of problem, plan and route, for editors and programs, are\nin share/posewright/schemas, "
      "examples "
      "in share/posewright/examples.\n";
  return text;
}

}  // namespace posewright::cli
