#include "document.hpp"

#include "posewright/lists/parameters_file.hpp"
#include "posewright/version.hpp"

namespace posewright {
namespace {

nlohmann::ordered_json problem_json(const Problem& problem) {
  nlohmann::ordered_json json = {{"file", problem.file.string()}, {"sha256", problem.sha256}};
  if (const ParametersFile stated = parameters_of(problem); !stated.file.empty())
    json["parameters"] = {{"file", stated.file}, {"sha256", stated.sha256}, {"variant", stated.variant}};
  return json;
}

}  // namespace

nlohmann::ordered_json begin_document(const char* schema, const Problem& problem) {
  return {{"schema", schema}, {"version", version}, {"problem", problem_json(problem)}};
}

nlohmann::ordered_json begin_document(const char* schema, const Problem& problem, std::uint64_t seed) {
  return {{"schema", schema}, {"version", version}, {"seed", seed}, {"problem", problem_json(problem)}};
}

}  // namespace posewright
