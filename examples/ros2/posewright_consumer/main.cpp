// Which points of [-1, 1] determine a parabola best? Theory says -1, 0 and 1.
#include <iostream>
#include <posewright/tasks/select_blocks.hpp>

int main() {
  posewright::BlockFile own{posewright::BlockArray(201, 1, 3), {"1", "x", "x2"}, ""};
  for (int i = 0; i <= 200; ++i) own.blocks.all().row(i) << 1, i / 100.0 - 1, (i / 100.0 - 1) * (i / 100.0 - 1);
  const posewright::SelectOptions options{.poses = 3};
  for (const auto& pose : posewright::select_blocks(std::move(own), options, posewright::Monitor{}).poses)
    std::cout << *pose.candidate / 100.0 - 1 << " ";
}
