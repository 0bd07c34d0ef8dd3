#include "posewright/model/corrected_urdf.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "posewright/model/forked_chain.hpp"
#include "posewright/model/placement.hpp"
#include "posewright/model/urdf_reader.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/text_edit.hpp"
#include "posewright/support/text_file.hpp"
#include "urdf_document.hpp"
#include "xml_tags.hpp"

namespace posewright {
namespace {

/// Shortest digits that read back as the same doubles; no negative zero.
std::string three(const Eigen::Vector3d& v) { return fmt::format("{} {} {}", v.x() + 0.0, v.y() + 0.0, v.z() + 0.0); }

/// New text of an origin's attributes; none: it stays as it is.
struct NewOrigin {
  std::optional<std::string> xyz, rpy;
};

/// @param old  as the file has it
/// @param X    that stands behind it from now on
NewOrigin new_origin(const Eigen::Isometry3d& old, const Eigen::Isometry3d& X) {
  NewOrigin origin;
  if (!X.translation().isZero(0.0)) origin.xyz = three((old * X).translation());
  if (!(X.linear() - Eigen::Matrix3d::Identity()).isZero(0.0)) origin.rpy = three(rpy_of((old * X).linear()));
  return origin;
}

/// Changes the origins of joints in a text of XML, and not one byte else.
class OriginEditor {
 public:
  /// @param joints  where the tag of each joint is among xml_tags(text)
  OriginEditor(const std::string& text, std::string file, std::map<std::string, std::size_t> joints)
      : text_(text), file_(std::move(file)), tags_(xml_tags(text)), joint_(std::move(joints)) {}

  /// Throws InputError for a joint that is not there.
  void set(const std::string& joint, const NewOrigin& origin) {
    if (!origin.xyz && !origin.rpy) return;
    const auto found = joint_.find(joint);
    if (found == joint_.end())
      throw InputError({file_, 0}, "the text has no joint '" + joint + "' to correct",
                       "names without malformed entities (&…;) are needed");
    const std::size_t at = found->second;
    const auto tag = std::find_if(tags_.begin() + std::ptrdiff_t(at) + 1, tags_.end(),
                                  [&](const XmlTag& t) { return t.parent == at && t.name == "origin"; });
    if (tag == tags_.end()) insert_origin(tags_[at].end, origin);
    else change_origin(*tag, origin);
  }

  std::string text() const { return with_edits(text_, edits_); }

 private:
  void insert_origin(std::size_t at, const NewOrigin& origin) {
    const std::size_t next = std::min(text_.find_first_not_of(" \t\r\n", at), text_.size());
    edits_.push_back({at, at,
                      fmt::format("{}<origin xyz=\"{}\" rpy=\"{}\"/>", text_.substr(at, next - at),
                                  origin.xyz.value_or("0 0 0"), origin.rpy.value_or("0 0 0"))});
  }

  void change_origin(const XmlTag& tag, const NewOrigin& origin) {
    for (const auto& [name, value] : {std::pair("xyz", &origin.xyz), std::pair("rpy", &origin.rpy)}) {
      if (!*value) continue;
      if (const XmlAttribute* attribute = tag.find(name)) edits_.push_back({attribute->begin, attribute->end, **value});
      else edits_.push_back({tag.after_attributes, tag.after_attributes, fmt::format(" {}=\"{}\"", name, **value)});
    }
  }

