// Jacobian blocks of one's own: which points of [-1, 1] determine a parabola best? Theory says -1, 0 and 1.
#include <iostream>
#include <posewright/tasks/select_blocks.hpp>

int main() {
  constexpr int points = 201;
  posewright::BlockFile own{posewright::BlockArray(points, 1, 3), {"1", "x", "x2"}, ""};
  for (int i = 0; i < points; ++i) {
    const double x = -1 + 2.0 * i / (points - 1);
    own.blocks.all().row(i) << 1, x, x * x;  // one reading of unit noise; blocks of r rows lie below each other
  }
  posewright::SelectOptions options;
  options.poses = 3;
  const posewright::Plan plan = posewright::select_blocks(std::move(own), options, posewright::Monitor{});
  for (const posewright::PlannedPose& pose : plan.poses) std::cout << -1 + 2.0 * *pose.candidate / (points - 1) << " ";
  std::cout << "log det " << plan.log_det << ", at least " << plan.certificate.efficiency << " of the best\n";
}
