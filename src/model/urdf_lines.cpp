#include "urdf_lines.hpp"

#include <tinyxml2.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <span>
#include <string_view>
#include <unordered_map>

#include "posewright/support/text.hpp"

namespace posewright {
namespace {

struct NumberAttribute {
  const char* element;
  const char* attribute;
  int count;
};
// What the kinematics is read from.
constexpr std::array<NumberAttribute, 11> number_attributes = {{{"origin", "xyz", 3},
                                                                {"origin", "rpy", 3},
                                                                {"axis", "xyz", 3},
                                                                {"limit", "lower", 1},
                                                                {"limit", "upper", 1},
                                                                {"limit", "velocity", 1},
                                                                {"limit", "effort", 1},
                                                                {"safety_controller", "soft_lower_limit", 1},
                                                                {"safety_controller", "soft_upper_limit", 1},
                                                                {"mimic", "multiplier", 1},
                                                                {"mimic", "offset", 1}}};

bool are_numbers(std::string_view text, int count) {
  const auto numbers = numbers_in(text);
  return numbers && numbers->size() == std::size_t(count);
}

bool are_positive(std::string_view text) {
  const auto numbers = numbers_in(text);
  return numbers && std::all_of(numbers->begin(), numbers->end(), [](double value) { return value > 0; });
}

// Of a file; more is not a robot.
constexpr std::size_t most_joints = 50'000;

/// Names of joints become columns of lists and words of programs: what would break those is refused here.
void check_name(const tinyxml2::XMLElement& joint, const std::string& file) {
  const char* name = joint.Attribute("name");
  if (name == nullptr) return;
  const std::string_view text = name;
  const bool broken = has_control_character(text) || text.find_first_of(",;\"'[]#") != std::string_view::npos ||
                      trimmed_blanks(text) != text;
  if (broken)
    throw InputError({file, joint.GetLineNum()}, "joint name " + in_quotes(text) + " would break lists of poses",
                     "no comma, semicolon, quote, bracket, # or line break, no blank at either end");
  for (const char* word : {"pose", "id", "weight", "load_case", "station"})
    if (text == word)
      throw InputError({file, joint.GetLineNum()}, "joint name " + in_quotes(text) + " is a column of its own in lists",
                       "rename the joint");
}

constexpr std::array<NumberAttribute, 7> shape_attributes = {{{"origin", "xyz", 3},
                                                              {"origin", "rpy", 3},
                                                              {"box", "size", 3},
                                                              {"cylinder", "radius", 1},
                                                              {"cylinder", "length", 1},
                                                              {"sphere", "radius", 1},
                                                              {"mesh", "scale", 3}}};

void check_numbers(const tinyxml2::XMLElement& parent, std::span<const NumberAttribute> rules,
                   const std::string& file) {
  for (const tinyxml2::XMLElement* e = parent.FirstChildElement(); e != nullptr; e = e->NextSiblingElement())
    for (const NumberAttribute& rule : rules) {
      const char* value = std::strcmp(e->Name(), rule.element) == 0 ? e->Attribute(rule.attribute) : nullptr;
      if (value != nullptr && !are_numbers(value, rule.count))
        throw InputError(
            {file, e->GetLineNum()},
            std::string(rule.element) + " " + rule.attribute + "=\"" + value + "\" is malformed",
            rule.count == 1 ? "one finite number is allowed" : "three finite numbers separated by blanks are allowed");
    }
}

/// Name of a joint's parent or child link, empty if there is none.
std::string end_of(const tinyxml2::XMLElement& joint, const char* which) {
  const tinyxml2::XMLElement* end = joint.FirstChildElement(which);
  const char* name = end == nullptr ? nullptr : end->Attribute("link");
  return name == nullptr ? std::string() : std::string(name);
}

/// The uppermost ancestor of each link so far; ways that were gone once are short afterwards, so that long chains cost
/// no more than short ones.
class Roots {
 public:
  std::string of(std::string link) {
    for (auto at = above_.find(link); at != above_.end(); at = above_.find(link)) {
      if (const auto next = above_.find(at->second); next != above_.end()) at->second = next->second;
      link = at->second;
    }
    return link;
  }
  void hang(const std::string& child, const std::string& parent) { above_.emplace(child, parent); }

