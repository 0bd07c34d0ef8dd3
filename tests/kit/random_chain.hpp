#pragma once

#include "posewright/model/serial_chain_kinematics.hpp"
#include "posewright/support/random.hpp"

namespace posewright {

inline Eigen::Isometry3d random_pose(Random& random) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.translation() = Eigen::Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  X.linear() =
      Eigen::Quaterniond(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1))
          .normalized()
          .toRotationMatrix();
  return X;
}

/// Six joints with generic geometry; some prismatic; the last one optionally mimics the second; the first three
/// optionally passed backward.
inline ChainDescription random_chain(std::uint64_t seed, bool prismatic, bool mimic, bool backward = false) {
  Random random(seed, 0);
  ChainDescription chain;
  chain.X_MeasureBase = random_pose(random);
  chain.X_LastTip = random_pose(random);
  for (int k = 0; k < 6; ++k) {
    ChainJoint joint;
    joint.name = "j" + std::to_string(k + 1);
    joint.prismatic = prismatic && k % 2 == 1;
    joint.X_ParentJoint = random_pose(random);
    joint.axis = random_pose(random).linear().col(0);
    joint.mimic = mimic && k == 5;
    if (backward && k < 3) joint.X_AboveJoint = joint.X_ParentJoint;
    if (joint.mimic) {
      joint.coordinate = 1;
      joint.multiplier = -0.7;
      joint.offset = 0.3;
    } else {
      joint.coordinate = int(chain.coordinates.size());
      chain.coordinates.push_back({joint.name, joint.prismatic ? "m" : "rad", -2, 2});
      chain.encoder_noise.push_back(0);
    }
    chain.joints.push_back(joint);
  }
  return chain;
}

}  // namespace posewright
