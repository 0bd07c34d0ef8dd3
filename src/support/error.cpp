#include "posewright/support/error.hpp"

#include "posewright/support/text.hpp"

namespace posewright {
namespace {

std::string message(const SourcePlace& place, const std::string& what, const std::string& allowed) {
  std::string text;
  if (!place.file.empty()) {
    text = place.file;
    if (place.line > 0) text += ":" + std::to_string(place.line);
    text += ": ";
  }
  text += what;
  if (!allowed.empty()) text += "; " + allowed;
  // Whatever a file holds, the message is one line of text.
  return one_line(text);
}

}  // namespace

InputError::InputError(SourcePlace place, const std::string& what, const std::string& allowed)
    : std::runtime_error(message(place, what, allowed)), place_(std::move(place)) {}

}  // namespace posewright
