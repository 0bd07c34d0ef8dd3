#pragma once

#include <cstdio>
#include <string>

namespace posewright::cli {

/// True if the stream is a terminal with bold and colour, and NO_COLOR is not set (no-color.org).
bool has_colour(std::FILE* stream);

/// A report on stdout, its first line bold if there are colours.
void print_report(const std::string& text);

/// Text on stderr. Nothing happens if it cannot be written.
void print_aside(const std::string& text);

/// One line on stderr with the program's name before it, red if there are colours.
void print_error(const std::string& text);

}  // namespace posewright::cli
