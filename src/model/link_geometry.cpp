#include "posewright/model/link_geometry.hpp"

#include <map>
#include <set>

#include "posewright/model/placement.hpp"
#include "posewright/support/dense.hpp"
#include "urdf_document.hpp"

namespace posewright {
namespace {

Eigen::Vector3d vector_of(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

enum class ShapesOf { collision, visual };

class LinkCollector {
 public:
  LinkCollector(UrdfDocument urdf, std::filesystem::path folder, const Eigen::Isometry3d& X_MeasureBase,
                ShapesOf wanted = ShapesOf::collision)
      : urdf_(std::move(urdf)), folder_(std::move(folder)), wanted_(wanted) {
    int frame = 0;
    for (const auto& joint : urdf_.joints())
      if (joint->type != urdf::Joint::FIXED) {
        frame_after_[joint->name] = ++frame;
        if (joint->mimic != nullptr) masters_.insert(joint->mimic->joint_name);
      }
    if (wanted_ == ShapesOf::collision) urdf_.lines().check_collision_shapes();
    // Above the base everything stands where zero position puts it.
    Eigen::Isometry3d X_RootBase = Eigen::Isometry3d::Identity();
    for (urdf::LinkConstSharedPtr link = urdf_.model().getLink(urdf_.base()); link->parent_joint != nullptr;
         link = urdf_.model().getLink(link->parent_joint->parent_link_name))
      X_RootBase = isometry(link->parent_joint->parent_to_joint_origin_transform) * X_RootBase;
    collect(*urdf_.model().getRoot(), 0, X_MeasureBase * X_RootBase.inverse(), "", "");
  }

  std::vector<LinkGeometry> take() { return std::move(links_); }

 private:
  void collect(const urdf::Link& link, int frame, const Eigen::Isometry3d& X_FrameLink, const std::string& parent,
               const std::string& follower) {
    LinkGeometry geometry{link.name, parent, frame, {}, urdf_.lines().link(link.name).line, colour_of(link), follower};
    const auto add = [&](const auto& elements) {
      for (const auto& element : elements)
        if (element != nullptr && element->geometry != nullptr)
          geometry.shapes.push_back({shape_of(*element->geometry), X_FrameLink * isometry(element->origin)});
    };
    if (wanted_ == ShapesOf::collision) add(link.collision_array);
    else add(link.visual_array);
    const bool seen = !geometry.shapes.empty();
    if (seen) links_.push_back(geometry);
    for (const auto& joint : link.child_joints) {
      const auto moved = frame_after_.find(joint->name);
      const Eigen::Isometry3d X_FrameJoint = X_FrameLink * isometry(joint->parent_to_joint_origin_transform);
      // The frame of a moving joint of the chain is its own; all others hang on the frame before.
      collect(*urdf_.model().getLink(joint->child_link_name), moved == frame_after_.end() ? frame : moved->second,
              moved == frame_after_.end() ? X_FrameJoint : Eigen::Isometry3d::Identity(), seen ? link.name : parent,
              moved == frame_after_.end() && follows_chain(*joint) ? joint->name : follower);
    }
  }

  static std::optional<std::array<double, 3>> colour_of(const urdf::Link& link) {
    if (link.visual == nullptr || link.visual->material == nullptr) return std::nullopt;
    const urdf::Color& c = link.visual->material->color;
    const std::array<double, 3> colour = {c.r, c.g, c.b};
    // A material of a texture, or one that nobody defines, has no colour that was meant.
    if (c.a <= 0 || colour == std::array<double, 3>{}) return std::nullopt;
    return colour;
  }

  bool follows_chain(const urdf::Joint& joint) const {
    std::set<std::string> seen;
    urdf::JointConstSharedPtr at = urdf_.model().getJoint(joint.name);
    while (at != nullptr && seen.insert(at->name).second) {
      if (masters_.count(at->name) > 0) return true;
      if (at->mimic == nullptr) return false;
      if (frame_after_.count(at->mimic->joint_name) > 0) return true;
      at = urdf_.model().getJoint(at->mimic->joint_name);
    }
    return false;
  }

  ShapeSpec shape_of(const urdf::Geometry& geometry) const {
    if (const auto* box = dynamic_cast<const urdf::Box*>(&geometry)) return BoxShape{vector_of(box->dim)};
    if (const auto* cylinder = dynamic_cast<const urdf::Cylinder*>(&geometry))
      return CylinderShape{cylinder->radius, cylinder->length};
    if (const auto* sphere = dynamic_cast<const urdf::Sphere*>(&geometry)) return SphereShape{sphere->radius};
    const auto& mesh = dynamic_cast<const urdf::Mesh&>(geometry);
    const bool elsewhere = mesh.filename.find("://") != std::string::npos;
    return MeshShape{elsewhere ? std::filesystem::path(mesh.filename) : folder_ / mesh.filename, vector_of(mesh.scale)};
  }

  UrdfDocument urdf_;
  std::filesystem::path folder_;
  ShapesOf wanted_;
  std::map<std::string, int> frame_after_;
  std::set<std::string> masters_;  // joints that those of the chain follow, in it or not
  std::vector<LinkGeometry> links_;
};

}  // namespace

std::vector<LinkGeometry> read_urdf_links(const SerialArmSpec& arm, const SourcePlace& place) {
  return LinkCollector(UrdfDocument(arm, place), arm.urdf.parent_path(), isometry(arm.placement)).take();
}

std::vector<LinkGeometry> read_urdf_visuals(const SerialArmSpec& arm, const SourcePlace& place) {
  return LinkCollector(UrdfDocument(arm, place), arm.urdf.parent_path(), isometry(arm.placement), ShapesOf::visual)
      .take();
}

std::vector<LinkGeometry> read_urdf_still(const std::filesystem::path& file) {
  return LinkCollector(UrdfDocument(file), file.parent_path(), Eigen::Isometry3d::Identity()).take();
}

}  // namespace posewright
