#include "sdf_model_file.hpp"

#include <cstdlib>

#include "mesh_file.hpp"
#include "posewright/problem/package_search.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/text.hpp"

namespace posewright {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t largest_config = 10'000'000;  // bytes

/// Version "1.10" is later than "1.9".
std::pair<int, int> version_of(const std::string& text) {
  char* end = nullptr;
  const long major = std::strtol(text.c_str(), &end, 10);
  return {int(major), *end == '.' ? int(std::strtol(end + 1, nullptr, 10)) : 0};
}

fs::path latest_in(const fs::path& config) {
  const SdfElement model = SdfElement::parse(config, largest_config, "");
  std::string latest;
  std::pair<int, int> version;
  for (const SdfElement& sdf : model.children())
    if (model.tag() == "model" && sdf.tag() == "sdf" && !sdf.text().empty() &&
        (latest.empty() || version_of(sdf.attribute("version")) > version)) {
      latest = sdf.text();
      version = version_of(sdf.attribute("version"));
    }
  if (latest.empty()) throw InputError({config.string(), 0}, "names no SDF file", "<sdf version=\"1.6\">FILE</sdf>");
  return config.parent_path() / latest;
}

}  // namespace

std::string package_of_uri(const std::string& uri) {
  if (!names_package(uri)) return "";
  const std::size_t begin = uri.find("://") + 3;
  return uri.substr(begin, uri.find('/', begin) - begin);
}

fs::path sdf_model_file(const SdfElement& include, const std::string& uri, const NamedFiles& files) {
  fs::path path = find_model(uri, files);
  if (path.empty() && !names_package(uri)) {
    path = file_of_uri(uri, {}, {}, {});
    if (path.is_relative()) path = include.file().parent_path() / path;
  }
  std::error_code code;
  for (const char* config : {"model.config", "manifest.xml"})
    if (!path.empty() && fs::is_regular_file(path / config, code)) path = latest_in(path / config);
  if (!path.empty() && fs::is_regular_file(path, code)) return path;
  include.fail("the model " + in_quotes(uri) + " is not found",
               "a file, a folder with model.config, --package NAME=FOLDER, except: [NAME]");
}

}  // namespace posewright
