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
    Place at{0, X_MeasureBase}, top = at;
    const UrdfLink* highest = &urdf_.base();
    for (const auto& step : urdf_.way()) {
      if (!step.joint->moves()) {
        at.X_FrameLink = at.X_FrameLink * step.origin();
      } else {
        if (step.backward) placed_[step.joint->child] = at;
        at = {at.frame + 1, step.backward ? step.origin() : Eigen::Isometry3d::Identity()};
        if (!step.backward) placed_[step.joint->child] = at;
        moving_.insert(step.joint);
        if (step.joint->mimic) masters_.insert(step.joint->mimic->master);
      }
      if (step.backward) top = at, highest = step.joint->parent;
    }
    // Above the highest link everything stands where zero position puts it.
    Eigen::Isometry3d X_RootHighest = Eigen::Isometry3d::Identity();
    for (const UrdfJoint* joint = highest->above; joint != nullptr; joint = joint->parent->above)
      X_RootHighest = joint->X_ParentChild() * X_RootHighest;
    root_ = {top.frame, top.X_FrameLink * X_RootHighest.inverse()};
  }
  /// Of an arm with several ways.
  LinkCollector(UrdfDocument urdf, std::filesystem::path folder, ShapesOf wanted)
      : urdf_(std::move(urdf)), folder_(std::move(folder)), wanted_(wanted) {
    for (const UrdfJoint* joint : urdf_.moving()) {
      placed_[joint->child] = {int(placed_.size()) + 1, Eigen::Isometry3d::Identity()};
      moving_.insert(joint);
      if (joint->mimic) masters_.insert(joint->mimic->master);
    }
  }

  std::vector<LinkGeometry> links() {
    collect(urdf_.tree().root(), root_, "", "");
    return std::move(links_);
  }
  RootPlace root() const { return {root_.frame, root_.X_FrameLink}; }

 private:
  struct Place {
    int frame = 0;
    Eigen::Isometry3d X_FrameLink = Eigen::Isometry3d::Identity();
  };

  void collect(const UrdfLink& link, const Place& at, const std::string& parent, const std::string& follower) {
    const UrdfTree& tree = urdf_.tree();
    LinkGeometry geometry{link.name, parent, at.frame, {}, link.place.line, tree.colour(link), follower};
    for (UrdfShape& s : wanted_ == ShapesOf::collision ? tree.collision_shapes(link) : tree.visual_shapes(link))
      geometry.shapes.push_back({in_folder(std::move(s.shape)), at.X_FrameLink * s.X_LinkShape});
    const bool seen = !geometry.shapes.empty();
    if (seen) links_.push_back(std::move(geometry));
    for (const UrdfJoint* joint : link.below) {
      // A joint of the way may put a link on another frame; all others hang on that of the link before.
      const auto placed = placed_.find(joint->child);
      collect(*joint->child,
              placed == placed_.end() ? Place{at.frame, at.X_FrameLink * joint->X_ParentChild()} : placed->second,
              seen ? link.name : parent, placed == placed_.end() && follows_chain(joint) ? joint->name : follower);
    }
  }

  bool follows_chain(const UrdfJoint* at) const {
    std::set<const UrdfJoint*> seen;
    while (at != nullptr && seen.insert(at).second) {
      if (masters_.count(at->name) > 0) return true;
      if (!at->mimic) return false;
      at = urdf_.tree().joint(at->mimic->master);
      if (moving_.count(at) > 0) return true;
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
  Place root_;
  std::map<const UrdfLink*, Place> placed_;  // by the way's joints that move
  std::set<const UrdfJoint*> moving_;        // these joints
  std::set<std::string> masters_;            // joints that those of the chain follow, in it or not
  std::vector<LinkGeometry> links_;
};

}  // namespace

namespace {

std::vector<LinkGeometry> links_with(ShapesOf wanted, const SerialArmSpec& arm, const SourcePlace& place) {
  const std::filesystem::path folder = arm.urdf.parent_path();
  if (!arm.ways.empty()) return LinkCollector(UrdfDocument(arm, place), folder, wanted).links();
  return LinkCollector(UrdfDocument(arm, place), folder, isometry(arm.placement), wanted).links();
}

}  // namespace

std::vector<LinkGeometry> read_urdf_links(const SerialArmSpec& arm, const SourcePlace& place) {
  return links_with(ShapesOf::collision, arm, place);
}

std::vector<LinkGeometry> read_urdf_visuals(const SerialArmSpec& arm, const SourcePlace& place) {
  return links_with(ShapesOf::visual, arm, place);
}

RootPlace root_place(const SerialArmSpec& arm, const SourcePlace& place) {
  if (!arm.ways.empty()) return {};
  return LinkCollector(UrdfDocument(arm, place), {}, isometry(arm.placement)).root();
}

std::vector<LinkGeometry> read_urdf_still(const std::filesystem::path& file) {
  return LinkCollector(UrdfDocument(file), file.parent_path(), Eigen::Isometry3d::Identity()).links();
}

}  // namespace posewright
