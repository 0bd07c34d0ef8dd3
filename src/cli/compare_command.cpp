#include <fmt/format.h>

#include "command.hpp"
#include "design_options.hpp"
#include "posewright/formats/pose_formats.hpp"
#include "posewright/lists/read_poses.hpp"
#include "posewright/options/tables.hpp"
#include "posewright/results/comparison.hpp"
#include "posewright/study/variant.hpp"
#include "posewright/support/json.hpp"
#include "posewright/tasks/compare_problem.hpp"
#include "problem_source.hpp"
#include "session.hpp"
#include "terminal.hpp"

namespace posewright::cli {
namespace {

DesignOptions compare_keys() { return {"poses", "method", "candidates", "restarts"}; }

po::options_description compare_command_options() {
  po::options_description options = described(compare_options());
  add_design_options(options, compare_keys());
  return options.add(resume_option()).add(problem_options());
}

CompareOptions options_of(const Problem& problem, const po::variables_map& values, const Words& positional) {
  CompareOptions compare;
  read_options(compare_options(), values, compare);
  const std::string from = text_of(values, "from");
  if (!from.empty()) find_readable_format(from);
  const bool given = positional.size() > 1;
  for (const char* option : {"poses", "method", "restarts"})
    if (given && values.count(option) > 0)
      throw InputError({}, std::string("--") + option + " is for plans that are searched",
                       "leave it out, or the plans");
  if (!given && !from.empty()) throw InputError({}, "--from is for given plans", "name them after the problem");
  if (!given) return compare;
  const std::vector<Coordinate> coordinates =
      pose_coordinates(problem, compare.variants.empty() ? "" : compare.variants.front());
  for (std::size_t i = 1; i < positional.size(); ++i)
    compare.plans.push_back({positional[i], read_poses(positional[i], coordinates, from)});
  return compare;
}

int run_compare(const po::variables_map& values, const Words& positional) {
  const CommonOptions common = common_values(values);
  if (positional.empty()) throw InputError({}, "PROBLEM is missing", "see posewright help compare");
  const Problem problem = designed_problem(positional.front(), values, compare_keys());
  const CompareOptions compare = options_of(problem, values, positional);
  const auto engine = engine_of(values, "compare");
  const auto [result, was_interrupted] = watched(
      common, 0, [&](const Monitor& monitor) { return compare_problem(problem, compare, monitor); }, engine.get());
  print_notes(result.notes);
  const int code = was_interrupted ? interrupted : done;
  if (!common.json) {
    print_report(comparison_text(result, !compare.truth.empty()));
    return code;
  }
  fmt::print("{}", json_text(comparison_json(problem, compare.run.seed, result)));
  return code;
}

}  // namespace

Command compare_command() {
  return {"compare",
          "PROBLEM [PLAN...]",
          "Compares variants and plans: efficiency, σ, accuracy, bias by effects of another variant.",
          compare_command_options,
          "posewright compare examples/telescope/problem.yaml --variant rigid,linear,matrix",
          run_compare,
          true};
}

}  // namespace posewright::cli
