#include <tinyxml2.h>

#include <set>

#include "posewright/problem/read_robot_file.hpp"
#include "posewright/support/run_program.hpp"
#include "posewright/support/text.hpp"
#include "posewright/support/text_file.hpp"
#include "sections.hpp"

namespace posewright {
namespace {

constexpr std::uintmax_t largest_xacro = 20'000'000;  // bytes

/// <xacro:arg name="…"/> without default, whatever the prefix of the name space is called.
void list_needed(const tinyxml2::XMLElement& element, std::set<std::string>& needed) {
  const std::string name = element.Name();
  const char* argument = element.Attribute("name");
  if (name.ends_with(":arg") && argument != nullptr && element.Attribute("default") == nullptr) needed.insert(argument);
  for (const auto* e = element.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) list_needed(*e, needed);
}

std::string example(const std::set<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name + ": VALUE";
  return "robot: xacro: {" + text + "}, or posewright init --xacro NAME=VALUE";
}

void require_arguments(const SerialArmSpec& arm, const yaml::Value& urdf) {
  const std::string text = read_xml_text(arm.urdf, largest_xacro);
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS || document.RootElement() == nullptr)
    throw InputError({arm.urdf.string(), document.ErrorLineNum()}, "is not well-formed XML", "a xacro file is needed");
  std::set<std::string> needed;
  list_needed(*document.RootElement(), needed);
  for (const auto& [name, value] : arm.xacro) needed.erase(name.value);
  if (needed.empty()) return;
  std::string names;
  for (const std::string& name : needed) names += (names.empty() ? "" : ", ") + name;
  urdf.fail("needs arguments that have no default: " + names, example(needed));
}

/// The line that says what went wrong, which the tool writes last.
std::string last_line(const std::string& text) {
  const std::size_t end = text.find_last_not_of(" \r\n");
  if (end == std::string::npos) return "without a message";
  const std::size_t begin = text.rfind('\n', end);
  return one_line(
      text.substr(begin == std::string::npos ? 0 : begin + 1, end - (begin == std::string::npos ? 0 : begin)));
}

}  // namespace

bool is_xacro(const std::filesystem::path& file) { return file.extension() == ".xacro"; }

std::string expanded_xacro(const SerialArmSpec& arm, const yaml::Value& urdf) {
  require_arguments(arm, urdf);
  // A name that begins with a dash would be an option.
  const std::string file = arm.urdf.string();
  std::vector<std::string> words{"xacro", file.starts_with('-') ? "./" + file : file};
  std::string shown = "xacro " + arm.urdf.filename().string();
  for (const auto& [name, value] : arm.xacro) {
    words.push_back(name.value + ":=" + value);
    shown += " " + words.back();
  }
  const std::optional<ProgramOutput> output = run_program(words);
  if (!output || output->status == 127)
    urdf.fail("is a xacro file, and no program xacro can be started here",
              "expand it where ROS is, and name the result: " + shown + " > robot.urdf");
  if (output->status != 0)
    urdf.fail(
        "is not expanded, xacro ended with status " + std::to_string(output->status) + ": " + last_line(output->error),
        shown);
  return output->out;
}

SerialArmSpec read_robot_file(const std::filesystem::path& file,
                              const std::vector<std::pair<std::string, std::string>>& arguments) {
  SerialArmSpec arm;
  arm.urdf = file;
  for (const auto& [name, value] : arguments) arm.xacro.push_back({{name, 0}, value});
  if (is_xacro(file)) {
    const std::string name = file.string();
    arm.expanded = std::make_shared<const std::string>(expanded_xacro(arm, yaml::Value(YAML::Node(), 0, "", name)));
  } else if (!arguments.empty()) {
    throw InputError({file.string(), 0}, "is no xacro file, and has no arguments", "a file that ends in .xacro");
  }
  return arm;
}

}  // namespace posewright
