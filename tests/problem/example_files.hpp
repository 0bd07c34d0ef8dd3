#pragma once

#include <string>

/// Complete problem files that use every key; the tests name their lines, which start with 1 at `posewright`.
namespace posewright::example {

inline const std::string serial =
    R"(posewright: 1
robot:
  urdf: kr270.urdf
  base: base_link
  tip: flange
  placement: {position: [1, "20 mm", 0], rpy: [0, 0, "90 deg"]}
  encoder_noise: "0.001 deg"
  parameter_names: {px1: joint_a2.x, py1: joint_a2.y}
measurement:
  type: points
  targets:
    P1: ["277.23 mm", "-46.53 mm", "-93.87 mm"]
    P2: [0.27649, -0.04825, 0.09405]
  components: [z, x]
  device: {type: isotropic, noise: "0.1 mm"}
  repeats: 3
  repeatability: "30 um"
variants:
  geometric:
    parameters: [px1, "joint_2.*"]
    nuisance: ["base.*"]
    fixed: ["base.rz"]
    tolerance: {"*.x": "0.5 mm", "*.offset": "0.05 deg", "*.gear": 0.001}
  everything:
    parameters: auto
workspace:
  joints:
    margin: "5 deg"
    margin_length: "1 mm"
    limits: {joint_a1: ["-90 deg", "90 deg"], rail: [0, "3 m"], joint_a2: [-1, 1.5]}
design:
  variant: everything
  criterion: o3
  method: greedy
  poses: 18
  candidates: 20000
  restarts: 7
  repeats: allow
)";

inline const std::string six_pus =
    R"(posewright: 1
robot:
  model: six_pus
  reference: {position: [0, 0, "483.7 mm"], rpy: [0, 0, "10 mrad"]}
  actuators: {travel: ["-1.3 mm", "1.3 mm"], noise: "1 um"}
  legs:
    - {a: ["100 mm", 0, 0], b: [0.05, 0, 0], u: [0, 0, 2], l: "500 mm"}
    - {a: {radius: "150 mm", angle: "90 deg", z: "2 mm"}, b: {radius: 0.1, angle: 0}, l: 0.5}
    - {a: [0, 0.1, 0], b: [0, 0.05, 0], l: 0.5}
    - {a: [0, 0.1, 0], b: [0, 0.05, 0], l: 0.5}
    - {a: [0, 0.1, 0], b: [0, 0.05, 0], l: 0.5}
    - {a: [0, 0.1, 0], b: [0, 0.05, 0], l: 0.5}
measurement:
  type: pose
  components: [rz, x]
  device: {type: isotropic, noise: {position: "0.1 mm", rotation: "0.1 mrad"}}
variants:
  legs:
    parameters: ["leg*"]
workspace:
  pose: {rz: ["-6 deg", "6 deg"], x: ["-2 mm", "2 mm"], y: [-3e-3, 3e-3], z: [-0.1, 0.1], rx: [-0.1, 0.1], ry: [-0.2, 0.1]}
)";

/// `text` with the first `from` replaced; an absent `from` is a mistake in the test.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);  // throws std::out_of_range
}

}  // namespace posewright::example
