#include <tinyxml2.h>

#include <cstring>

#include "posewright/support/error.hpp"
#include "posewright/support/text_file.hpp"
#include "scene.hpp"

namespace posewright {

std::vector<std::pair<std::string, std::string>> read_srdf_pairs(const std::filesystem::path& file,
                                                                 const SourcePlace& place) {
  std::error_code code;
  if (!std::filesystem::is_regular_file(file, code))
    throw InputError(place, "srdf '" + file.string() + "' is not there", "an SRDF file is needed");
  const std::string text = read_xml_text(file, 20'000'000);
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS)
    throw InputError({file.string(), document.ErrorLineNum()}, "is not well-formed XML", "an SRDF file is needed");
  const tinyxml2::XMLElement* robot = document.RootElement();
  if (robot == nullptr || std::strcmp(robot->Name(), "robot") != 0)
    throw InputError({file.string(), 0}, "has no <robot> at its root", "an SRDF file is needed");
  std::vector<std::pair<std::string, std::string>> pairs;
  for (const auto* e = robot->FirstChildElement("disable_collisions"); e != nullptr;
       e = e->NextSiblingElement("disable_collisions")) {
    const char *a = e->Attribute("link1"), *b = e->Attribute("link2");
    if (a == nullptr || b == nullptr)
      throw InputError({file.string(), e->GetLineNum()}, "disable_collisions lacks link1 or link2", "both are needed");
    pairs.emplace_back(a, b);
  }
  return pairs;
}

}  // namespace posewright