  const std::string& text_;
  std::string file_;
  std::vector<XmlTag> tags_;
  std::map<std::string, std::size_t> joint_;
  std::vector<TextEdit> edits_;
};

/// The tags of a URDF's joints by their names: those of the tree in the order of the file.
std::map<std::string, std::size_t> joint_tags(const UrdfDocument& urdf) {
  const std::vector<XmlTag> tags = xml_tags(urdf.text());
  std::vector<std::size_t> of_joints;
  for (std::size_t i = 0; i < tags.size(); ++i)
    if (tags[i].depth == 1 && tags[i].name == "joint") of_joints.push_back(i);
  std::map<std::string, std::size_t> result;
  for (const auto& [name, joint] : urdf.tree().joints()) result.emplace(name, of_joints.at(joint.index));
  return result;
}

/// Pattern of a name in a macro's text: ${…} and $(…) match anything.
bool may_be(std::string_view pattern, std::string_view name) {
  const std::size_t dollar = std::min(pattern.find("${"), pattern.find("$("));
  if (dollar == std::string_view::npos) return pattern == name;
  if (!name.starts_with(pattern.substr(0, dollar))) return false;
  const char close = pattern[dollar + 1] == '{' ? '}' : ')';
  const std::size_t end = pattern.find(close, dollar);
  if (end == std::string_view::npos) return false;
  for (std::size_t skip = dollar; skip <= name.size(); ++skip)
    if (may_be(pattern.substr(end + 1), name.substr(skip))) return true;
  return false;
}

/// The tags of a xacro file that make the joints of its URDF, each tag one joint and each joint of one tag.
class XacroJoints {
 public:
  XacroJoints(const std::string& text, const std::string& file, const UrdfTree& tree)
      : text_(text), file_(file), tree_(tree), tags_(xml_tags(text)) {}

  std::size_t tag_of(const std::string& joint) const {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < tags_.size(); ++i)
      if (is_joint(i) && may_be(name_of(i), joint)) found.push_back(i);
    if (found.empty()) refuse(joint, "is not in this file");
    if (found.size() > 1) refuse(joint, "is in this file more than once");
    for (const auto& [other, any] : tree_.joints())
      if (other != joint && may_be(name_of(found.front()), other))
        refuse(joint, "is made by the same lines as '" + other + "'");
    for (std::size_t i = found.front() + 1; i < tags_.size(); ++i)
      if (tags_[i].parent == found.front() && tags_[i].name.find(':') != std::string_view::npos)
        refuse(joint, "has its origin from a macro");
    return found.front();
  }

 private:
  [[noreturn]] void refuse(const std::string& joint, const std::string& why) const {
    throw CannotDo(file_ + ": joint '" + joint + "' " + why + "; --urdf writes the expanded file");
  }
  std::string_view name_of(std::size_t tag) const {
    const XmlAttribute* name = tags_[tag].find("name");
    return name == nullptr ? std::string_view() : std::string_view(text_).substr(name->begin, name->end - name->begin);
  }
  /// A transmission names joints too, and says nothing of their links.
  bool is_joint(std::size_t tag) const {
    if (tags_[tag].name != "joint") return false;
    return std::any_of(tags_.begin() + std::ptrdiff_t(tag), tags_.end(),
                       [&](const XmlTag& t) { return t.parent == tag && t.name == "parent"; });
  }

