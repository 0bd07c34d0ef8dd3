#include "problem_source.hpp"

#include <algorithm>
#include <iterator>

#include "posewright/lists/parameters_file.hpp"
#include "posewright/model/apply_parameters.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/tasks/route_problem.hpp"
#include "session.hpp"

namespace posewright::cli {
namespace {

void add_package_option(po::options_description& options) {
  options.add_options()(
      "package", po::value<Words>()->value_name("NAME=DIR")->composing(),
      "folder of package://NAME/ and model://NAME/ (else ROS's and Gazebo's paths, and around the URDF)");
}

void apply(Problem& problem, const std::filesystem::path& file, const std::vector<std::string>& asked) {
  print_notes(apply_parameters(problem, read_calibrated_parameters(file), asked));
}

KeyEdits edits_of(const po::variables_map& values) {
  KeyEdits edits;
  if (values.count("set") == 0) return edits;
  for (const std::string& text : values["set"].as<Words>()) {
    const std::size_t equal = text.find('=');
    if (equal == std::string::npos) throw InputError({}, "--set " + text.substr(0, 60), "KEY=VALUE is expected");
    edits.push_back({text.substr(0, equal), text.substr(equal + 1)});
  }
  return edits;
}

}  // namespace

Packages packages_of(const po::variables_map& values) {
  Packages packages;
  if (values.count("package") == 0) return packages;
  for (const std::string& text : values["package"].as<Words>()) {
    const std::size_t equal = text.find('=');
    if (equal == std::string::npos || equal == 0 || equal + 1 == text.size())
      throw InputError({}, "--package " + text, "NAME=DIR is expected");
    const std::filesystem::path folder = text.substr(equal + 1);
    std::error_code code;
    if (!std::filesystem::is_directory(folder, code))
      throw InputError({}, "--package " + text + ": '" + folder.string() + "' is not a folder",
                       "an existing folder is expected");
    packages.emplace_back(text.substr(0, equal), folder);
  }
  return packages;
}

po::options_description package_options() {
  po::options_description options("Robot");
  add_package_option(options);
  return options;
}

void add_set_option(po::options_description& options) {
  options.add_options()("set", po::value<Words>()->value_name("KEY=VALUE")->composing(),
                        "value of a key in place of the file's: measurement.device.noise='0.05 mm'");
}

po::options_description problem_options() {
  po::options_description options("Problem");
  add_package_option(options);
  add_set_option(options);
  options.add_options()("parameters", po::value<std::string>()->value_name("FILE"),
                        "calibrated parameters to linearise at (nominal ones; for a plan: its own)");
  return options;
}

std::vector<std::string> variants_of(const po::variables_map& values) {
  if (values.count("variant") == 0) return {};
  const boost::any& given = values["variant"].value();
  const auto* several = boost::any_cast<Words>(&given);
  return names_of({"--variant", several != nullptr ? *several : Words{boost::any_cast<const std::string&>(given)}});
}

Problem given_problem(const std::filesystem::path& file, const po::variables_map& values, KeyEdits changed) {
  std::ranges::move(edits_of(values), std::back_inserter(changed));
  Problem problem = read_problem(file, packages_of(values), changed);
  if (values.count("parameters") > 0) apply(problem, text_of(values, "parameters"), variants_of(values));
  return problem;
}

std::filesystem::path problem_file(const po::variables_map& values, const std::filesystem::path& plan) {
  const std::filesystem::path given = text_of(values, "problem");
  return given.empty() ? problem_of_plan(plan) : given;
}

Problem problem_for_plan(const std::filesystem::path& file, const po::variables_map& values,
                         const std::filesystem::path& plan) {
  Problem problem = given_problem(file, values, edits_of_plan(plan));
  if (problem.parameters) return problem;
  if (const ParametersFile stated = parameters_of_plan(plan); !stated.file.empty())
    apply(problem, stated.file, {stated.variant});
  return problem;
}

std::vector<std::filesystem::path> files_of(const Problem& problem) {
  std::vector<std::filesystem::path> files{problem.file};
  const auto add = [&](const std::filesystem::path& file) {
    if (!file.empty()) files.push_back(file);
  };
  if (problem.parameters) add(problem.parameters->file);
  if (const auto* arm = std::get_if<SerialArmSpec>(&problem.robot)) {
    add(arm->urdf);
    if (arm->srdf) add(arm->srdf->value);
  }
  if (problem.design.candidates_from) add(problem.design.candidates_from->value);
  if (problem.design.measured) add(*problem.design.measured);
  if (problem.design.fixed) add(*problem.design.fixed);
  if (problem.design.test_poses) add(problem.design.test_poses->file);
  if (problem.workspace.controller) add(problem.workspace.controller->path);
  if (!problem.workspace.collision) return files;
  const CollisionSpec& collision = *problem.workspace.collision;
  if (collision.srdf) add(collision.srdf->value);
  for (const ObstacleFileSpec& obstacles : collision.obstacle_files) add(obstacles.file);
  for (const auto* bodies : {&collision.obstacles, &collision.tool})
    for (const BodySpec& body : *bodies)
      if (const auto* mesh = std::get_if<MeshShape>(&body.shape)) add(mesh->file);
  return files;
}

}  // namespace posewright::cli
