#pragma once

#include <string>

#include "posewright/support/error.hpp"

namespace posewright::cli {

/// The line of the file that an error is about, with a caret under the place: where the error has a column that, else
/// the first text of the line that the message has in quotes. Empty if the error is about no line or the file cannot be
/// read. Columns are characters; a long line is cut about the place.
std::string source_excerpt(const InputError& error);

}  // namespace posewright::cli
