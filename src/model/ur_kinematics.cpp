#include "posewright/model/ur_kinematics.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "posewright/model/placement.hpp"
#include "posewright/model/urdf_reader.hpp"
#include "posewright/support/error.hpp"
#include "urdf_document.hpp"

namespace posewright {
namespace {

/// Link as the file calls it, and the end of the name of the joint that carries it.
constexpr std::array<std::pair<const char*, const char*>, 6> ur_joints = {{{"shoulder", "shoulder_pan_joint"},
                                                                           {"upper_arm", "shoulder_lift_joint"},
                                                                           {"forearm", "elbow_joint"},
                                                                           {"wrist_1", "wrist_1_joint"},
                                                                           {"wrist_2", "wrist_2_joint"},
                                                                           {"wrist_3", "wrist_3_joint"}}};

}  // namespace

UrKinematics ur_kinematics(const SerialArmSpec& arm, const SourcePlace& place, VariantSpec::Convention convention,
                           const std::vector<CalibratedValue>& values, const std::string& hash) {
  const ChainDescription chain = read_urdf_chain(arm, place);
  const ChainCorrection correction = chain_correction(chain, convention, values);
  const UrdfDocument urdf(arm, place);
  UrKinematics result;
  result.text = "kinematics:\n";
  std::size_t next = 0;
  for (const auto& [joint, backward] : urdf.way()) {
    if (!joint->moves()) continue;
    if (backward || next >= ur_joints.size() || !joint->name.ends_with(ur_joints[next].second))
      throw CannotDo(arm.urdf.string() + ": joint '" + joint->name +
                     "' does not belong to a Universal Robots arm (shoulder_pan_joint, shoulder_lift_joint, "
                     "elbow_joint, wrist_1_joint, wrist_2_joint, wrist_3_joint)");
    if (joint->axis.x() != 0 || joint->axis.y() != 0 || !(joint->axis.z() > 0))
      throw CannotDo(arm.urdf.string() + ": joint '" + joint->name +
                     "' does not turn about z: the file is for ur_description's arms, whose joints all do (use --urdf "
                     "for this one)");
    const Eigen::Isometry3d X = joint->X_ParentJoint * correction.joints[next].X;
    const Eigen::Vector3d p = X.translation(), rpy = rpy_of(X.linear());
    result.text += fmt::format("  {}:\n    x: {}\n    y: {}\n    z: {}\n    roll: {}\n    pitch: {}\n    yaw: {}\n",
                               ur_joints[next].first, p.x() + 0.0, p.y() + 0.0, p.z() + 0.0, rpy.x() + 0.0,
                               rpy.y() + 0.0, rpy.z() + 0.0);
    ++next;
  }
  if (next != ur_joints.size())
    throw CannotDo(arm.urdf.string() + " has fewer than the six joints of a Universal Robots arm");
  result.text += "  hash: " + hash + "\n";
  for (const CalibratedValue& v : correction.base.by)
    result.left_out.push_back(left_out_text(v, "the pose of the base is not part of the robot"));
  for (const CalibratedValue& v : correction.tip.by)
    result.left_out.push_back(left_out_text(v, "the file ends at wrist_3"));
  for (const CalibratedValue& v : correction.left_out)
    result.left_out.push_back(left_out_text(v, "the file has no place for it"));
  return result;
}

}  // namespace posewright
