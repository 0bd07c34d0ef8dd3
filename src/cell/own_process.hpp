#pragma once

#include <functional>
#include <stdexcept>
#include <string>

namespace posewright {

/// Error message of a separate process, or its end without a message.
class OwnProcessFailed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The bytes that `work` returns, done in a child process with bounds on memory and time: a damaged file ends the child
/// where a library would end the program. Throws OwnProcessFailed with the message of what `work` throws.
std::string in_own_process(const std::function<std::string()>& work);

}  // namespace posewright
