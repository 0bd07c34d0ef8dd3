#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <new>
#include <string>
#include <system_error>
#include <tuple>
#include <utility>
#include <vector>

#include "command.hpp"
#include "design_options.hpp"
#include "help.hpp"
#include "mathematics.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/near_words.hpp"
#include "posewright/support/table.hpp"
#include "posewright/support/tasks.hpp"
#include "posewright/support/text.hpp"
#include "posewright/version.hpp"
#include "processes.hpp"
#include "session.hpp"
#include "signals.hpp"
#include "terminal.hpp"
#include "write_result.hpp"

namespace posewright::cli {
namespace {

constexpr std::size_t most_shown = 100, most_before = 40;  // characters of a line
constexpr std::size_t longest_line = 1'000'000;            // bytes; what is longer was not written by a person

/// Without a note that the file is an input; empty if there is no such line.
std::string line_of(const SourcePlace& place) {
  std::error_code code;
  if (place.line < 1 || !std::filesystem::is_regular_file(place.file, code)) return {};
  std::ifstream in(place.file, std::ios::binary);
  std::string line;
  for (int number = 0; number < place.line; ++number)
    if (!std::getline(in, line) || line.size() > longest_line) return {};
  if (place.line == 1 && line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3);
  return line;
}

/// The characters of a line, each as it is shown: tabs are blanks, what is no text a mark.
std::vector<std::string> characters(std::string_view line) {
  std::vector<std::string> result;
  while (!line.empty()) {
    const std::size_t length = std::max<std::size_t>(utf8_length(line), 1);
    std::string one(line.substr(0, length));
    if (one == "\t" || one == "\r") one = " ";
    else if (utf8_length(one) == 0 || has_control_character(one)) one = "?";
    result.push_back(std::move(one));
    line.remove_prefix(length);
  }
  return result;
}

/// Position of a quoted text of the message in the line, in bytes; npos if none occurs.
std::pair<std::size_t, std::size_t> quoted_in(const std::string& line, const std::string& message) {
  for (std::size_t begin = message.find('\''); begin != std::string::npos;) {
    const std::size_t end = message.find('\'', begin + 1);
    if (end == std::string::npos) break;
    const std::string word = message.substr(begin + 1, end - begin - 1);
    const std::size_t at = word.empty() ? std::string::npos : line.find(word);
    if (at != std::string::npos) return {at, word.size()};
    begin = message.find('\'', end + 1);
  }
  return {std::string::npos, 0};
}

/// Bytes of the word that begins at `at`: a quoted text, else up to what ends a word in YAML, CSV and JSON.
std::size_t word_length(const std::string& line, std::size_t at) {
  if (at >= line.size()) return 1;
  if (const char quote = line[at]; quote == '"' || quote == '\'') {
    const std::size_t end = line.find(quote, at + 1);
    return end == std::string::npos ? line.size() - at : end + 1 - at;
  }
  const std::size_t end = std::min(line.find_first_of(" \t\r,:;{}[]<>#\"", at), line.size());
  return std::max<std::size_t>(end - at, 1);
}

struct Mark {
  std::size_t begin = 0, length = 1;  // characters
};

Mark mark_of(const std::string& line, const InputError& error) {
  std::size_t at = std::string::npos, length = 0;
  if (error.place().column > 0) {
    at = 0;
    for (int i = 1; i < error.place().column && at < line.size(); ++i)
      at += std::max<std::size_t>(utf8_length(std::string_view(line).substr(at)), 1);
    length = word_length(line, at);
  } else {
    std::tie(at, length) = quoted_in(line, error.what());
  }
  if (at == std::string::npos) {
    at = std::min(line.find_first_not_of(" \t"), line.size());
    length = line.find_last_not_of(" \t\r") + 1 - at;
  }
  const std::string_view view = line;
  return {characters(view.substr(0, at)).size(), std::max<std::size_t>(characters(view.substr(at, length)).size(), 1)};
}

/// The line of the file that an error is about, with a caret under the place: where the error has a column that, else
/// the first text of the line that the message has in quotes. Empty if the error is about no line or the file cannot be
/// read. Columns are characters; a long line is cut about the place.
std::string source_excerpt(const InputError& error) {
  const std::string line = line_of(error.place());
  if (line.find_first_not_of(" \t\r") == std::string::npos) return {};
  std::vector<std::string> shown = characters(line);
  Mark mark = mark_of(line, error);
  if (shown.size() > most_shown && mark.begin > most_before) {
    const std::size_t cut = std::min(mark.begin - most_before, shown.size() - most_shown);
    shown.erase(shown.begin(), shown.begin() + std::ptrdiff_t(cut));
    mark.begin -= cut;
    shown.front() = "…";
  }
  if (shown.size() > most_shown) {
    shown.resize(most_shown);
    shown.back() = "…";
  }
  while (!shown.empty() && shown.back() == " ") shown.pop_back();
  mark.length = std::max<std::size_t>(std::min(mark.length, shown.size() - std::min(mark.begin, shown.size())), 1);
  const bool colour = has_colour(stderr);
  const std::string number = std::to_string(error.place().line), margin(number.size(), ' ');
  std::string text;
  for (const std::string& character : shown) text += character;
  return fmt::format("  {} | {}\n  {} | {}{}^{}{}\n", number, text, margin, std::string(mark.begin, ' '),
                     colour ? "\x1b[1;31m" : "", std::string(mark.length - 1, '~'), colour ? "\x1b[0m" : "");
}

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
