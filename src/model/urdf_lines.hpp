#pragma once

#include <map>
#include <string>
#include <utility>

#include "posewright/support/error.hpp"

namespace posewright {

/// Lines and numbers of the URDF by tinyxml2: urdfdom knows no lines and reads "1,5" as 1.
class UrdfLines {
 public:
  /// Throws InputError if the text is not XML, has no <robot>, or a number in it is malformed or not finite.
  UrdfLines(const std::string& text, const std::string& file);
  /// Place of <joint name="…"> or <link name="…">; line 0 if there is none.
  SourcePlace joint(const std::string& name) const { return find("joint", name); }
  SourcePlace link(const std::string& name) const { return find("link", name); }

  /// Throws InputError if a number of a <collision> shape is malformed or a size is not positive.
  void check_collision_shapes() const;

 private:
  SourcePlace find(const char* element, const std::string& name) const;
  std::string text_, file_;
  std::map<std::pair<std::string, std::string>, int> lines_;  // of elements by kind and name
};

}  // namespace posewright
