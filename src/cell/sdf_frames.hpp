#pragma once

#include <map>

#include "sdf_element.hpp"

namespace posewright {

/// Scope of names: those of a model or world, and the default frame of a pose.
struct SdfScope {
  std::string prefix;  ///< "MODEL::" of a model in its world, "" of the world
  std::string own;     ///< full name of the model's frame, or "world"
  std::string model;   ///< full name of the model that links here belong to

  /// The full name of what is called `name` here; `otherwise` if that is "".
  std::string full(const std::string& name, const std::string& otherwise) const;
  std::string full(const std::string& name) const { return full(name, own); }
};

/// The frames of a world by their full names (`model::link`), each placed in another one, added in any order.
/// Source: SDFormat specification, "Pose frame semantics" (version 1.9).
class SdfFrames {
 public:
  bool has(const std::string& name) const { return frames_.count(name) > 0; }
  /// `frame` is at X in `base`, or, if `placement` is not "", where that frame, which hangs on `inner`, is at X.
  /// @param element  that states it, for errors. Throws InputError if the name is taken.
  void add(const std::string& frame, const std::string& base, const Eigen::Isometry3d& X, const SdfElement& element,
           const std::string& placement = "", const std::string& inner = "");
  /// X of `frame`, which `asked` names, in the world. Throws InputError at an element whose frame is not there, or
  /// hangs on itself.
  Eigen::Isometry3d in_world(const std::string& frame, const SdfElement& asked);

 private:
  struct Frame {
    std::string base;
    Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
    SdfElement element;
    std::string placement, inner;
  };
  using Named = std::map<std::string, Frame>::value_type;

  /// From `frame` up to what hangs on `root`, or on a frame that is known in the world.
  std::vector<const Named*> way(const std::string& frame, const std::string& root, const SdfElement& asked) const;
  Eigen::Isometry3d in_base(const Frame& frame, int depth) const;

  std::map<std::string, Frame> frames_;
  std::map<std::string, Eigen::Isometry3d> in_world_;
};

}  // namespace posewright
