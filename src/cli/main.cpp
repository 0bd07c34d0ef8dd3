#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <system_error>

#include "command.hpp"
#include "design_options.hpp"
#include "help.hpp"
#include "mathematics.hpp"
#include "posewright/support/near_words.hpp"
#include "posewright/support/table.hpp"
#include "posewright/support/tasks.hpp"
#include "posewright/version.hpp"
#include "processes.hpp"
#include "result_files.hpp"
#include "session.hpp"
#include "signals.hpp"
#include "source_excerpt.hpp"
#include "terminal.hpp"

namespace posewright::cli {
namespace {

/// Suggestion for an unknown option: a name that begins so, or the nearest one.
std::string meant_option(const std::string& written, const po::options_description& options) {
  const std::string word = written.substr(std::min(written.find_first_not_of('-'), written.size()));
  std::vector<std::string> names;
  for (const auto& option : options.options()) {
    names.push_back(option->long_name());
    if (word.size() > 2 && names.back().starts_with(word)) return " (did you mean '--" + names.back() + "'?)";
  }
  const std::string near = nearest_word(word, names);
  return near.empty() ? near : " (did you mean '--" + near + "'?)";
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
  try {
    po::store(po::command_line_parser(words).options(everything).positional(positional).style(style).run(), values);
  } catch (const po::error& error) {
    const auto* unknown = dynamic_cast<const po::unknown_option*>(&error);
    throw InputError({}, error.what() + (unknown == nullptr ? "" : meant_option(unknown->get_option_name(), all)),
                     "see posewright help " + command.name);
  }
  if (values.count("help") > 0) {
    fmt::print("{}", command_help(command));
    return done;
  }
  po::notify(values);
  // A flag without a value is stored as an empty text.
  for (const auto& [name, value] : values) {
    const auto* text = boost::any_cast<std::string>(&value.value());
    const po::option_description* option = everything.find_nothrow(name, false);
    if (text != nullptr && text->empty() && option != nullptr && option->semantic()->max_tokens() > 0)
      throw InputError({}, "--" + name + " is empty", "a value is expected");
  }
  if (!command.shares_tasks && started_workers()->processes() > 1)
    throw InputError({}, command.name + " runs in one process", "start it without mpirun");
  if (values.count("markdown") > 0) {
    if (values.count("json") > 0) throw InputError({}, "--markdown and --json", "leave one of them out");
    set_table_layout(TableLayout::markdown);
  }
  return command.run(values, values.count("positional") > 0 ? values["positional"].as<Words>() : Words{});
}

int run_program(const Words& words) {
  if (words.empty()) {
    print_aside(general_help());
    return bad_input;
  }
  const std::string& first = words.front();
  if (first == "--version") {
    fmt::print("posewright {}\nMathematical functions: {}\n", version, mathematics);
    return done;
  }
  if (first == "--help" || first == "-h" || first == "help") {
    fmt::print("{}", words.size() < 2       ? general_help()
                     : words[1] == "--man"  ? manual_page()
                     : words[1] == "--keys" ? design_keys_json()
                                            : command_help(find_command(words[1])));
    return done;
  }
  if (first == "completion") {
    fmt::print("{}", completion_script(single(Words(words.begin() + 1, words.end()), "SHELL (bash or zsh)")));
    return done;
  }
  const Command& command = find_command(first);
  return run_command(command, Words(words.begin() + 1, words.end()));
}

}  // namespace
}  // namespace posewright::cli

int main(int count, char** arguments) {
  using namespace posewright;
  cli::prepare_process();
  const auto end = [](int code) {
    cli::leave(code);
    return code;
  };
  const auto complain = [&](const std::string& text, int code) {
    cli::print_error(text);
    return end(code);
  };
  try {
    const int code = cli::run_program(cli::Words(arguments + 1, arguments + count));
    if (std::fflush(stdout) != 0)
      return complain("standard output cannot be written" + cli::saved_before(), cli::cannot_do);
    return end(code);
  } catch (const cli::Interrupted&) {
    return end(cli::interrupted);
  } catch (const cli::AnotherWrites&) {
    return end(cli::done);
  } catch (const ShardDone& shard) {
    fmt::print("{} of {} {} are in the log; the rest is for the other shares.\n", shard.done, shard.of, shard.group);
    return end(cli::done);
  } catch (const InputError& error) {
    const int code = complain(error.what(), cli::bad_input);
    cli::print_aside(cli::source_excerpt(error));
    return code;
  } catch (const CannotDo& error) {
    return complain(error.what(), cli::cannot_do);
  } catch (const std::bad_alloc&) {
    return complain("not enough memory; ask for fewer candidates" + cli::saved_before(), cli::cannot_do);
  } catch (const std::system_error& error) {
    // Of the formatting library if a stream does not take what it prints; else of a thread that cannot be made.
    return complain(
        (std::ferror(stdout) != 0 ? "standard output cannot be written" : error.what()) + cli::saved_before(),
        cli::cannot_do);
  } catch (const std::exception& error) {
    return complain(std::string("internal error: ") + error.what(), cli::cannot_do);
  }
}
