#include "euler_angles.hpp"

#include <algorithm>

namespace posewright {

std::vector<EulerAngles> euler_angles_of(const std::vector<std::string>& columns) {
  const auto has = [&](const std::string& name) {
    return std::find(columns.begin(), columns.end(), name) != columns.end();
  };
  std::vector<EulerAngles> found;
  for (const bool moving : {false, true})
    for (int code = 0; code < 27; ++code) {
      EulerAngles angles{{moving, {code / 9, code / 3 % 3, code % 3}}, {}};
      if (angles.axes[0] == angles.axes[1] || angles.axes[1] == angles.axes[2]) continue;
      for (std::size_t k = 0; k < 3; ++k) angles.columns[k] = "pose." + angles.name() + "." + std::to_string(k + 1);
      if (std::all_of(angles.columns.begin(), angles.columns.end(), has)) found.push_back(std::move(angles));
    }
  return found;
}

}  // namespace posewright