 private:
  std::unordered_map<std::string, std::string> above_;
};

/// Every link has at most one parent and no chain of parents comes back to where it started: urdfdom accepts closed
/// loops in part and never frees them.
void check_tree(const tinyxml2::XMLElement& robot, const std::string& file) {
  std::map<std::string, std::string> parent;
  Roots roots;
  for (const auto* joint = robot.FirstChildElement("joint"); joint != nullptr;
       joint = joint->NextSiblingElement("joint")) {
    const std::string child = end_of(*joint, "child");
    if (!child.empty() && !parent.emplace(child, end_of(*joint, "parent")).second)
      throw InputError({file, joint->GetLineNum()}, "link '" + child + "' is the child of two joints",
                       "a robot is a tree: one parent a link");
    if (child.empty()) continue;
    if (roots.of(end_of(*joint, "parent")) == child)
      throw InputError({file, joint->GetLineNum()}, "link '" + child + "' is its own ancestor",
                       "a robot is a tree: closed chains cannot be described in a URDF");
    roots.hang(child, end_of(*joint, "parent"));
  }
}

}  // namespace

UrdfLines::UrdfLines(const std::string& text, const std::string& file) : text_(text), file_(file) {
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS)
    throw InputError({file, document.ErrorLineNum()}, "is not well-formed XML", "a URDF file is needed");
  const tinyxml2::XMLElement* robot = document.RootElement();
  if (robot == nullptr || std::strcmp(robot->Name(), "robot") != 0)
    throw InputError({file, robot == nullptr ? 0 : robot->GetLineNum()}, "has no <robot> at its root",
                     "a URDF file is needed");
  std::size_t joints = 0;
  for (const tinyxml2::XMLElement* e = robot->FirstChildElement("joint"); e != nullptr;
       e = e->NextSiblingElement("joint")) {
    if (++joints > most_joints)
      throw InputError({file, e->GetLineNum()}, "has more than " + std::to_string(most_joints) + " joints",
                       "a robot, not a building");
    check_numbers(*e, number_attributes, file);
    check_name(*e, file);
  }
  check_tree(*robot, file);
  for (const char* element : {"joint", "link"})
    for (const tinyxml2::XMLElement* e = robot->FirstChildElement(element); e != nullptr;
         e = e->NextSiblingElement(element))
      if (const char* name = e->Attribute("name"); name != nullptr)
        lines_.emplace(std::pair(element, name), e->GetLineNum());
}

void UrdfLines::check_collision_shapes() const {
  tinyxml2::XMLDocument document;
  document.Parse(text_.data(), text_.size());
  using Element = tinyxml2::XMLElement;
  for (const Element* link = document.RootElement()->FirstChildElement("link"); link != nullptr;
       link = link->NextSiblingElement("link"))
    for (const Element* e = link->FirstChildElement("collision"); e != nullptr;
         e = e->NextSiblingElement("collision")) {
      check_numbers(*e, shape_attributes, file_);
      const Element* geometry = e->FirstChildElement("geometry");
      if (geometry == nullptr || geometry->FirstChildElement() == nullptr)
        throw InputError({file_, e->GetLineNum()}, "collision has no geometry", "box, cylinder, sphere or mesh");
      check_numbers(*geometry, shape_attributes, file_);
      const Element* shape = geometry->FirstChildElement();
      for (const char* size : {"size", "radius", "length"})
        if (const char* text = shape->Attribute(size); text != nullptr && !are_positive(text))
          throw InputError({file_, shape->GetLineNum()},
                           std::string(shape->Name()) + " " + size + "=\"" + text + "\" is not positive",
                           "sizes > 0 are allowed");
    }
}

SourcePlace UrdfLines::find(const char* element, const std::string& name) const {
  const auto at = lines_.find({element, name});
  return {file_, at == lines_.end() ? 0 : at->second};
}

}  // namespace posewright
