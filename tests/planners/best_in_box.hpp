#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "planners/design_tree.hpp"
#include "posewright/planning/design_task.hpp"

namespace posewright {

/// Best of all designs in a box, by enumeration.
inline double best_in_box(const DesignTask& task, const ChoiceBox& box, std::size_t first, std::vector<int>& members) {
  double best = -std::numeric_limits<double>::infinity();
  if (first == box.least.size())
    return int(members.size()) == task.poses ? task.criterion->start(task.candidates, members)->value() : best;
  const std::vector<int> before = members;
  for (int count = box.least[first]; count <= box.most[first]; ++count) {
    members = before;
    members.insert(members.end(), std::size_t(count), int(first));
    if (int(members.size()) <= task.poses) best = std::max(best, best_in_box(task, box, first + 1, members));
  }
  members = before;
  return best;
}

}  // namespace posewright
