#include "packages.hpp"

#include "posewright/pipeline/route_problem.hpp"
#include "posewright/problem/read_problem.hpp"

namespace posewright::cli {
namespace {

std::vector<std::pair<std::string, std::filesystem::path>> packages_of(const po::variables_map& values) {
  std::vector<std::pair<std::string, std::filesystem::path>> packages;
  if (values.count("package") == 0) return packages;
  for (const std::string& text : values["package"].as<Words>()) {
    const std::size_t equal = text.find('=');
    if (equal == std::string::npos || equal == 0 || equal + 1 == text.size())
      throw InputError({}, "--package " + text, "NAME=DIR is expected");
    const std::filesystem::path folder = text.substr(equal + 1);
    std::error_code code;
    if (!std::filesystem::is_directory(folder, code))
      throw InputError({}, "--package " + text + ": '" + folder.string() + "' is no folder",
                       "an existing folder is expected");
    packages.emplace_back(text.substr(0, equal), folder);
  }
  return packages;
}

}  // namespace

po::options_description package_options() {
  po::options_description options("Cell");
  options.add_options()("package", po::value<Words>()->value_name("NAME=DIR")->composing(),
                        "folder of package://NAME/ in the URDF (else ROS_PACKAGE_PATH, and around the URDF)");
  return options;
}

Problem problem_with_packages(const std::filesystem::path& file, const po::variables_map& values) {
  Problem problem = read_problem(file);
  problem.packages = packages_of(values);
  return problem;
}

std::filesystem::path problem_file(const po::variables_map& values, const std::filesystem::path& plan) {
  const std::filesystem::path given = text_of(values, "problem");
  return given.empty() ? problem_of_plan(plan) : given;
}

}  // namespace posewright::cli
