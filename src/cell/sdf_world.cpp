#include <algorithm>
#include <map>

#include "obstacle_files.hpp"
#include "posewright/support/text.hpp"
#include "sdf_element.hpp"
#include "sdf_model_file.hpp"
#include "sdf_shape.hpp"

namespace posewright {
namespace {

constexpr const char* world = "world";
constexpr const char* frames_allowed = "frames that form a tree";
constexpr int deepest = 100;  // placement frames of models in models

/// Scope of names: those of a model or world, and the default frame of a pose.
struct SdfScope {
  std::string prefix;  ///< "MODEL::" of a model in its world, "" of the world
  std::string own;     ///< full name of the model's frame, or "world"
  std::string model;   ///< full name of the model that links here belong to

  /// The full name of what is called `name` here; `otherwise` if that is "".
  std::string full(const std::string& name, const std::string& otherwise) const {
    if (name.empty()) return otherwise;
    if (name == "__model__" || (name == world && prefix.empty())) return own;
    return prefix + name;
  }
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
           const std::string& placement = "", const std::string& inner = "") {
    if (!frames_.emplace(frame, Frame{base, X, element, placement, inner}).second || frame == world)
      element.fail("the name " + in_quotes(frame) + " is taken", "a name of its own for each model, link and frame");
  }
  /// X of `frame`, which `asked` names, in the world. Throws InputError at an element whose frame is not there, or
  /// hangs on itself.
  Eigen::Isometry3d in_world(const std::string& frame, const SdfElement& asked) {
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

 private:
  struct Frame {
    std::string base;
    Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
    SdfElement element;
    std::string placement, inner;
  };
  using Named = std::map<std::string, Frame>::value_type;

  /// From `frame` up to what hangs on `root`, or on a frame that is known in the world.
  std::vector<const Named*> way(const std::string& frame, const std::string& root, const SdfElement& asked) const {
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

  Eigen::Isometry3d in_base(const Frame& frame, int depth) const {
    if (frame.placement.empty()) return frame.X;
    if (depth == 0) frame.element.fail("the placement frame depends on itself", frames_allowed);
    Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
    for (const Named* named : way(frame.placement, frame.inner, frame.element))
      X = in_base(named->second, depth - 1) * X;
    return frame.X * X.inverse();
  }

  std::map<std::string, Frame> frames_;
  std::map<std::string, Eigen::Isometry3d> in_world_;
};

constexpr int deepest_include = 30;
constexpr long most_elements = 200'000;  // of a world with all that it includes

/// A model, called and placed as it says itself or as the <include> says that brings it.
struct SdfModel {
  SdfElement element;
  std::string name;
  SdfPose pose;
  std::string placement;  ///< name of the frame in it that stands at its pose, "": its own
  bool merged = false;    ///< its links become those of the model that includes it
};

class SdfReader {
 public:
  SdfReader(const ObstacleFileSpec& spec, const NamedFiles& named) : spec_(spec), named_(named) {}

  std::vector<PlacedShape> read() {
    const SdfElement root = SdfElement::open(spec_.file);
    const SdfScope top{"", "world", ""};
    for (const SdfElement& child : root.children())
      if (child.tag() == "world") read_children(child, top);
    read_children(root, top);
    std::vector<PlacedShape> shapes;
    for (Found& found : found_) {
      const Parts& parts = parts_[found.model];
      const bool alone = parts.links == 1 && parts.models == 0;
      shapes.push_back({alone ? found.model : found.model + "::" + found.link, std::move(found.shape.shape),
                        frames_.in_world(found.base, found.element) * found.X * found.shape.X, found.line});
    }
    return shapes;
  }

 private:
  struct Found {
    std::string model, link, base;
    Eigen::Isometry3d X;
    SdfShape shape;
    SdfElement element;
    int line;
  };
  struct Parts {
    int links = 0, models = 0;
  };

  bool is_left_out(const SdfScope& scope, const std::string& name) const {
    return scope.prefix.empty() &&
           std::any_of(spec_.except.begin(), spec_.except.end(), [&](const auto& e) { return e.value == name; });
  }

  void read_children(const SdfElement& element, const SdfScope& scope) {
    for (const SdfElement& child : element.children()) {
      if (++elements_ > most_elements) child.fail("exceeds the allowed size of a world", "200,000 elements");
      const std::string tag = child.tag();
      if (tag == "model") read_model({child, child.name(), child.pose(), child.attribute("placement_frame")}, scope);
      else if (tag == "include") read_include(child, scope);
      else if (tag == "link" && !scope.model.empty()) read_link(child, scope);
      else if (tag == "frame") read_frame(child, scope, child.attribute("attached_to"));
      else if (tag == "joint") read_frame(child, scope, child.text_of("child"));
      else if (tag == "population") child.fail("<population> is not read", "models that are written out");
    }
  }

  void read_model(const SdfModel& model, const SdfScope& outer) {
    if (is_left_out(outer, model.name)) return;
    const std::string name = outer.prefix + (model.merged ? "_merged__" + model.name + "__model__" : model.name);
    const SdfScope inner =
        model.merged ? SdfScope{outer.prefix, name, outer.model} : SdfScope{name + "::", name + "::__model__", name};
    frames_.add(name, outer.full(model.pose.relative_to), model.pose.X, model.element, inner.full(model.placement, ""),
                inner.own);
    if (!model.merged) {
      frames_.add(inner.own, name, Eigen::Isometry3d::Identity(), model.element);
      ++parts_[outer.model].models;
    }
    read_children(model.element, inner);
  }

  /// A frame or joint; a joint that is called as its link, as in old files, is no frame of its own.
  void read_frame(const SdfElement& element, const SdfScope& scope, const std::string& attached_to) {
    const SdfPose pose = element.pose();
    const std::string name = scope.prefix + element.name();
    if (element.tag() == "joint" && frames_.has(name)) return;
    frames_.add(name, scope.full(pose.relative_to, scope.full(attached_to)), pose.X, element);
  }

  void read_link(const SdfElement& element, const SdfScope& scope) {
    const SdfPose pose = element.pose();
    const std::string name = scope.prefix + element.name();
    frames_.add(name, scope.full(pose.relative_to), pose.X, element);
    ++parts_[scope.model].links;
    for (const SdfElement& collision : element.children()) {
      if (collision.tag() != "collision") continue;
      const SdfPose at = collision.pose();
      const auto geometry = collision.child("geometry");
      if (!geometry) collision.fail("<collision> has no <geometry>", "a shape is needed");
      for (SdfShape& shape : sdf_shapes(*geometry))
        found_.push_back({scope.model, element.name(), scope.full(at.relative_to, name), at.X, std::move(shape),
                          collision, line_ > 0 ? line_ : collision.line()});
    }
  }

  void read_include(const SdfElement& include, const SdfScope& scope) {
    const std::string uri = include.text_of("uri"), name = include.text_of("name");
    if (uri.empty()) include.fail("<include> has no <uri>", "model://NAME or a file is needed");
    if (is_left_out(scope, name) || is_left_out(scope, package_of_uri(uri))) return;
    if (depth_ == deepest_include) include.fail("models include each other too deep", "30 levels");
    const SdfElement& root = opened(sdf_model_file(include, uri, named_));
    const auto element = root.child("model");
    if (!element && (root.child("light") || root.child("actor"))) return;
    if (!element) include.fail("'" + root.file().string() + "' has no <model>", "a file with one model is needed");
    SdfModel model{*element, name.empty() ? element->name() : name, (include.child("pose") ? include : *element).pose(),
                   include.text_of("placement_frame"), include.attribute("merge") == "true"};
    if (model.merged && scope.model.empty())
      include.fail("merge=\"true\" is allowed only inside a model", "leave it out here");
    if (model.placement.empty()) model.placement = element->attribute("placement_frame");
    const int outermost = line_;
    if (line_ == 0) line_ = include.line();
    ++depth_;
    read_model(model, scope);
    --depth_;
    line_ = outermost;
  }

  const SdfElement& opened(const std::filesystem::path& file) {
    const auto known = files_.find(file);
    return known != files_.end() ? known->second : files_.emplace(file, SdfElement::open(file)).first->second;
  }

  const ObstacleFileSpec& spec_;
  const NamedFiles& named_;
  SdfFrames frames_;
  std::vector<Found> found_;
  std::map<std::string, Parts> parts_;  // of models by their full names
  std::map<std::filesystem::path, SdfElement> files_;
  long elements_ = 0;
  int depth_ = 0, line_ = 0;  // of includes; line of the <include> in the world's own file, 0: none
};

}  // namespace

std::vector<PlacedShape> read_sdf_shapes(const ObstacleFileSpec& spec, const NamedFiles& files) {
  return SdfReader(spec, files).read();
}

}  // namespace posewright
