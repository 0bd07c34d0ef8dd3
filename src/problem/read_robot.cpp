#include <algorithm>
#include <map>

#include "posewright/support/near_words.hpp"
#include "posewright/support/text.hpp"
#include "sections.hpp"

namespace posewright {
namespace {

using yaml::Section;
using yaml::Sign;
using yaml::Value;

std::vector<std::pair<std::string, Located<std::string>>> read_parameter_names(const Value& value) {
  std::vector<std::pair<std::string, Located<std::string>>> names;
  std::map<std::string, std::string> taken;
  for (const yaml::Entry& entry : Section(value).entries()) {
    if (entry.key.value.find_first_of("*?") != std::string::npos)
      entry.value.fail("is a name with * or ?", "a plain name is expected");
    const Located<std::string> model_name = entry.value.exact_name();
    const auto [first, added] = taken.emplace(model_name.value, entry.key.value);
    if (!added)
      entry.value.fail("is " + in_quotes(model_name.value),
                       "that parameter already has the name " + in_quotes(first->second) + ", one name is allowed");
    names.emplace_back(entry.key.value, model_name);
  }
  return names;
}

std::vector<JointEffectsSpec> read_joint_effects(const Value& value) {
  std::vector<JointEffectsSpec> all;
  for (const yaml::Entry& entry : Section(value).entries()) {
    const Section section(entry.value);
    section.allow({"eccentricity", "gear_ratio", "coupling", "backlash", "overrun", "temperature"});
    JointEffectsSpec effects;
    effects.joint = entry.key;
    if (const Value* eccentricity = section.find("eccentricity")) effects.eccentricity = eccentricity->flag();
    if (const Value* ratio = section.find("gear_ratio")) {
      effects.gear_ratio = ratio->number(Quantity::number, Sign::positive);
      if (effects.eccentricity && (*effects.gear_ratio == 1 || *effects.gear_ratio == 2))
        ratio->fail("is a harmonic of eccentricity, too", "another ratio, or only one of them");
    }
    if (const Value* coupling = section.find("coupling")) effects.coupling = coupling->texts();
    if (const Value* backlash = section.find("backlash")) effects.backlash = backlash->flag();
    if (const Value* overrun = section.find("overrun")) {
      if (!effects.backlash) overrun->fail("needs backlash", "backlash: yes");
      effects.overrun = overrun->measured({Quantity::angle, Quantity::length}, Sign::positive);
    }
    if (const Value* temperature = section.find("temperature")) effects.temperature = temperature->flag();
    if (!effects.eccentricity && !effects.gear_ratio && effects.coupling.empty() && !effects.backlash &&
        !effects.temperature)
      entry.value.fail("has no effect", "eccentricity: yes, gear_ratio, coupling, backlash: yes or temperature: yes");
    all.push_back(std::move(effects));
  }
  return all;
}

TemperatureSpec read_temperature(const Value& value) {
  const Section section(value);
  section.allow({"reference", "at"});
  TemperatureSpec spec;
  if (const Value* reference = section.find("reference")) spec.reference = reference->number(Quantity::number);
  if (const Value* at = section.find("at"))
    for (const Value& one : at->items("a list of temperatures in degrees Celsius is expected"))
      spec.at.push_back(one.number(Quantity::number));
  if (spec.at.empty()) spec.at = {spec.reference};
  std::sort(spec.at.begin(), spec.at.end());
  if (std::adjacent_find(spec.at.begin(), spec.at.end()) != spec.at.end())
    value.fail("names a temperature twice", "at: [18, 25], each once, in degrees Celsius");
  return spec;
}

void read_xacro(const Section& robot, const Value& urdf, SerialArmSpec& arm) {
  const Value* arguments = robot.find("xacro");
  if (arguments != nullptr && !is_xacro(arm.urdf)) arguments->fail("needs a xacro file", "urdf: FILE.xacro");
  if (!is_xacro(arm.urdf)) return;
  if (arguments != nullptr)
    for (const yaml::Entry& entry : Section(*arguments).entries())
      arm.xacro.emplace_back(entry.key, entry.value.text_or_nothing());
  arm.expanded = std::make_shared<const std::string>(expanded_xacro(arm, urdf));
}

SerialArmSpec read_serial_arm(const Section& robot, const std::filesystem::path& file, const Packages& packages) {
  robot.allow({"urdf", "xacro", "srdf", "group", "base", "tip", "tips", "hold", "placement", "encoder_noise",
               "parameter_names", "elastostatic", "joint_effects", "temperature"});
  SerialArmSpec arm;
  const Value& urdf = robot.at("urdf");
  const std::filesystem::path folder = file.parent_path();
  const std::string name = urdf.text("a file name is expected");
  arm.urdf = names_package(name) ? file_of_uri(name, packages, file, urdf.place()) : urdf.base(folder) / name;
  arm.line = urdf.line();
  read_xacro(robot, urdf, arm);
  if (const Value* srdf = robot.find("srdf")) arm.srdf = {srdf->file(folder), srdf->line()};
  if (const Value* group = robot.find("group")) {
    arm.group = group->exact_name();
    if (!arm.srdf) group->fail("needs srdf", "srdf: FILE");
    if (robot.has("base") || robot.has("tip"))
      group->fail("cannot be combined with base or tip", "group, or base and tip");
  }
  if (const Value* tips = robot.find("tips"); tips != nullptr && (robot.has("tip") || arm.group))
    tips->fail("cannot be combined with tip or group", "tips, or one of these");
  if (const Value* base = robot.find("base")) arm.base = base->exact_name();
  if (const Value* tip = robot.find("tip")) arm.tip = tip->exact_name();
  if (const Value* hold = robot.find("hold"))
    for (const yaml::Entry& entry : Section(*hold).entries())
      arm.hold.emplace_back(entry.key, entry.value.measured({Quantity::angle, Quantity::length}, Sign::any));
  if (const Value* placement = robot.find("placement")) arm.placement = read_placement(Section(*placement));
  if (const Value* noise = robot.find("encoder_noise"))
    arm.encoder_noise = noise->measured({Quantity::angle, Quantity::length}, Sign::not_negative).value;
  if (const Value* names = robot.find("parameter_names")) arm.parameter_names = read_parameter_names(*names);
  if (const Value* elastostatic = robot.find("elastostatic")) arm.elastostatic = read_elastostatic(*elastostatic);
  if (const Value* effects = robot.find("joint_effects")) arm.joint_effects = read_joint_effects(*effects);
  if (const Value* temperature = robot.find("temperature")) {
    arm.temperature = read_temperature(*temperature);
    if (std::none_of(arm.joint_effects.begin(), arm.joint_effects.end(), [](const auto& e) { return e.temperature; }))
      temperature->fail("is used by no joint", "joint_effects: {NAME: {temperature: yes}}");
  }
  return arm;
}

/// Robots by the word under `model`; a new one is one row.
struct ModelReader {
  std::string_view name;
  RobotSpec (*read)(const Section& robot);
};
constexpr ModelReader models[] = {
    {"six_pus", [](const Section& robot) -> RobotSpec { return read_six_legs(robot, LegActuation::slide); }},
    {"gough", [](const Section& robot) -> RobotSpec { return read_six_legs(robot, LegActuation::extend); }},
    {"five_bar", [](const Section& robot) -> RobotSpec { return read_five_bar(robot); }},
    {"delta", [](const Section& robot) -> RobotSpec { return read_delta(robot); }},
    {"compensator", [](const Section& robot) -> RobotSpec { return read_compensator_geometry(robot); }},
};

RobotSpec read_model(const Value& model, const Section& robot) {
  std::string names;
  std::vector<std::string> words;
  for (const ModelReader& reader : models) words.emplace_back(reader.name);
  for (const ModelReader& reader : models) names += (names.empty() ? "allowed: " : ", ") + std::string(reader.name);
  const std::string wanted = model.text(names);
  for (const ModelReader& reader : models)
    if (reader.name == wanted) return reader.read(robot);
  model.fail("is " + in_quotes(wanted) + meant_instead(wanted, words), names);
}

GivenPosesSpec read_given_poses(const Value& poses, const Section& robot) {
  robot.allow({"poses", "placement", "tool"});
  if (!poses.flag()) poses.fail("is no", "poses: yes, or another robot: urdf, model");
  GivenPosesSpec spec;
  if (const Value* placement = robot.find("placement")) spec.placement = read_placement(Section(*placement));
  if (const Value* tool = robot.find("tool")) spec.tool = read_placement(Section(*tool));
  return spec;
}

}  // namespace

Placement read_placement(const Section& section) {
  section.allow({"position", "rpy"});
  Placement placement;
  if (const Value* position = section.find("position")) placement.position = position->vector(Quantity::length);
  if (const Value* rpy = section.find("rpy")) placement.rpy = rpy->vector(Quantity::angle);
  return placement;
}

RobotSpec read_robot(const Value& value, const std::filesystem::path& file, const Packages& packages) {
  const Section robot(value);
  const Value* model = robot.find("model");
  if (const Value* poses = robot.find("poses")) return read_given_poses(*poses, robot);
  if (model != nullptr && robot.has("urdf"))
    model->fail("cannot be combined with robot.urdf", "one of urdf, model is allowed");
  if (model != nullptr) return read_model(*model, robot);
  if (!robot.has("urdf")) {
    robot.allow({"urdf", "base", "tip", "tips", "hold", "placement", "encoder_noise", "parameter_names", "elastostatic",
                 "model", "poses"});
    value.fail("has neither urdf nor model nor poses", "one of them is required");
  }
  return read_serial_arm(robot, file, packages);
}

}  // namespace posewright
