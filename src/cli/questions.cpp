#include "questions.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <iostream>

#include "posewright/support/error.hpp"
#include "posewright/support/text.hpp"
#include "terminal.hpp"

namespace posewright::cli {

bool can_ask() { return ::isatty(STDIN_FILENO) != 0 && ::isatty(STDERR_FILENO) != 0; }

void ask(const std::string& question, const std::string& standard,
         const std::function<void(const std::string&)>& take) {
  while (true) {
    print_aside(fmt::format("{} [{}]: ", question, standard));
    std::string line;
    if (!std::getline(std::cin, line)) throw InputError({}, "no answer to '" + question + "'", "the input ended");
    const std::string answer(trimmed_blanks(line));
    try {
      take(answer.empty() ? standard : answer);
      return;
    } catch (const InputError& error) {
      print_error(error.what());
    }
  }
}

}  // namespace posewright::cli
