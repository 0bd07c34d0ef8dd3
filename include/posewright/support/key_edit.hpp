#pragma once

#include <string>
#include <vector>

namespace posewright {

/// A key of a problem file and the value in place of the file's, as text: "measurement.device.noise", "0.05 mm".
struct KeyEdit {
  std::string key, value;
  std::string said_by{};  ///< option that states it ("--poses"), for messages; empty: --set
};
using KeyEdits = std::vector<KeyEdit>;

}  // namespace posewright
