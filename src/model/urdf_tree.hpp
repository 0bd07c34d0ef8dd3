#pragma once

#include <Eigen/Geometry>
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "posewright/problem/cell_specs.hpp"
#include "posewright/support/error.hpp"

namespace tinyxml2 {
class XMLDocument;
class XMLElement;
}  // namespace tinyxml2

namespace posewright {

struct UrdfLink;

struct UrdfLimits {
  double lower = 0.0, upper = 0.0, velocity = 0.0;
};

struct UrdfMimic {
  std::string master;
  double multiplier = 1.0, offset = 0.0;
};

struct UrdfJoint {
  enum class Type { revolute, continuous, prismatic, fixed, floating, planar };

  std::string name;
  SourcePlace place;
  std::size_t index = 0;  ///< among the joints of the file
  Type type = Type::fixed;
  const UrdfLink *parent = nullptr, *child = nullptr;
  Eigen::Isometry3d X_ParentJoint = Eigen::Isometry3d::Identity();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  ///< as the file has it
  std::optional<UrdfLimits> limits{};
  double soft_lower = 0.0, soft_upper = 0.0;  ///< of <safety_controller>; both 0: none
  std::optional<UrdfMimic> mimic{};
  std::optional<double> held{};  ///< rad or m: where it stays, by the user's word or its master's

  bool moves() const { return type != Type::fixed && !held; }
  /// Revolute, continuous or prismatic.
  bool has_axis() const { return type == Type::revolute || type == Type::continuous || type == Type::prismatic; }
  /// Pose of the child in the parent: where the joint is held, else at zero.
  Eigen::Isometry3d X_ParentChild() const;
};

struct UrdfLink {
  std::string name;
  SourcePlace place;
  const tinyxml2::XMLElement* element = nullptr;
  double mass = 0.0;
  Eigen::Vector3d centre_of_mass = Eigen::Vector3d::Zero();
  const UrdfJoint* above = nullptr;       ///< null: the root
  std::vector<const UrdfJoint*> below{};  ///< in the order of their names
};

struct UrdfShape {
  ShapeSpec shape;  ///< a mesh file as the URDF names it
  Eigen::Isometry3d X_LinkShape = Eigen::Isometry3d::Identity();
};

/// All links and joints of a URDF. Pointers stay valid when the tree is moved.
class UrdfTree {
 public:
  /// Throws InputError with the line for a text that is no URDF or no tree with one root, and for numbers of links and
  /// joints that are malformed or not finite. Shapes are judged when they are asked for.
  UrdfTree(const std::string& text, const std::string& file);
  UrdfTree(UrdfTree&&) noexcept;
  ~UrdfTree();

  const std::string& robot() const { return robot_; }
  const UrdfLink& root() const { return *root_; }
  const std::map<std::string, UrdfLink>& links() const { return links_; }
  const std::map<std::string, UrdfJoint>& joints() const { return joints_; }
  /// Null if there is none of that name.
  const UrdfLink* link(const std::string& name) const;
  const UrdfJoint* joint(const std::string& name) const;

  /// Joints stay at these values, rad or m by name, and those that follow them where these put them. Each has an axis
  /// and follows no other.
  void hold(const std::map<std::string, double>& values);

  /// Throws InputError for a shape that is malformed, unknown or not of positive size.
  std::vector<UrdfShape> collision_shapes(const UrdfLink& link) const;
  /// Shapes that are only seen: those without a known geometry are passed over.
  std::vector<UrdfShape> visual_shapes(const UrdfLink& link) const;
  /// Red, green and blue (0 to 1) of a link's first visual, if its material gives any.
  std::optional<std::array<double, 3>> colour(const UrdfLink& link) const;

 private:
  using Colour = std::optional<std::array<double, 3>>;

  void read_links(const tinyxml2::XMLElement& robot);
  void read_joints(const tinyxml2::XMLElement& robot);
  void read_materials(const tinyxml2::XMLElement& robot);
  const UrdfLink* end_of(const tinyxml2::XMLElement& joint, const std::string& name, const char* end) const;
  void find_root();

  std::string file_, robot_;
  std::unique_ptr<tinyxml2::XMLDocument> document_;
  std::map<std::string, UrdfLink> links_;
  std::map<std::string, UrdfJoint> joints_;
  std::map<std::string, Colour> materials_;  // by name; a texture has no colour
  const UrdfLink* root_ = nullptr;
};

}  // namespace posewright
