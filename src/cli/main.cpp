#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <iostream>
#include <new>
#include <sstream>

#include "command.hpp"
#include "posewright/version.hpp"
#include "session.hpp"

namespace posewright::cli {
namespace {

std::string command_names() {
  std::string names;
  for (const Command& command : commands()) names += (names.empty() ? "" : ", ") + command.name;
  return names;
}

std::string general_help() {
  std::string text =
      "posewright: plans which poses to measure before a robot is calibrated\n\n"
      "Usage: posewright COMMAND [options]\n\nCommands:\n";
  for (const Command& command : commands())
    text += fmt::format("  {:<28}{}\n", command.name + " " + command.arguments, command.summary);
  text +=
      "  help COMMAND                options of a command\n\n"
      "Example:\n  posewright plan examples/telescope/problem.yaml -o plan.json --poses-csv poses.csv\n\n"
      "Exit status: 0 done; 1 well-formed but cannot be done; 2 bad usage or input; 130 interrupted (best plan "
      "written).\n";
  return text;
}

std::string command_help(const Command& command) {
  std::ostringstream text;
  text << "Usage: posewright " << command.name << " " << command.arguments << " [options]\n\n"
       << command.summary << "\n\n"
       << command.options() << "\n"
       << common_options() << "\nExample:\n  " << command.example << "\n";
  return text.str();
}

const Command& find_command(const std::string& name) {
  const auto found =
      std::find_if(commands().begin(), commands().end(), [&](const Command& c) { return c.name == name; });
  if (found == commands().end())
    throw InputError({}, "unknown command '" + name + "'", "commands of this version: " + command_names());
  return *found;
}

int run_command(const Command& command, const Words& words) {
  po::options_description all;
  all.add(command.options()).add(common_options());
  po::options_description hidden;
  hidden.add_options()("positional", po::value<Words>());
  po::options_description everything;
  everything.add(all).add(hidden);
  po::positional_options_description positional;
  positional.add("positional", -1);
  // Abbreviated options would change their meaning with every option added later.
  const int style = po::command_line_style::default_style & ~po::command_line_style::allow_guessing;
  po::variables_map values;
  po::store(po::command_line_parser(words).options(everything).positional(positional).style(style).run(), values);
  if (values.count("help") > 0) {
    fmt::print("{}", command_help(command));
    return done;
  }
  po::notify(values);
  return command.run(values, values.count("positional") > 0 ? values["positional"].as<Words>() : Words{});
}

int run(const Words& words) {
  if (words.empty()) {
    fmt::print(stderr, "{}", general_help());
    return bad_input;
  }
  const std::string& first = words.front();
  if (first == "--version") {
    fmt::print("posewright {}\n", version);
    return done;
  }
  if (first == "--help" || first == "-h" || first == "help") {
    fmt::print("{}", words.size() > 1 ? command_help(find_command(words[1])) : general_help());
    return done;
  }
  const Command& command = find_command(first);
  return run_command(command, Words(words.begin() + 1, words.end()));
}

}  // namespace
}  // namespace posewright::cli

int main(int count, char** arguments) {
  using namespace posewright;
  const auto complain = [](const std::string& text, int code) {
    fmt::print(stderr, "posewright: {}\n", text);
    return code;
  };
  try {
    const int code = cli::run(cli::Words(arguments + 1, arguments + count));
    if (std::fflush(stdout) != 0) return complain("standard output cannot be written", cli::cannot_do);
    return code;
  } catch (const cli::Interrupted&) {
    return cli::interrupted;
  } catch (const InputError& error) {
    return complain(error.what(), cli::bad_input);
  } catch (const cli::po::error& error) {
    return complain(std::string(error.what()) + "; see --help", cli::bad_input);
  } catch (const CannotDo& error) {
    return complain(error.what(), cli::cannot_do);
  } catch (const std::bad_alloc&) {
    return complain("not enough memory; ask for fewer candidates", cli::cannot_do);
  } catch (const std::exception& error) {
    return complain(std::string("internal error: ") + error.what(), cli::cannot_do);
  }
}