  const std::string& text_;
  std::string file_;
  const UrdfTree& tree_;
  std::vector<XmlTag> tags_;
};

/// Joints beside the chain that follow one of its joints: they read it without its new offset.
std::vector<std::string> stray_mimics(const UrdfDocument& urdf, const std::vector<CalibratedValue>& values) {
  std::vector<std::string> notes;
  for (const auto& [name, joint] : urdf.tree().joints()) {
    const bool in_chain = std::ranges::find(urdf.way(), &joint, &UrdfStep::joint) != urdf.way().end() ||
                          std::ranges::find(urdf.moving(), &joint) != urdf.moving().end();
    if (!joint.mimic || in_chain) continue;
    for (const CalibratedValue& value : values)
      if (value.name == joint.mimic->master + ".offset" && value.correction() != 0.0)
        notes.push_back(left_out_text(value, "joint '" + name + "' outside the chain follows this joint as before"));
  }
  return notes;
}

const char* reason_of(const std::string& name) {
  return name.ends_with(".gear") ? "a URDF has no gear errors" : "a URDF has no place for it";
}

/// Joints from base to tip that change, with their new origins; what a URDF cannot say.
struct ChangedJoints {
  std::vector<std::pair<std::string, NewOrigin>> origins;
  std::vector<std::string> left_out;
};

ChangedJoints changed_joints(const SerialArmSpec& arm, const SourcePlace& place, const UrdfDocument& urdf,
                             VariantSpec::Convention convention, const std::vector<CalibratedValue>& values) {
  const ChainDescription chain = read_urdf_chain(arm, place);
  const ChainCorrection correction = chain_correction(chain, convention, values);
  ChangedJoints result;
  for (const CalibratedValue& v : correction.base.by)
    result.left_out.push_back(left_out_text(v, "the pose of the base is not part of the robot"));
  const UrdfStep& last = urdf.way().back();
  const bool has_tool = last.backward || last.joint->type == UrdfJoint::Type::fixed;
  if (!has_tool)
    for (const CalibratedValue& v : correction.tip.by)
      result.left_out.push_back(left_out_text(v, "no fixed joint ends in link '" + urdf.tip().name + "'"));
  std::size_t next = 0;
  for (const UrdfStep& step : urdf.way()) {
    const Eigen::Isometry3d& old = step.joint->X_ParentJoint;
    Eigen::Isometry3d behind = Eigen::Isometry3d::Identity();
    if (step.joint->moves()) behind = correction.joints[next++].X;
    // The tip is the parent of a last joint that is passed backward.
    if (&step == &last && has_tool && !correction.tip.by.empty())
      behind = last.backward ? old.inverse() * correction.tip.X.inverse() * old * behind : correction.tip.X;
    const NewOrigin origin = new_origin(old, behind);
    if (origin.xyz || origin.rpy) result.origins.emplace_back(step.joint->name, origin);
  }
  for (const CalibratedValue& v : correction.left_out) result.left_out.push_back(left_out_text(v, reason_of(v.name)));
  return result;
}

bool is_on(const UrdfDocument& urdf, const UrdfJoint& joint) {
  return std::ranges::any_of(urdf.way(), [&](const UrdfStep& step) { return step.joint->name == joint.name; });
}

/// An arm with several tips, way by way: a joint that several ways share is displaced alike on each.
class ChangedOnWays {
 public:
  ChangedOnWays(const SerialArmSpec& arm, const SourcePlace& place, const std::vector<CalibratedValue>& values)
      : arm_(arm), place_(place), values_(values), chains_(read_urdf_ways(arm, place)) {
    for (const WaySpec& way : arm.ways) documents_.emplace_back(arm_of_way(arm, way), place);
  }

  ChangedJoints result() {
    for (std::size_t w = 0; w < documents_.size(); ++w) {
      ChangedJoints changed = changed_joints(arm_of_way(arm_, arm_.ways[w]), place_, documents_[w],
                                             VariantSpec::Convention::frames, values_on(w));
      for (auto& origin : changed.origins)
        if (std::ranges::find(result_.origins, origin.first, &Changed::first) == result_.origins.end())
          result_.origins.push_back(std::move(origin));
      for (std::string& text : changed.left_out) leave_out(std::move(text));
    }
    return std::move(result_);
  }

 private:
  using Changed = std::pair<std::string, NewOrigin>;

  void leave_out(std::string text) {
    if (std::ranges::find(result_.left_out, text) == result_.left_out.end())
      result_.left_out.push_back(std::move(text));
  }

