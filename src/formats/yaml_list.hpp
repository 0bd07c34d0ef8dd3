#pragma once

#include <yaml-cpp/yaml.h>

#include <functional>
#include <string>

#include "posewright/controller/yaml_document.hpp"
#include "posewright/formats/pose_formats.hpp"
#include "posewright/support/error.hpp"

/// Pose lists in YAML. Everything here throws InputError with file and line.
namespace posewright::formats {

class YamlList : public yaml::Document {
 public:
  /// Runs `body` on the first document of `bytes`; what yaml-cpp throws becomes an InputError.
  static PoseTable read(const std::string& bytes, const std::string& file,
                        const std::function<PoseTable(const YamlList&, const YAML::Node&)>& body);

  using Document::Document;
  /// A row of as many numbers as there are names, if there are names.
  PoseRow row(const YAML::Node& node, const std::string& what, std::size_t names) const;
};

/// "# Written by posewright: what\n"
std::string yaml_head(const std::string& what);

}  // namespace posewright::formats
