#include "sdf_model_file.hpp"

#include <tinyxml2.h>

#include <algorithm>
#include <cstdlib>

#include "mesh_file.hpp"
#include "posewright/problem/package_search.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/text.hpp"
#include "posewright/support/text_file.hpp"

namespace posewright {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t largest_config = 10'000'000;  // bytes

/// Version "1.10" is later than "1.9".
std::pair<int, int> version_of(const char* text) {
  if (text == nullptr) return {0, 0};
  char* end = nullptr;
  const long major = std::strtol(text, &end, 10);
  return {int(major), *end == '.' ? int(std::strtol(end + 1, nullptr, 10)) : 0};
}

fs::path latest_in(const fs::path& config) {
  const std::string text = read_xml_text(config, largest_config);
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS)
    throw InputError({config.string(), document.ErrorLineNum()}, "is not well-formed XML", "");
  const tinyxml2::XMLElement* model = document.FirstChildElement("model");
  const tinyxml2::XMLElement* latest = nullptr;
  for (const auto* e = model == nullptr ? nullptr : model->FirstChildElement("sdf"); e != nullptr;
       e = e->NextSiblingElement("sdf"))
    if (e->GetText() != nullptr &&
        (latest == nullptr || version_of(e->Attribute("version")) > version_of(latest->Attribute("version"))))
      latest = e;
  if (latest == nullptr) throw InputError({config.string(), 0}, "names no SDF file", "<sdf version=\"1.6\">FILE</sdf>");
  return config.parent_path() / trimmed_blanks(latest->GetText());
}

}  // namespace

std::string package_of_uri(const std::string& uri) {
  if (!names_package(uri)) return "";
  const std::size_t begin = uri.find("://") + 3;
  return uri.substr(begin, uri.find('/', begin) - begin);
}

fs::path sdf_model_file(const SdfElement& include, const std::string& uri, const Problem& problem) {
  fs::path path = find_model(uri, problem);
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
