#pragma once

#include <exception>
#include <string>

namespace posewright {

/// What the error says that `work` throws; `none` without one.
template <class Error = std::exception, class Work>
std::string message_of(const Work& work, const std::string& none = "") {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  return none;
}

}  // namespace posewright
