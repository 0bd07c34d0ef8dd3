#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "posewright/problem/problem.hpp"

namespace posewright {

/// Collision shape of a link in the URDF, placed in its frame.
struct LinkShape {
  ShapeSpec shape;  ///< mesh files as the URDF names them, other paths resolved against the URDF's folder
  Eigen::Isometry3d X_FrameShape = Eigen::Isometry3d::Identity();
};

struct LinkGeometry {
  std::string name;
  std::string parent;  ///< nearest link above it that has a shape; empty: none
  /// 0: the measurement frame, k: frame of the chain's k-th joint after its motion. Of an arm with several ways those
  /// of UrdfFrames.
  int frame = 0;
  std::vector<LinkShape> shapes;
  int line = 0;                                   ///< of <link> in the URDF
  std::optional<std::array<double, 3>> colour{};  ///< of its first visual: red, green, blue, 0 to 1
  std::string follower{};  ///< joint beside the chain that moves the link with one of the chain's joints; empty: none
};

/// All links with a <collision> shape, also those beside the way from base to tip, which hang where their
/// joints are held, else at zero position (those of a follower move in truth: `follower` names it).
/// Throws InputError as read_urdf_chain, and for shapes whose numbers are malformed.
std::vector<LinkGeometry> read_urdf_links(const SerialArmSpec& arm, const SourcePlace& place);

/// All links with a <visual> shape, as read_urdf_links; with their shapes in `shapes`.
std::vector<LinkGeometry> read_urdf_visuals(const SerialArmSpec& arm, const SourcePlace& place);

/// The frame of the chain that carries the URDF's root link, as LinkGeometry::frame, and where the root is in it; of an
/// arm with several ways its own.
struct RootPlace {
  int frame = 0;
  Eigen::Isometry3d X_FrameRoot = Eigen::Isometry3d::Identity();

  /// Joints on the way from base to tip move the base in the root, which stands.
  bool base_moves() const { return frame > 0; }
};
RootPlace root_place(const SerialArmSpec& arm, const SourcePlace& place);

/// Variant for a file of surroundings, all joints at zero position, in the frame of its
/// root.
std::vector<LinkGeometry> read_urdf_still(const std::filesystem::path& file);

}  // namespace posewright
