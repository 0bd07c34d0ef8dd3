#include "sdf_frames.hpp"

#include "posewright/support/text.hpp"

namespace posewright {
namespace {

constexpr const char* world = "world";
constexpr const char* frames_allowed = "frames that form a tree";
constexpr int deepest = 100;  // placement frames of models in models

}  // namespace

std::string SdfScope::full(const std::string& name, const std::string& otherwise) const {
  if (name.empty()) return otherwise;
  if (name == "__model__" || (name == world && prefix.empty())) return own;
  return prefix + name;
}

void SdfFrames::add(const std::string& frame, const std::string& base, const Eigen::Isometry3d& X,
                    const SdfElement& element, const std::string& placement, const std::string& inner) {
  if (!frames_.emplace(frame, Frame{base, X, element, placement, inner}).second || frame == world)
    element.fail("the name " + in_quotes(frame) + " is taken", "a name of its own for each model, link and frame");
}

std::vector<const SdfFrames::Named*> SdfFrames::way(const std::string& frame, const std::string& root,
                                                    const SdfElement& asked) const {
  std::vector<const Named*> way;
  std::string at = frame;
  while (at != root && (root != world || in_world_.count(at) == 0)) {
    const SdfElement& by = way.empty() ? asked : way.back()->second.element;
    const auto found = frames_.find(at);
    if (found == frames_.end())
      by.fail("the frame " + in_quotes(at) + " is not there",
              "a model, link, joint or frame of the same level, or one below (MODEL::LINK)");
    if (way.size() == frames_.size()) by.fail("the pose of " + in_quotes(at) + " depends on itself", frames_allowed);
    way.push_back(&*found);
    at = found->second.base;
  }
  return way;
}

Eigen::Isometry3d SdfFrames::in_base(const Frame& frame, int depth) const {
  if (frame.placement.empty()) return frame.X;
  if (depth == 0) frame.element.fail("the placement frame depends on itself", frames_allowed);
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  for (const Named* named : way(frame.placement, frame.inner, frame.element)) X = in_base(named->second, depth - 1) * X;
  return frame.X * X.inverse();
}

Eigen::Isometry3d SdfFrames::in_world(const std::string& frame, const SdfElement& asked) {
  const std::vector<const Named*> open = way(frame, world, asked);
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  const std::string& top = open.empty() ? frame : open.back()->second.base;
  if (const auto known = in_world_.find(top); known != in_world_.end()) X = known->second;
  for (auto at = open.rbegin(); at != open.rend(); ++at) {
    X = X * in_base((*at)->second, deepest);
    in_world_[(*at)->first] = X;
  }
  return X;
}

}  // namespace posewright
