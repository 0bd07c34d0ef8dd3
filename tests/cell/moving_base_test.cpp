// The cell of a base that joints of the way move: what stands in it, stands in the robot's root.

#include <gtest/gtest.h>

#include "posewright/cell/cell.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/support/random.hpp"
#include "src/cell/scene.hpp"
#include "tests/kit/plain_urdf.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

/// Two arms of two joints on a torso; every link is a ball about its origin.
const char* const tree = R"(<robot name="tree">
  <link name="root"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="torso"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="la"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="lh"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="ra"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="rh"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <joint name="waist" type="revolute"><parent link="root"/><child link="torso"/><origin xyz="0.1 0 0.5" rpy="0 0 0.2"/>
    <axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
  <joint name="l1" type="revolute"><parent link="torso"/><child link="la"/><origin xyz="0 0.4 0.2" rpy="0.3 0 0"/>
    <axis xyz="0 1 0"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
  <joint name="l2" type="prismatic"><parent link="la"/><child link="lh"/><origin xyz="0.3 0.1 0" rpy="0 0.4 0"/>
    <axis xyz="1 0 0"/><limit lower="-0.1" upper="0.5" effort="1" velocity="1"/></joint>
  <joint name="r1" type="revolute"><parent link="torso"/><child link="ra"/><origin xyz="0 -0.4 0.2"/>
    <axis xyz="1 0 0"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
  <joint name="r2" type="revolute"><parent link="ra"/><child link="rh"/><origin xyz="0.3 0 -0.3"/>
    <axis xyz="0 1 0"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
</robot>)";

constexpr double waist = 0.4, clearance = 0.02;
const Eigen::Vector3d ball_in_root(0.5, 0.1, 0.7), ball_in_base(0.3, 0.1, -0.2);

class MovingBase : public testing::Test {
 protected:
  MovingBase() : plain(folder.write("tree.urdf", tree)) {
    cell = make_cell(read_problem(folder.write(
        "p.yaml",
        "posewright: 1\nrobot: {urdf: tree.urdf, base: lh, tip: rh, hold: {waist: 0.4}}\n"
        "measurement: {type: position, target: [0.1, 0, 0], device: {type: laser_tracker, stations: {A: [3, 0, 0]}}}\n"
        "variants: {all: {parameters: auto}}\nworkspace:\n  collision:\n    self: no\n    clearance: 20 mm\n"
        "    obstacles:\n"
        "    - {name: ball, sphere: 0.1, at: [0.5, 0.1, 0.7]}\n"
        "    - {name: floor, plane: [0, 0, 1], at: [0, 0, 0.2]}\n"
        "    - {name: tracker, station: A, sphere: 0.05, at: [0.3, 0.1, -0.2]}\n")));
  }

  std::vector<double> drawn(Random& random) const {
    std::vector<double> q;
    for (const Coordinate& c : cell->model->coordinates()) q.push_back(random.uniform(c.lower, c.upper));
    return q;
  }

  /// Least distance of a link that moves from an obstacle, by multiplied transforms.
  double room(const std::vector<double>& q) const {
    std::map<std::string, double> joints{{"waist", waist}};
    for (std::size_t i = 0; i < q.size(); ++i) joints[cell->model->coordinates()[i].name] = q[i];
    const Eigen::Isometry3d base = plain.pose("lh", joints);
    double least = 1e9;
    for (const char* link : {"la", "lh", "ra", "rh"}) {
      const Eigen::Vector3d p = plain.pose(link, joints).translation();
      least = std::min({least, (p - ball_in_root).norm() - 0.2, p.z() - 0.2 - 0.1});
    }
    // An instrument's own body rides on the base.
    for (const char* link : {"root", "torso", "la", "ra", "rh"})
      least = std::min(least, (base.inverse() * plain.pose(link, joints).translation() - ball_in_base).norm() - 0.15);
    return least;
  }

  TemporaryFolder folder;
  PlainUrdf plain;
  std::shared_ptr<const Cell> cell;
};

TEST_F(MovingBase, HasObstaclesWhereTheRootIs) {
  Random random(1, 0);
  int hit = 0, free = 0;
  for (int i = 0; i < 3000; ++i) {
    const std::vector<double> q = drawn(random);
    const double spare = room(q) - clearance - motion_resolution;
    if (std::abs(spare) < 1e-6) continue;
    EXPECT_EQ(cell->collision->violation(q) >= 0, spare < 0);
    (spare < 0 ? hit : free) += 1;
  }
  EXPECT_GT(hit, 300);
  EXPECT_GT(free, 300);
}

TEST_F(MovingBase, KeepsOffThemOnTheWholeWay) {
  Random random(2, 0);
  int moved = 0, stopped = 0;
  for (int i = 0; i < 400; ++i) {
    const std::vector<double> from = drawn(random), to = drawn(random);
    double least = 1e9;
    std::vector<double> q = from;
    for (int step = 0; step <= 1000; ++step) {
      for (std::size_t k = 0; k < q.size(); ++k) q[k] = from[k] + step / 1000.0 * (to[k] - from[k]);
      least = std::min(least, room(q));
    }
    const bool free = cell->collision->motion_is_free(from, to);
    // Between two of our states a link moves by a few millimetres.
    if (free) EXPECT_GT(least, clearance - 1e-6);
    else EXPECT_LT(least, clearance + 2 * motion_resolution + 0.01);
    (free ? moved : stopped) += 1;
  }
  EXPECT_GT(moved, 20);
  EXPECT_GT(stopped, 100);
}

}  // namespace
}  // namespace posewright
