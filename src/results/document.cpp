#include "document.hpp"

#include "posewright/lists/parameters_file.hpp"
#include "posewright/problem/design_keys.hpp"
#include "posewright/version.hpp"
#include "sight_json.hpp"

namespace posewright {

ProblemOrigin origin_of(const Problem& problem) {
  ProblemOrigin origin{problem.file.string(), problem.sha256, parameters_of(problem), problem.changed};
  // A result has the poses of a list itself; the file may move.
  std::erase_if(origin.changed,
                [](const KeyEdit& edit) { return is_of_design(edit) && design_key(edit.key).lists_poses; });
  return origin;
}

nlohmann::ordered_json begin_document(const char* schema, const Problem& problem) {
  return {{"schema", schema}, {"version", version}, {"problem", problem_json(origin_of(problem))}};
}

nlohmann::ordered_json begin_document(const char* schema, const Problem& problem, std::uint64_t seed) {
  return {{"schema", schema}, {"version", version}, {"seed", seed}, {"problem", problem_json(origin_of(problem))}};
}

}  // namespace posewright
