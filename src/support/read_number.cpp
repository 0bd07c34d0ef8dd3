#include "posewright/support/read_number.hpp"

namespace posewright {

std::from_chars_result read_number(const char* first, const char* last, double& value) {
  return std::from_chars(first, last, value);
}

std::from_chars_result read_number(const char* first, const char* last, float& value) {
  return std::from_chars(first, last, value);
}

}  // namespace posewright
