#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "posewright/model/identification_model.hpp"

namespace posewright {

/// One moving joint; the fixed joints before it are merged into X_ParentJoint.
struct ChainJoint {
  std::string name;
  bool prismatic = false;
  Eigen::Isometry3d X_ParentJoint = Eigen::Isometry3d::Identity();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< unit, joint frame
  int coordinate = 0;                               ///< index into the configuration
  double multiplier = 1.0, offset = 0.0;            ///< of a mimic joint
  bool mimic = false;
  /// Origin in the URDF, behind the moving joint above it, of a joint that the chain passes backward, from child to
  /// parent. Its displacement, which has the sense of the URDF, then stands inverse behind the motion.
  std::optional<Eigen::Isometry3d> X_AboveJoint{};
  double mass = 0.0;  ///< kg, of all links that this joint carries up to the next one
  Eigen::Vector3d centre_of_mass = Eigen::Vector3d::Zero();  ///< m, frame of the moved joint

  bool backward() const { return X_AboveJoint.has_value(); }
};

/// Moving joints of the longest chain that is accepted.
inline constexpr std::size_t max_joints = 64;

/// A serial chain from base to tip.
struct ChainDescription {
  Eigen::Isometry3d X_MeasureBase = Eigen::Isometry3d::Identity();
  std::vector<ChainJoint> joints;
  Eigen::Isometry3d X_LastTip = Eigen::Isometry3d::Identity();
  std::vector<Coordinate> coordinates;
  std::vector<double> encoder_noise;  ///< 1σ per coordinate
  std::string robot{};                ///< as its URDF calls it
};

/// Position of each parameter of a serial chain: base (6), per joint displacement (6), offset and gear of each
/// coordinate's own joint, tool (6).
struct ChainLayout {
  explicit ChainLayout(const ChainDescription& chain);
  std::vector<int> displacement;  ///< per joint: index of NAME.x
  std::vector<int> offset;        ///< per coordinate: index of NAME.offset; gear follows
  int tool = 0;                   ///< index of tool.x
  int count = 0;
};

/// Rotation and translation in a scalar of its own, for differentiation.
template <class T>
struct Frame {
  Eigen::Matrix<T, 3, 3> R = Eigen::Matrix<T, 3, 3>::Identity();
  Eigen::Matrix<T, 3, 1> p = Eigen::Matrix<T, 3, 1>::Zero();

  void then(const Eigen::Isometry3d& X) {
    p += R * X.translation().cast<T>();
    R = (R * X.linear().cast<T>()).eval();
  }
  void then_translate(const Eigen::Matrix<T, 3, 1>& t) { p += R * t; }
  /// The frame of a joint, moved as its coordinate says.
  void then_joint(const ChainJoint& joint, const T& coordinate) {
    then(joint.X_ParentJoint);
    const T value = joint.multiplier * coordinate + joint.offset;
    if (joint.prismatic) then_translate(joint.axis.cast<T>() * value);
    else then_rotate(joint.axis, value);
  }
  /// R ← R · (rotation about the unit axis a), Rodrigues: I + sin K + (1 − cos) (a aᵀ − I), K x = a × x.
  void then_rotate(const Eigen::Vector3d& axis, const T& angle) {
    using std::cos, std::sin;
    const double x = axis.x(), y = axis.y(), z = axis.z();
    const T c = cos(angle), s = sin(angle), v = T(1.0) - c;
    Eigen::Matrix<T, 3, 3> rotation;
    rotation << c + x * x * v, x * y * v - z * s, x * z * v + y * s,  //
        x * y * v + z * s, c + y * y * v, y * z * v - x * s,          //
        x * z * v - y * s, y * z * v + x * s, c + z * z * v;
    R = (R * rotation).eval();
  }
  /// Displacement D = Trans(x, y, z) Rz(rz) Ry(ry) Rx(rx), the convention of URDF origins.
  void then_displace(const T* d) {
    then_translate({d[0], d[1], d[2]});
    then_rotate(Eigen::Vector3d::UnitZ(), d[5]);
    then_rotate(Eigen::Vector3d::UnitY(), d[4]);
    then_rotate(Eigen::Vector3d::UnitX(), d[3]);
  }
  /// D⁻¹ of the same.
  void then_take_back(const T* d) {
    Frame displacement;
    displacement.then_displace(d);
    R = (R * displacement.R.transpose()).eval();
    p -= R * displacement.p;
  }
};

}  // namespace posewright
