#include "terminal.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>

namespace posewright::cli {
namespace {

std::string_view environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? std::string_view() : std::string_view(value);
}

}  // namespace

bool has_colour(std::FILE* stream) {
  return ::isatty(::fileno(stream)) != 0 && environment("NO_COLOR").empty() && environment("TERM") != "dumb";
}

void print_report(const std::string& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  if (!has_colour(stdout)) fmt::print("{}", text);
  else fmt::print("\x1b[1m{}\x1b[0m{}", text.substr(0, end), text.substr(end));
}

void print_error(const std::string& text) {
  const bool colour = has_colour(stderr);
  print_aside(fmt::format("{}posewright:{} {}\n", colour ? "\x1b[1;31m" : "", colour ? "\x1b[0m" : "", text));
}

// A terminal that is gone is not a reason to lose a result.
void print_aside(const std::string& text) {
  if (std::fputs(text.c_str(), stderr) < 0) std::clearerr(stderr);
}

}  // namespace posewright::cli
