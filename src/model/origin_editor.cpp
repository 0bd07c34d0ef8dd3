#include "origin_editor.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "posewright/model/placement.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

/// Shortest digits that read back as the same doubles; no negative zero.
std::string three(const Eigen::Vector3d& v) { return fmt::format("{} {} {}", v.x() + 0.0, v.y() + 0.0, v.z() + 0.0); }

}  // namespace

NewOrigin new_origin(const Eigen::Isometry3d& old, const Eigen::Isometry3d& X) {
  NewOrigin origin;
  if (!X.translation().isZero(0.0)) origin.xyz = three((old * X).translation());
  if (!(X.linear() - Eigen::Matrix3d::Identity()).isZero(0.0)) origin.rpy = three(rpy_of((old * X).linear()));
  return origin;
}

OriginEditor::OriginEditor(const std::string& text, std::string file, std::map<std::string, std::size_t> joints)
    : text_(text), file_(std::move(file)), tags_(xml_tags(text)), joint_(std::move(joints)) {}

void OriginEditor::set(const std::string& joint, const NewOrigin& origin) {
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

std::string OriginEditor::text() const { return with_edits(text_, edits_); }

void OriginEditor::insert_origin(std::size_t at, const NewOrigin& origin) {
  const std::size_t next = std::min(text_.find_first_not_of(" \t\r\n", at), text_.size());
  edits_.push_back({at, at,
                    fmt::format("{}<origin xyz=\"{}\" rpy=\"{}\"/>", text_.substr(at, next - at),
                                origin.xyz.value_or("0 0 0"), origin.rpy.value_or("0 0 0"))});
}

void OriginEditor::change_origin(const XmlTag& tag, const NewOrigin& origin) {
  for (const auto& [name, value] : {std::pair("xyz", &origin.xyz), std::pair("rpy", &origin.rpy)}) {
    if (!*value) continue;
    if (const XmlAttribute* attribute = tag.find(name)) edits_.push_back({attribute->begin, attribute->end, **value});
    else edits_.push_back({tag.after_attributes, tag.after_attributes, fmt::format(" {}=\"{}\"", name, **value)});
  }
}

}  // namespace posewright
