#include "posewright/model/corrected_urdf.hpp"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "posewright/model/placement.hpp"
#include "posewright/model/urdf_reader.hpp"
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

NewOrigin new_origin(const urdf::Pose& pose, const Eigen::Isometry3d& X) {
  const Eigen::Isometry3d old = isometry(pose);
  NewOrigin origin;
  if (!X.translation().isZero(0.0)) origin.xyz = three((old * X).translation());
  if (!(X.linear() - Eigen::Matrix3d::Identity()).isZero(0.0)) origin.rpy = three(rpy_of((old * X).linear()));
  return origin;
}

/// A stretch of the text and what stands there instead.
struct Edit {
  std::size_t begin, end;
  std::string text;
};

/// Changes the origins of a URDF's joints.
class OriginEditor {
 public:
  OriginEditor(const std::string& text, const std::string& file) : text_(text), file_(file), tags_(xml_tags(text)) {
    // The scanner knows no entities; tinyxml2 tells the names of the same joints in the same order.
    tinyxml2::XMLDocument document;
    document.Parse(text.data(), text.size());
    const auto* joint = document.RootElement()->FirstChildElement("joint");
    for (std::size_t i = 0; i < tags_.size() && joint != nullptr; ++i) {
      if (tags_[i].depth != 1 || tags_[i].name != "joint") continue;
      joint_.emplace(joint->Attribute("name") == nullptr ? "" : joint->Attribute("name"), i);
      joint = joint->NextSiblingElement("joint");
    }
  }

  void set(const std::string& joint, const NewOrigin& origin) {
    if (!origin.xyz && !origin.rpy) return;
    const auto found = joint_.find(joint);
    if (found == joint_.end())
      throw InputError({file_, 0}, "the text has no joint '" + joint + "' to correct",
                       "names without malformed entities (&…;) are needed");
    const std::size_t at = found->second;
    const auto tag = std::find_if(tags_.begin() + std::ptrdiff_t(at), tags_.end(), [&](const XmlTag& t) {
      return t.depth == 2 && t.parent == at && t.name == "origin";
    });
    if (tag == tags_.end()) insert_origin(tags_[at].end, origin);
    else change_origin(*tag, origin);
  }

  std::string text() {
    std::stable_sort(edits_.begin(), edits_.end(), [](const Edit& a, const Edit& b) { return a.begin < b.begin; });
    std::string result;
    std::size_t done = 0;
    for (const Edit& edit : edits_) {
      result.append(text_, done, edit.begin - done).append(edit.text);
      done = edit.end;
    }
    return result.append(text_, done);
  }

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
  std::vector<Edit> edits_;
};

/// Joints beside the chain that follow one of its joints: they read it without its new offset.
std::vector<std::string> stray_mimics(const UrdfDocument& urdf, const std::vector<CalibratedValue>& values) {
  std::vector<std::string> notes;
  for (const auto& [name, joint] : urdf.model().joints_) {
    const bool in_chain =
        std::any_of(urdf.joints().begin(), urdf.joints().end(), [&, &n = name](const auto& j) { return j->name == n; });
    if (joint->mimic == nullptr || in_chain) continue;
    for (const CalibratedValue& value : values)
      if (value.name == joint->mimic->joint_name + ".offset" && value.correction() != 0.0)
        notes.push_back(left_out_text(value, "joint '" + name + "' beside the chain follows this joint as before"));
  }
  return notes;
}

const char* reason_of(const std::string& name) {
  return name.ends_with(".gear") ? "a URDF has no gear errors" : "a URDF has no place for it";
}

}  // namespace

CorrectedUrdf corrected_urdf(const SerialArmSpec& arm, const SourcePlace& place, VariantSpec::Convention convention,
                             const std::vector<CalibratedValue>& values) {
  const ChainDescription chain = read_urdf_chain(arm, place);
  const ChainCorrection correction = chain_correction(chain, convention, values);
  const UrdfDocument urdf(arm, place);
  OriginEditor editor(urdf.text(), arm.urdf.string());
  std::size_t next = 0;
  for (const auto& joint : urdf.joints())
    if (joint->type != urdf::Joint::FIXED)
      editor.set(joint->name, new_origin(joint->parent_to_joint_origin_transform, correction.joints[next++].X));
  const auto& last = urdf.joints().back();
  const bool has_tip = last->type == urdf::Joint::FIXED;
  if (has_tip) editor.set(last->name, new_origin(last->parent_to_joint_origin_transform, correction.tip.X));

  CorrectedUrdf result{editor.text(), {}};
  for (const CalibratedValue& v : correction.base.by)
    result.left_out.push_back(left_out_text(v, "where the robot stands is not part of the robot"));
  if (!has_tip)
    for (const CalibratedValue& v : correction.tip.by)
      result.left_out.push_back(left_out_text(v, "no fixed joint ends in link '" + urdf.tip() + "'"));
  for (const CalibratedValue& v : correction.left_out) result.left_out.push_back(left_out_text(v, reason_of(v.name)));
  if (convention == VariantSpec::Convention::frames)
    for (std::string& note : stray_mimics(urdf, values)) result.left_out.push_back(std::move(note));
  return result;
}

}  // namespace posewright
