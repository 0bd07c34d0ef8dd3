#include "posewright/problem/calibrated_problem.hpp"

#include <fmt/format.h>

#include "posewright/support/error.hpp"
#include "posewright/support/sha256.hpp"
#include "posewright/support/text_file.hpp"
#include "yaml_section.hpp"

namespace posewright {
namespace {

constexpr std::size_t file_size_limit = 10'000'000;

}  // namespace

std::filesystem::path problem_of_parameters(const std::filesystem::path& parameters) {
  const std::string place = parameters.string(), text = read_text(parameters, file_size_limit);
  const yaml::Section root(yaml::Value(yaml::load_document(text, place), 1, "", place));
  const yaml::Value* problem = root.find("problem");
  if (problem == nullptr || !problem->is_mapping())
    throw InputError({place, 0}, "names no problem file", "problem: {file, sha256}, or --problem FILE");
  const yaml::Section section(*problem);
  const std::string name = section.at("file").text(), sha256 = section.at("sha256").text();
  std::error_code code;
  for (const std::filesystem::path& file : {std::filesystem::path(name), parameters.parent_path() / name,
                                            parameters.parent_path() / std::filesystem::path(name).filename()}) {
    if (!std::filesystem::is_regular_file(file, code)) continue;
    const std::string found = sha256_hex(read_text(file, file_size_limit));
    if (found == sha256) return file;
    throw InputError(
        {place, problem->line()},
        fmt::format("{} has sha256 {:.8}…, the problem that was calibrated {:.8}…", file.string(), found, sha256),
        "the problem file as it was, or --problem FILE if it is the same robot");
  }
  throw InputError({place, problem->line()}, "its problem file '" + name + "' is not there",
                   "name it with --problem FILE");
}

}  // namespace posewright
