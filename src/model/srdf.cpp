#include "posewright/model/srdf.hpp"

#include <tinyxml2.h>

#include <cstring>

#include "posewright/support/error.hpp"
#include "posewright/support/text.hpp"
#include "posewright/support/text_file.hpp"

namespace posewright {
namespace {

using tinyxml2::XMLElement;

constexpr std::uintmax_t largest_srdf = 20'000'000;  // bytes

class SrdfDocument {
 public:
  SrdfDocument(const std::filesystem::path& file, const SourcePlace& place) {
    std::error_code code;
    if (!std::filesystem::is_regular_file(file, code))
      throw InputError(place, "srdf '" + file.string() + "' is not there", "an SRDF file is needed");
    const std::string text = read_xml_text(file, largest_srdf);
    if (document_.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS)
      throw InputError({file.string(), document_.ErrorLineNum()}, "is not well-formed XML", "an SRDF file is needed");
    if (document_.RootElement() == nullptr || std::strcmp(document_.RootElement()->Name(), "robot") != 0)
      throw InputError({file.string(), 0}, "has no <robot> at its root", "an SRDF file is needed");
  }
  const XMLElement& robot() const { return *document_.RootElement(); }

 private:
  tinyxml2::XMLDocument document_;
};

std::string attribute(const XMLElement& element, const char* name) {
  const char* value = element.Attribute(name);
  return value == nullptr ? "" : value;
}

/// Null if the file has no such group; `names` gets all of them.
const XMLElement* find_group(const XMLElement& robot, const std::string& name, std::string& names) {
  const XMLElement* found = nullptr;
  for (const auto* e = robot.FirstChildElement("group"); e != nullptr; e = e->NextSiblingElement("group")) {
    names += (names.empty() ? "" : ", ") + attribute(*e, "name");
    if (attribute(*e, "name") == name) found = e;
  }
  return found;
}

/// The only child of a group if that is another group.
std::string only_subgroup(const XMLElement& group) {
  const XMLElement* first = group.FirstChildElement();
  if (first == nullptr || first->NextSiblingElement() != nullptr || std::strcmp(first->Name(), "group") != 0) return "";
  return attribute(*first, "name");
}

}  // namespace

std::vector<std::pair<std::string, std::string>> read_srdf_pairs(const std::filesystem::path& file,
                                                                 const SourcePlace& place) {
  const SrdfDocument srdf(file, place);
  std::vector<std::pair<std::string, std::string>> pairs;
  for (const auto* e = srdf.robot().FirstChildElement("disable_collisions"); e != nullptr;
       e = e->NextSiblingElement("disable_collisions")) {
    const char *a = e->Attribute("link1"), *b = e->Attribute("link2");
    if (a == nullptr || b == nullptr)
      throw InputError({file.string(), e->GetLineNum()}, "disable_collisions lacks link1 or link2", "both are needed");
    pairs.emplace_back(a, b);
  }
  return pairs;
}

SrdfGroup read_srdf_group(const std::filesystem::path& file, const Located<std::string>& name,
                          const SourcePlace& place) {
  const SrdfDocument srdf(file, place);
  const SourcePlace asked{place.file, name.line};
  std::string names;
  const XMLElement* group = find_group(srdf.robot(), name.value, names);
  constexpr int deepest = 32;  // groups of groups that go in a circle
  for (int depth = 0; group != nullptr && !only_subgroup(*group).empty() && depth < deepest; ++depth) {
    std::string ignored;
    group = find_group(srdf.robot(), only_subgroup(*group), ignored);
  }
  if (group == nullptr)
    throw InputError(asked, "group " + in_quotes(name.value) + " is not in " + file.filename().string(),
                     names.empty() ? "the file has none" : "groups: " + names);
  SrdfGroup result{"", "", {}, {file.string(), group->GetLineNum()}};
  int chains = 0, others = 0;
  for (const auto* e = group->FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
    if (std::strcmp(e->Name(), "chain") == 0) {
      ++chains;
      result.base = attribute(*e, "base_link");
      result.tip = attribute(*e, "tip_link");
    } else if (std::strcmp(e->Name(), "joint") == 0) {
      result.joints.push_back(attribute(*e, "name"));
    } else {
      ++others;
    }
  }
  if (others > 0 || chains > 1 || (chains == 1) == !result.joints.empty())
    throw InputError(asked, "group " + in_quotes(name.value) + " is neither one chain nor a list of joints",
                     "base and tip of the robot, or a group that is one chain");
  return result;
}

}  // namespace posewright