  /// The values as the chain of a way calls them. What is no joint's is the instruments', and left out by any way.
  std::vector<CalibratedValue> values_on(std::size_t w) {
    const WaySpec& way = arm_.ways[w];
    const bool tool_fits = tool_is_alone(w);
    std::vector<CalibratedValue> own;
    for (CalibratedValue value : values_) {
      const std::size_t dot = value.name.rfind('.');
      const std::string owner = value.name.substr(0, dot), part = value.name.substr(dot);
      if (owner == base_name(way)) {
        if (value.correction() != 0.0)
          leave_out(left_out_text(value, "where a measurement frame is, is not part of the robot"));
        continue;
      }
      if (owner == tool_name(way)) {
        if (tool_fits) value.name = "tool" + part;
        else if (value.correction() != 0.0)
          leave_out(left_out_text(value, "no joint of its own ends in tip '" + way.of.name + "'"));
        if (!tool_fits) continue;
      } else if (owner == "base" || owner.starts_with("base@") || owner.starts_with("tool@")) {
        continue;
      } else if (!is_on_way(w, owner) && is_on_any(owner)) {
        continue;
      }
      own.push_back(std::move(value));
    }
    return own;
  }

  bool is_on_way(std::size_t w, const std::string& joint) const {
    const std::vector<ChainJoint>& joints = chains_.ways[w].chain.joints;
    return std::ranges::find(joints, joint, &ChainJoint::name) != joints.end();
  }
  bool is_on_any(const std::string& joint) const {
    for (std::size_t w = 0; w < arm_.ways.size(); ++w)
      if (is_on_way(w, joint)) return true;
    return false;
  }

  /// The joint before its tip, whose origin a tool changes, leads to this tip alone.
  bool tool_is_alone(std::size_t w) const {
    const UrdfStep& last = documents_[w].way().back();
    if (last.backward || last.joint->type != UrdfJoint::Type::fixed) return false;
    for (std::size_t other = 0; other < documents_.size(); ++other)
      if (arm_.ways[other].of.name != arm_.ways[w].of.name && is_on(documents_[other], *last.joint)) return false;
    return true;
  }

  const SerialArmSpec& arm_;
  SourcePlace place_;
  const std::vector<CalibratedValue>& values_;
  WayChains chains_;
  std::vector<UrdfDocument> documents_;
  ChangedJoints result_;
};

ChangedJoints all_changed(const SerialArmSpec& arm, const SourcePlace& place, const UrdfDocument& urdf,
                          VariantSpec::Convention convention, const std::vector<CalibratedValue>& values) {
  ChangedJoints result = arm.ways.empty() ? changed_joints(arm, place, urdf, convention, values)
                                          : ChangedOnWays(arm, place, values).result();
  if (convention == VariantSpec::Convention::frames)
    for (std::string& note : stray_mimics(urdf, values)) result.left_out.push_back(std::move(note));
  return result;
}

}  // namespace

CorrectedUrdf corrected_urdf(const SerialArmSpec& arm, const SourcePlace& place, VariantSpec::Convention convention,
                             const std::vector<CalibratedValue>& values) {
  const UrdfDocument urdf(arm, place);
  ChangedJoints changed = all_changed(arm, place, urdf, convention, values);
  OriginEditor editor(urdf.text(), arm.urdf.string(), joint_tags(urdf));
  for (const auto& [joint, origin] : changed.origins) editor.set(joint, origin);
  return {editor.text(), std::move(changed.left_out)};
}

CorrectedUrdf corrected_xacro(const SerialArmSpec& arm, const SourcePlace& place, VariantSpec::Convention convention,
                              const std::vector<CalibratedValue>& values) {
  if (arm.expanded == nullptr) throw InputError(place, arm.urdf.string() + " is no xacro file", "--urdf corrects it");
  const UrdfDocument urdf(arm, place);
  ChangedJoints changed = all_changed(arm, place, urdf, convention, values);
  const std::string text = read_xml_text(arm.urdf, 20'000'000);
  const XacroJoints joints(text, arm.urdf.string(), urdf.tree());
  std::map<std::string, std::size_t> tags;
  for (const auto& [joint, origin] : changed.origins) tags.emplace(joint, joints.tag_of(joint));
  OriginEditor editor(text, arm.urdf.string(), std::move(tags));
  for (const auto& [joint, origin] : changed.origins) editor.set(joint, origin);
  return {editor.text(), std::move(changed.left_out)};
}

}  // namespace posewright
