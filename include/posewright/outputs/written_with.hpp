#pragma once

#include <string>

namespace posewright {

/// A file that was written together with a plan or route, so that a later run knows it again.
struct WrittenWith {
  std::string path;    ///< as seen from the folder of the plan
  std::string sha256;  ///< of its bytes, lower-case hexadecimal
};

}  // namespace posewright
