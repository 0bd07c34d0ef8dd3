#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
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

/// A tree that begins with a bad design proves the optimum, the same design on any number of threads.
inline void expect_found_from_the_worst(const DesignTask& task, double optimum, std::uint64_t seed) {
  Design first;
  for (const int threads : {1, 3}) {
    Design design;
    design.value = -50.0;
    EXPECT_TRUE(DesignTree(task, threads, Monitor{}, design).run());
    EXPECT_NEAR(design.value, optimum, 2e-9) << seed;
    EXPECT_EQ(design.bound, design.value);
    if (threads == 1) first = design;
    else EXPECT_EQ(design.members, first.members);
  }
}

}  // namespace posewright
