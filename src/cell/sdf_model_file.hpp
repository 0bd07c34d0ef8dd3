#pragma once

#include "mesh_file.hpp"
#include "sdf_element.hpp"

namespace posewright {

/// NAME of a `model://NAME…` or `package://NAME…`, "" of others.
std::string package_of_uri(const std::string& uri);

/// The file that an <include> names: a package's (find_model), one beside the file that includes it, or, of a folder,
/// the one that its model.config gives for the latest version. Throws InputError at `include`.
std::filesystem::path sdf_model_file(const SdfElement& include, const std::string& uri, const NamedFiles& files);

}  // namespace posewright
