#pragma once

#include <map>
#include <string>
#include <vector>

#include "posewright/problem/read_problem.hpp"
#include "tests/kit/jets.hpp"
#include "tests/kit/plain_urdf.hpp"
#include "tests/kit/temporary_folder.hpp"

/// A torso with a head that has an eye and two short arms, and kinematics of its own.
namespace posewright {

inline constexpr const char* three_tips_urdf = R"(<robot name="three">
  <link name="root"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="torso"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="neck"/>
  <link name="head"><collision><geometry><sphere radius="0.08"/></geometry></collision></link>
  <link name="eye"/>
  <link name="la"><collision><geometry><sphere radius="0.08"/></geometry></collision></link>
  <link name="lh"><collision><geometry><sphere radius="0.08"/></geometry></collision></link>
  <link name="left_hand"/>
  <link name="ra"><collision><geometry><sphere radius="0.08"/></geometry></collision></link>
  <link name="rh"><collision><geometry><sphere radius="0.08"/></geometry></collision></link>
  <joint name="waist" type="revolute"><parent link="root"/><child link="torso"/><origin xyz="0.1 0 0.5" rpy="0 0 0.2"/>
    <axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
  <joint name="pan" type="revolute"><parent link="torso"/><child link="neck"/><origin xyz="0.02 0 0.4" rpy="0.1 0 0"/>
    <axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
  <joint name="tilt" type="revolute"><parent link="neck"/><child link="head"/><origin xyz="0 0.01 0.1" rpy="0 0.2 0"/>
    <axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
  <joint name="mount" type="fixed"><parent link="head"/><child link="eye"/><origin xyz="0.1 0 0.05" rpy="-1.5 0 -1.5"/>
  </joint>
  <joint name="l1" type="revolute"><parent link="torso"/><child link="la"/><origin xyz="0 0.2 0.2" rpy="0.3 0 0"/>
    <axis xyz="0 1 0"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
  <joint name="l2" type="prismatic"><parent link="la"/><child link="lh"/><origin xyz="0.3 0.1 0" rpy="0 0.4 0"/>
    <axis xyz="1 0 0"/><limit lower="-0.1" upper="0.4" effort="1" velocity="1"/></joint>
  <joint name="flange" type="fixed"><parent link="lh"/><child link="left_hand"/><origin xyz="0.1 0 0" rpy="0 0 0.3"/>
  </joint>
  <joint name="r1" type="revolute"><parent link="torso"/><child link="ra"/><origin xyz="0 -0.15 0.2"/>
    <axis xyz="1 0 0"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
  <joint name="r2" type="revolute"><parent link="ra"/><child link="rh"/><origin xyz="0.3 0 -0.3" rpy="0.2 0 0.1"/>
    <axis xyz="0.2 1 0"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
</robot>)";

/// The eye reads both hands, an instrument at the root the right one.
inline constexpr const char* three_tips_problem = R"(posewright: 1
robot: {urdf: three.urdf, tips: {left: left_hand, right: rh, eye: eye}}
measurement:
  - {name: to_left, type: pose, of: left, in: eye, device: {type: isotropic, noise: {position: 0.1 mm, rotation: 0.2 mrad}}, repeatability: 0.1 mm}
  - {name: to_right, type: points, of: right, in: eye, targets: {P: [0.1, 0.2, -0.1], Q: [0, -0.1, 0.2]}, device: {type: isotropic, noise: 0.2 mm}}
  - {name: tracker, type: points, of: right, targets: {R: [0.1, 0, 0.1], S: [0, 0.1, 0.05], T: [0.05, -0.1, 0]}, device: {type: isotropic, noise: 50 um}}
variants:
  offsets: {parameters: [pan.offset, l1.offset, l2.gear, r1.offset], nuisance: ["base.*", "base@eye.*", "target@*", "tool@left.*"]}
