#include "language.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "posewright/controller/axis_names.hpp"

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

const std::vector<Language>& languages() {
  static const std::vector<Language> table = {
      {"kuka-krl",
       {".dat", ".src"},
       ".src",
       krl_axis_names(),
       Angle::degrees,
       5,
       false,
       Scope::stem,
       true,
       'X',
       read_krl,
       krl_pose},
      {"abb-rapid",
       {".mod", ".prg"},
       "",
       rapid_axis_names(),
       Angle::degrees,
       4,
       true,
       Scope::all,
       true,
       0,
       read_rapid,
       rapid_pose},
      {"fanuc-tp", {".ls"}, "", tp_axis_names(), Angle::degrees, 5, true, Scope::file, true, 0, read_tp, tp_pose},
      {"urscript",
       {".script"},
       "",
       urscript_axis_names(),
       Angle::radians,
       6,
       false,
       Scope::file,
       false,
       0,
       read_urscript,
       urscript_pose},
      {"yaskawa-inform",
       {".jbi"},
       "",
       inform_axis_names(),
       Angle::pulses,
       0,
       true,
       Scope::file,
       true,
       0,
       read_inform,
       inform_pose},
      {"staubli-val3",
       {".dtx", ".pgx"},
       ".pgx",
       val3_axis_names(),
       Angle::degrees,
       4,
       false,
       Scope::folder,
       false,
       0,
       read_val3,
       val3_pose},
      {"joint-trajectory", {}, "", {}, Angle::radians, -1, false, Scope::file, false, 0, read_trajectory, nullptr}};
  return table;
}

const Language* language_of(std::string_view format) {
  const auto at =
      std::find_if(languages().begin(), languages().end(), [&](const Language& l) { return l.format == format; });
  return at == languages().end() ? nullptr : &*at;
}

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
