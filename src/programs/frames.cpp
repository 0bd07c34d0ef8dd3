#include "frames.hpp"

#include <fmt/format.h>

namespace posewright::programs {
namespace {

/// The number in TOOL_DATA[1] and USER 1, else the name in capitals.
std::string short_name(const std::string& name) {
  for (const char* data : {"TOOL_DATA[", "BASE_DATA[", "TOOL ", "USER "})
    if (const std::string begin = data; name.starts_with(begin))
      return name.substr(begin.size(), name.size() - begin.size() - (name.ends_with(']') ? 1 : 0));
  return upper(name);
}

/// tool0, wobj0, frame 0 of KRL and TP: no displacement at all. INFORM's tool 0 is a tool as others.
bool is_identity(const std::string& name, bool tool) {
  return name == (tool ? "TOOL0" : "WOBJ0") || name == "0" || name == "TOOL_DATA[0]" || name == "BASE_DATA[0]";
}

std::vector<double> no_displacement(const PoseForm& form) { return form.written(Eigen::Isometry3d::Identity()); }

}  // namespace

void FrameValues::add(const Language& language, const Reading& reading) {
  for (const auto& [name, values] : reading.frames) values_.insert({language.format + '\n' + name, values});
  for (const auto& [name, pair] : reading.frame_data) data_.insert({language.format + '\n' + name, pair});
}

FrameName FrameValues::named(const Language& language, const FrameName& frame, bool tool) const {
  const auto at = data_.find(language.format + '\n' + frame.name);
  return at == data_.end() ? frame : tool ? at->second.tool : at->second.base;
}

std::optional<std::vector<double>> FrameValues::values(const Language& language, const FrameName& named,
                                                       bool tool) const {
  if (named.values) return named.values;
  const auto& given = tool ? given_.tools : given_.bases;
  for (const std::string& key : {named.name, short_name(named.name)})
    if (const auto at = given.find(key); !key.empty() && at != given.end()) return at->second;
  if (const auto at = values_.find(language.format + '\n' + named.name); at != values_.end()) return at->second;
  if (is_identity(named.name, tool)) return no_displacement(language.pose());
  if (const auto at = given.find(""); at != given.end()) return at->second;
  if (!tool && named.name.empty() && language.pose().in_robot_base) return no_displacement(language.pose());
  return std::nullopt;
}

std::optional<PlacedFrames> FrameValues::of(const Language& language, const FramePair& frames, std::string& why) const {
  const PoseForm& form = language.pose();
  const FrameName tool_name = named(language, frames.tool, true), base_name = named(language, frames.base, false);
  const auto tool = values(language, tool_name, true), base = values(language, base_name, false);
  for (const auto& [found, name, option] :
       {std::tuple(&tool, tool_name.name, "--tool"), std::tuple(&base, base_name.name, "--base")})
    if (!*found || (*found)->size() != form.values.size()) {
      why = name.empty() ? fmt::format("the program does not state its {}: {}", option + 2, option)
                         : fmt::format("{} has no value in these files: {}", name, option);
      return std::nullopt;
    }
  return PlacedFrames{given_.X_BaseWorld * form.place(*base), given_.X_TipFlange * form.place(*tool)};
}

}  // namespace posewright::programs
