#pragma once

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "posewright/model/model_factory.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/support/random.hpp"
#include "src/cell/scene.hpp"
#include "tests/kit/temporary_folder.hpp"

/// Arm of small balls among boxes, whose distances have a closed form.
namespace posewright {

// Two joints that turn about z off the origin, a slide along the second link, and a ball on it; another one at the
// elbow.
inline constexpr double shoulder_x = 0.3, shoulder_y = 0.2, upper = 0.5, radius = 0.001;
inline const char* const sliding_arm = R"(<robot name="arm"><link name="base"/><link name="lower"/><link name="tip"/>
  <link name="upper"><collision><origin xyz="0.5 0 0"/><geometry><sphere radius="0.001"/></geometry></collision></link>
  <joint name="j1" type="revolute"><parent link="base"/><child link="upper"/><origin xyz="0.3 0.2 0"/>
    <axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
  <joint name="j2" type="revolute"><parent link="upper"/><child link="lower"/><origin xyz="0.5 0 0"/>
    <axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
  <joint name="j3" type="prismatic"><parent link="lower"/><child link="tip"/><axis xyz="1 0 0"/>
    <limit lower="0.3" upper="0.6" effort="1" velocity="1"/></joint>
</robot>)";

inline Eigen::Vector3d elbow(double q1) {
  return {shoulder_x + upper * std::cos(q1), shoulder_y + upper * std::sin(q1), 0};
}
inline Eigen::Vector3d ball(double q1, double q2, double q3) {
  return {shoulder_x + upper * std::cos(q1) + q3 * std::cos(q1 + q2),
          shoulder_y + upper * std::sin(q1) + q3 * std::sin(q1 + q2), 0};
}

/// Box turned about z, and its distance from points in closed form.
struct Block {
  Eigen::Vector3d half, centre;
  double turned;
  double distance(const Eigen::Vector3d& p) const {
    const Eigen::Vector3d own = Eigen::AngleAxisd(-turned, Eigen::Vector3d::UnitZ()) * (p - centre);
    return (own.cwiseAbs() - half).cwiseMax(0.0).norm();
  }
};

/// Boxes in the plane of the arm, thin and thick.
inline std::vector<Block> drawn_blocks(int count) {
  Random random(21, 0);
  std::vector<Block> blocks;
  for (int i = 0; i < count; ++i) {
    const auto size = [&] { return std::exp(random.uniform(std::log(0.0005), std::log(0.4))); };
    blocks.push_back(
        {{size(), size(), size()}, {random.uniform(-1, 1.6), random.uniform(-1.2, 1.6), 0}, random.uniform(-3, 3)});
  }
  return blocks;
}

/// The arm among blocks b0, b1, …, at one configuration or two of each pose.
struct Workshop {
  explicit Workshop(const std::vector<Block>& blocks, bool two_configurations = true) {
    std::string obstacles;
    for (const Block& b : blocks)
      obstacles += fmt::format(
          "{}{{name: b{}, box: [{:.17g}, {:.17g}, {:.17g}], at: [{:.17g}, {:.17g}, 0], rpy: [0, 0, {:.17g}]}}",
          obstacles.empty() ? "" : ", ", &b - blocks.data(), 2 * b.half.x(), 2 * b.half.y(), 2 * b.half.z(),
          b.centre.x(), b.centre.y(), b.turned);
    folder.write("arm.urdf", sliding_arm);
    problem = read_problem(folder.write(
        "p.yaml", fmt::format("posewright: 1\nrobot: {{urdf: arm.urdf, tip: tip}}\n"
                              "measurement: {{{}, device: {{type: isotropic, noise: 0.1 mm}}}}\nvariants: {{all: "
                              "{{parameters: auto}}}}\nworkspace:\n"
                              "  collision: {{clearance: 1 mm, tool: [{{name: ball, sphere: {}}}], obstacles: [{}]}}\n",
                              two_configurations ? "type: distance, between: configurations, targets: {T: [0.1, 0, 0]}"
                                                 : "type: position, target: [0.1, 0, 0]",
                              radius, obstacles)));
    model = make_model(problem);
    scene = build_scene(problem, *model);
  }
  TemporaryFolder folder;
  Problem problem;
  std::unique_ptr<IdentificationModel> model;
  Scene scene;
};

}  // namespace posewright
