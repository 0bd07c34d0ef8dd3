#pragma once

#include <Eigen/Geometry>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "posewright/support/text_edit.hpp"
#include "xml_tags.hpp"

namespace posewright {

/// New text of an origin's attributes; none: it stays as it is.
struct NewOrigin {
  std::optional<std::string> xyz, rpy;
};

/// @param old  as the file has it
/// @param X    that stands behind it from now on
NewOrigin new_origin(const Eigen::Isometry3d& old, const Eigen::Isometry3d& X);

/// Changes the origins of joints in a text of XML, and not one byte else.
class OriginEditor {
 public:
  /// @param joints  where the tag of each joint is among xml_tags(text)
  OriginEditor(const std::string& text, std::string file, std::map<std::string, std::size_t> joints);

  /// Throws InputError for a joint that is not there.
  void set(const std::string& joint, const NewOrigin& origin);
  std::string text() const;

 private:
  void insert_origin(std::size_t at, const NewOrigin& origin);
  void change_origin(const XmlTag& tag, const NewOrigin& origin);

  const std::string& text_;
  std::string file_;
  std::vector<XmlTag> tags_;
  std::map<std::string, std::size_t> joint_;
  std::vector<TextEdit> edits_;
};

}  // namespace posewright
