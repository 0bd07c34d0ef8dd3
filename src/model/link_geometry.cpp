#include "posewright/model/link_geometry.hpp"

#include <map>
#include <set>

#include "posewright/model/placement.hpp"
#include "posewright/support/dense.hpp"
#include "urdf_document.hpp"

namespace posewright {
namespace {

enum class ShapesOf { collision, visual };

class LinkCollector {
 public:
  LinkCollector(UrdfDocument urdf, std::filesystem::path folder, const Eigen::Isometry3d& X_MeasureBase,
                ShapesOf wanted = ShapesOf::collision)
      : urdf_(std::move(urdf)), folder_(std::move(folder)), wanted_(wanted) {
    int frame = 0;
    for (const UrdfJoint* joint : urdf_.joints())
      if (joint->moves()) {
        frame_after_[joint] = ++frame;
        if (joint->mimic) masters_.insert(joint->mimic->master);
      }
    // Above the base everything stands where zero position puts it.
    Eigen::Isometry3d X_RootBase = Eigen::Isometry3d::Identity();
    for (const UrdfJoint* joint = urdf_.base().above; joint != nullptr; joint = joint->parent->above)
      X_RootBase = joint->X_ParentJoint * X_RootBase;
    collect(urdf_.tree().root(), 0, X_MeasureBase * X_RootBase.inverse(), "", "");
  }

  std::vector<LinkGeometry> take() { return std::move(links_); }

 private:
  void collect(const UrdfLink& link, int frame, const Eigen::Isometry3d& X_FrameLink, const std::string& parent,
               const std::string& follower) {
    const UrdfTree& tree = urdf_.tree();
    LinkGeometry geometry{link.name, parent, frame, {}, link.place.line, tree.colour(link), follower};
    for (UrdfShape& s : wanted_ == ShapesOf::collision ? tree.collision_shapes(link) : tree.visual_shapes(link))
      geometry.shapes.push_back({in_folder(std::move(s.shape)), X_FrameLink * s.X_LinkShape});
    const bool seen = !geometry.shapes.empty();
    if (seen) links_.push_back(std::move(geometry));
    for (const UrdfJoint* joint : link.below) {
      const auto moved = frame_after_.find(joint);
      const Eigen::Isometry3d X_FrameJoint = X_FrameLink * joint->X_ParentJoint;
      // The frame of a moving joint of the chain is its own; all others hang on the frame before.
      collect(*joint->child, moved == frame_after_.end() ? frame : moved->second,
              moved == frame_after_.end() ? X_FrameJoint : Eigen::Isometry3d::Identity(), seen ? link.name : parent,
              moved == frame_after_.end() && follows_chain(joint) ? joint->name : follower);
    }
  }

  bool follows_chain(const UrdfJoint* at) const {
    std::set<const UrdfJoint*> seen;
    while (at != nullptr && seen.insert(at).second) {
      if (masters_.count(at->name) > 0) return true;
      if (!at->mimic) return false;
      at = urdf_.tree().joint(at->mimic->master);
      if (frame_after_.count(at) > 0) return true;
    }
    return false;
  }

  ShapeSpec in_folder(ShapeSpec shape) const {
    if (auto* mesh = std::get_if<MeshShape>(&shape);
        mesh != nullptr && mesh->file.string().find("://") == std::string::npos)
      mesh->file = folder_ / mesh->file;
    return shape;
  }

  UrdfDocument urdf_;
  std::filesystem::path folder_;
  ShapesOf wanted_;
  std::map<const UrdfJoint*, int> frame_after_;
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
