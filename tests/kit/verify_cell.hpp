#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace posewright {

/// A cell judged by other code than the program's: kinematics by the URDF tree, meshes by their bytes, distances by FCL
/// objects. Obstacles are boxes,
/// upright cylinders and half spaces.
class CellVerifier {
 public:
  struct Box {
    double size[3], at[3];
  };
  /// Along z.
  struct Cylinder {
    double radius, length, at[3];
  };
  struct Wall {
    double normal[3], at[3];
  };

  /// @param package_root  folder that package:// names are in
  CellVerifier(const std::filesystem::path& urdf, const std::filesystem::path& package_root);
  ~CellVerifier();
  void add(const Box& box);
  void add(const Cylinder& cylinder);
  void add(const Wall& wall);
  /// "link_1 and link_3": not looked at.
  void skip(const std::vector<std::string>& pairs);

  /// What is nearer than `clearance` to an obstacle, or touches another link, at these joint values; empty: nothing.
  std::string violation(const std::map<std::string, double>& joints, double clearance) const;
  /// Smallest distance between what moves and the obstacles, and between the tool and links that it does not hang on,
  /// m.
  /// @param tool  a link of the URDF
  double nearest(const std::map<std::string, double>& joints, const std::string& tool) const;

 private:
  struct Implementation;
  Implementation* implementation_;
};

}  // namespace posewright
