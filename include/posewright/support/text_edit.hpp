#pragma once

#include <string>
#include <vector>

namespace posewright {

/// A stretch of a text and its replacement.
struct TextEdit {
  std::size_t begin = 0, end = 0;
  std::string text;
};

/// The text with all edits, which do not overlap; those at one place in the order given.
std::string with_edits(const std::string& text, std::vector<TextEdit> edits);

}  // namespace posewright
