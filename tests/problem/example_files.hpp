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

/// Every key of a cell.
inline const std::string cell =
    R"(posewright: 1
robot: {urdf: arm.urdf, base: base, tip: tip}
measurement:
  type: points
  targets: {P1: [0, 0, 0.1], P2: [0, 0.1, 0]}
  device: {type: laser_tracker, stations: {A: [3, 0, 1]}}
variants: {all: {parameters: auto}}
workspace:
  joints:
    coupled: [{sum: {j2: 1, j3: -1}, range: ["-90 deg", "60 deg"]}]
  tool: {point: [0, 0, 0.1], z: [0, "2 m"]}
  singularity: {smallest: 0.05, length: "500 mm"}
  uncalibrated: 3
  samplers: {even: 2, boundary: 1, obstacle_based: 1, gaussian: 1, clearance: 0}
  collision:
    self: true
    clearance: "20 mm"
    self_clearance: 0
    hulls: false
    srdf: arm.srdf
    ignore: [[upper, hand]]
    tool: [{name: hand, cylinder: {radius: 0.1, length: 0.2}, at: [0, 0, 0.1]}]
    obstacles:
      - {name: table, box: [1, 2, "50 mm"], at: [0, 0, -0.1], rpy: [0, 0, "30 deg"]}
      - {name: floor, plane: [0, 0, 2]}
      - {mesh: wall.stl, scale: 0.001, station: A}
  line_of_sight:
    visible: 1
    range: ["0.5 m", 20]
    elevation: ["-60 deg", "77 deg"]
    azimuth: [-2, 2]
    field_of_view: {axis: [0, 0, 1], half_angle: "40 deg"}
    acceptance: "30 deg"
    normals: {P1: [0, 0, 1], "*": [1, 0, 0]}
    beam: "4 mm"
    target_radius: "19 mm"
    references: {R1: [1, 1, 0]}
    every: 5
  stations:
    choose: 1
    box: {x: [1, 3], y: [-1, 1], z: 0.5, points: [3, 2, 1]}
  motion:
    velocity: {j1: "100 deg/s"}
    acceleration: {j1: "3 rad/s2"}
    home: {j2: "-90 deg"}
    speed: 0.5
    settle: "5 s"
    station_change: "10 min"
    load_change: 60
    reachable: true
)";

/// `text` with the first `from` replaced; an absent `from` is a mistake in the test.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);  // throws std::out_of_range
}

}  // namespace posewright::example
