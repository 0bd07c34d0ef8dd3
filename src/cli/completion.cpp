#include <fmt/format.h>

#include "help.hpp"
#include "option_facts.hpp"
#include "posewright/version.hpp"

namespace posewright::cli {
namespace {

std::string joined(const std::vector<std::string>& words) { return fmt::format("{}", fmt::join(words, " ")); }

std::string command_words() {
  std::string words;
  for (const Command& command : commands()) words += command.name + " ";
  return words;
}

/// Call that completes an option's value; `:` for values only the user knows.
std::string bash_values(const Expected& expected) {
  if (!expected.words.empty()) return fmt::format("_posewright_words '{}'", joined(expected.words));
  if (!expected.suffixes.empty()) return fmt::format("_posewright_files '{}'", fmt::join(expected.suffixes, "' '"));
  return expected.folder ? "_posewright_folders" : ":";
}

std::string bash_command(const Command& command) {
  std::string words, values;
  for (const OptionFacts& option : option_facts(command)) {
    words += (words.empty() ? "--" : " --") + option.name;
    if (option.value.empty()) continue;
    const std::string letter = option.letter.empty() ? "" : fmt::format("|'{} -{}'", command.name, option.letter);
    values += fmt::format("    '{} --{}'{}) {}; return ;;\n", command.name, option.name, letter,
                          bash_values(option.expected));
  }
  std::vector<std::string> suffixes;
  for (const Expected& argument : argument_facts(command))
    suffixes.insert(suffixes.end(), argument.suffixes.begin(), argument.suffixes.end());
  return values + fmt::format("    '{} '*) _posewright_either '{}' {} ;;\n", command.name, words, joined(suffixes));
}

std::string bash_script() {
  std::string text = fmt::format("# bash completion of posewright {}, made by: posewright completion bash\n", version);
  text += R"(_posewright_words() { mapfile -t COMPREPLY < <(compgen -W "$1" -- "$word"); }
_posewright_folders() { mapfile -t COMPREPLY < <(compgen -d -- "$word"); }
_posewright_files() {
  local suffix
  mapfile -t COMPREPLY < <(compgen -d -- "$word"; set -f; for suffix in "$@"; do
    if [[ $suffix == '*' ]]; then compgen -f -- "$word"; else compgen -f -X "!*.$suffix" -- "$word"; fi; done | sort -u)
}
_posewright_either() {
  if [[ $word == -* ]]; then _posewright_words "$1"; else shift; _posewright_files "$@"; fi
}
_posewright() {
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]}
  local -i at=COMP_CWORD-1
  if [[ $word == '=' ]]; then word=; elif [[ $before == '=' ]]; then at=COMP_CWORD-2; fi
  before=${COMP_WORDS[at]}
  if ((at > 1)) && [[ $before != -* && ${COMP_WORDS[at-1]} == --package ]]; then before=--package; fi
  COMPREPLY=()
  if ((COMP_CWORD == 1)); then
)";
  text +=
      fmt::format("    _posewright_words '{}help completion --help --version'\n    return\n  fi\n", command_words());
  text += "  case \"${COMP_WORDS[1]} $before\" in\n";
  text += fmt::format("    'help help') _posewright_words '{}--man' ;;\n", command_words());
  text += "    'completion completion') _posewright_words 'bash zsh' ;;\n";
  for (const Command& command : commands()) text += bash_command(command);
  return text + "  esac\n}\ncomplete -o filenames -F _posewright posewright\n";
}

/// Within single quotes, where brackets and colons have a meaning for _arguments.
std::string zsh_text(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '\'') result += "'\\'";
    else if (c == '[' || c == ']' || c == ':' || c == '\\') result += '\\';
    result += c;
  }
  return result;
}

std::string zsh_values(const Expected& expected) {
  if (!expected.words.empty()) return fmt::format("({})", joined(expected.words));
  if (expected.folder) return "_files -/";
  if (expected.suffixes.empty()) return " ";
  return expected.suffixes.front() == "*" ? "_files"
                                          : fmt::format("_files -g \"*.({})\"", fmt::join(expected.suffixes, "|"));
}

std::string zsh_option(const OptionFacts& option) {
  const std::string value =
      option.value.empty() ? "" : fmt::format(":{}:{}", zsh_text(option.value), zsh_values(option.expected));
  const std::string rest = fmt::format("[{}]{}", zsh_text(option.description), value);
  const std::string equal = option.value.empty() ? "" : "=";
  if (option.letter.empty())
    return fmt::format("        '{}--{}{}{}'", option.many ? "*" : "", option.name, equal, rest);
  return fmt::format("        '(-{0} --{1})'{{-{0},--{1}{2}}}'{3}'", option.letter, option.name, equal, rest);
}

std::string zsh_command(const Command& command) {
  std::string text = fmt::format("      {})\n        _arguments \\\n", command.name);
  int place = 0;
  for (const Expected& argument : argument_facts(command))
    text += fmt::format("        '{}:argument:{}' \\\n", argument.many ? "*" : std::to_string(++place),
                        zsh_values(argument));
  std::string options;
  for (const OptionFacts& option : option_facts(command))
    options += (options.empty() ? "" : " \\\n") + zsh_option(option);
  return text + options + " ;;\n";
}

std::string zsh_script() {
  std::string text = fmt::format(
      "#compdef posewright\n# zsh completion of posewright {}, made by: posewright completion zsh\n"
      "_posewright() {{\n  local curcontext=$curcontext state line\n  local -a commands\n  commands=(\n",
      version);
  for (const Command& command : commands())
    text += fmt::format("    '{}:{}'\n", command.name, zsh_text(command.summary));
  text += fmt::format(
      "    'help:Options of a command.'\n    'completion:Completion for a shell.'\n  )\n  _arguments -C '(- "
      "*)--help[show this help]' '(- *)--version[version]' '1:command:->command' '*::argument:->argument'\n  case "
      "$state in\n    command) _describe command commands ;;\n    argument) case $words[1] in\n      help) _arguments "
      "'1:command:({}--man)' ;;\n      completion) _arguments '1:shell:(bash zsh)' ;;\n",
      command_words());
  for (const Command& command : commands()) text += zsh_command(command);
  return text +
         "    esac ;;\n  esac\n}\nif [[ $funcstack[1] = _posewright ]]; then _posewright \"$@\"; else compdef "
         "_posewright posewright; fi\n";
}

}  // namespace

std::string completion_script(const std::string& shell) {
  if (shell == "bash") return bash_script();
  if (shell == "zsh") return zsh_script();
  throw InputError({}, "completion for '" + shell + "'", "allowed: bash, zsh");
}

}  // namespace posewright::cli
