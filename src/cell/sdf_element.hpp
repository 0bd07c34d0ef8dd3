#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tinyxml2 {
class XMLDocument;
class XMLElement;
}  // namespace tinyxml2

namespace posewright {

/// Content of a pose element: X in the named frame, "" without a name.
struct SdfPose {
  std::string relative_to;
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
};

/// An element of an SDF file, or of one that names SDF files; the file is held as long as one of its elements is.
class SdfElement {
 public:
  /// The root of a file. Throws InputError if it is missing, not XML, or its root is not <sdf> with a version.
  static SdfElement open(const std::filesystem::path& file);
  /// The root of any XML file. Throws InputError, with what is `needed`, if it is missing, larger than `most_bytes` or
  /// not XML.
  static SdfElement parse(const std::filesystem::path& file, std::uintmax_t most_bytes, const std::string& needed);

  const std::filesystem::path& file() const;
  int line() const;
  std::string tag() const;
  /// An attribute, "" if there is none.
  std::string attribute(const char* name) const;
  /// The attribute "name". Throws InputError if it is missing or empty.
  std::string name() const;
  std::optional<SdfElement> child(const char* tag) const;
  std::vector<SdfElement> children() const;
  /// Its text without blanks at its ends, "" if there is none.
  std::string text() const;
  /// text() of a child, "" if there is none.
  std::string text_of(const char* tag) const;
  /// Exactly `count` finite numbers of a child. Throws InputError if it is missing or holds anything else.
  std::vector<double> numbers_of(const char* tag, std::size_t count) const;
  /// numbers_of(), all above zero.
  std::vector<double> lengths_of(const char* tag, std::size_t count) const;
  /// The child <pose>: metres, then roll, pitch, yaw in rad (degrees="true": degrees) or a quaternion x y z w
  /// (rotation_format="quat_xyzw"). Identity if there is none.
  SdfPose pose() const;

  /// Throws InputError at this element.
  [[noreturn]] void fail(const std::string& what, const std::string& allowed) const;

 private:
  struct Document;
  SdfElement(std::shared_ptr<const Document> document, const tinyxml2::XMLElement& xml)
      : document_(std::move(document)), xml_(&xml) {}
  std::vector<double> numbers() const;

  std::shared_ptr<const Document> document_;
  const tinyxml2::XMLElement* xml_;
};

}  // namespace posewright