workspace: {joints: {margin: 1 deg}}
design: {criterion: o1, poses: 24, candidates: 100, restarts: 1, method: exchange}
)";

struct ThreeTips {
  TemporaryFolder folder;
  PlainUrdf plain;
  Problem problem;

  explicit ThreeTips(const std::string& text = three_tips_problem, const std::string& urdf = three_tips_urdf)
      : plain(folder.write("three.urdf", urdf)), problem(read_problem(folder.write("p.yaml", text))) {}
};

/// Values by name; 0 where there is none.
template <class T>
using ValuesByName = std::map<std::string, T>;

template <class T>
T value_of(const ValuesByName<T>& values, const std::string& name) {
  const auto found = values.find(name);
  return found == values.end() ? T(0.0) : found->second;
}

template <class T>
Frame<T> inverse_of(const Frame<T>& frame) {
  Frame<T> inverse;
  inverse.R = frame.R.transpose();
  inverse.p = -(inverse.R * frame.p);
  return inverse;
}

template <class T>
Frame<T> product_of(const Frame<T>& a, const Frame<T>& b) {
  Frame<T> product;
  product.R = a.R * b.R;
  product.p = a.R * b.p + a.p;
  return product;
}

/// Displacement by NAME.x … NAME.rz, Trans Rz Ry Rx.
template <class T>
Frame<T> displacement_of(const ValuesByName<T>& corrections, const std::string& name) {
  const T d[6] = {value_of(corrections, name + ".x"),  value_of(corrections, name + ".y"),
                  value_of(corrections, name + ".z"),  value_of(corrections, name + ".rx"),
                  value_of(corrections, name + ".ry"), value_of(corrections, name + ".rz")};
  Frame<T> frame;
  frame.then_displace(d);
  return frame;
}

/// Pose of a link in the root by the URDF's own tree: X_ParentJoint · D(NAME.*) · Motion((1 + gear) q + offset).
template <class T>
Frame<T> link_in_root(const PlainUrdf& urdf, const std::string& link, const std::map<std::string, double>& q,
                      const ValuesByName<T>& corrections) {
  const auto found = urdf.above.find(link);
  if (found == urdf.above.end()) return {};
  const PlainUrdf::Joint& joint = found->second;
  Frame<T> frame = link_in_root(urdf, joint.parent, q, corrections);
  frame.then(joint.X_ParentJoint);
  if (joint.type == "fixed") return frame;
  frame = product_of(frame, displacement_of(corrections, joint.name));
  const auto at = q.find(joint.name);
  const double reading = at == q.end() ? 0.0 : at->second;
  const T value =
      (T(1.0) + value_of(corrections, joint.name + ".gear")) * reading + value_of(corrections, joint.name + ".offset");
  const Eigen::Vector3d axis = joint.axis.normalized();
  if (joint.type == "prismatic") frame.then_translate(axis.cast<T>() * value);
  else frame.then_rotate(axis, value);
  return frame;
}

/// The tip seen from a measurement frame: D(base…) · X_RootIn⁻¹ · X_RootOf · D(tool…).
template <class T>
Frame<T> seen_tip(const PlainUrdf& urdf, const std::string& in, const std::string& of, const std::string& base,
                  const std::string& tool, const std::map<std::string, double>& q, const ValuesByName<T>& corrections) {
  const Frame<T> way =
      product_of(inverse_of(link_in_root(urdf, in, q, corrections)), link_in_root(urdf, of, q, corrections));
  return product_of(product_of(displacement_of(corrections, base), way), displacement_of(corrections, tool));
}

/// Joints of a configuration by their names.
inline std::map<std::string, double> joints_of(const std::vector<Coordinate>& coordinates,
                                               const std::vector<double>& q) {
  std::map<std::string, double> joints;
  for (std::size_t i = 0; i < q.size(); ++i)
    if (!coordinates[i].choice()) joints[coordinates[i].name] = q[i];
  return joints;
}

}  // namespace posewright
