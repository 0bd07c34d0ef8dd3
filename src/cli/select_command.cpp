#include <charconv>

#include "command.hpp"
#include "planners/registry.hpp"
#include "posewright/criterion/registry.hpp"
#include "posewright/tasks/select_blocks.hpp"
#include "task_options.hpp"
#include "write_result.hpp"

namespace posewright::cli {
namespace {

po::options_description select_command_options() {
  po::options_description options("Options");
  options.add_options()                                                                          //
      ("poses", text("N"), "number of blocks to choose (required)")                              //
      ("rows", text("r"), "rows of a block; needed for CSV and two-dimensional .npy")            //
      ("nuisance", text("k"), "the leading k columns are nuisance: eliminated (0)")              //
      ("criterion", text("NAME"), ("what to maximise: " + criterion_names() + " (o1)").c_str())  //
      ("method", text("NAME"), ("planner: " + planner_names() + " (exchange)").c_str())          //
      ("restarts", text("k"), "starts of the search (10, or what --time-limit allows)")          //
      ("fixed", text("ROWS"), "blocks that are among the N: 3,17,25, from 0")                    //
      ("augment", text("ROWS"), "blocks that are measured already: N more come to them")         //
      ("repeats", text("allow|forbid|k"), "whether, or how often, a block may be chosen (forbid)")(
          "reserve", "maximise what is left when the block that hurts most is lost");
  options.add(output_options(false)).add(task_options());
  return options;
}

/// "3,17,25"; empty if the option is not given.
std::vector<int> row_list(const po::variables_map& values, const std::string& option) {
  std::vector<int> rows;
  if (values.count(option) == 0) return rows;
  const std::string text = text_of(values, option);
  const char *at = text.data(), *const end = at + text.size();
  while (true) {
    int row = 0;
    const auto [next, code] = std::from_chars(at, end, row);
    if (code != std::errc() || row < 0 || (next != end && *next != ','))
      throw InputError({}, "--" + option + " '" + text.substr(0, 40) + "'",
                       "numbers of blocks from 0, with commas between them: 3,17,25");
    rows.push_back(row);
    if (next == end) return rows;
    at = next + 1;
  }
}

int run_select(const po::variables_map& values, const Words& positional) {
  const CommonOptions common = common_values(values);
  const std::filesystem::path file = single(positional, "BLOCKS");
  SelectOptions select;
  select.rows = whole_number(values, "rows", 1, 100000);
  const auto poses = whole_number(values, "poses", 1, 1000000);
  if (!poses) throw InputError({}, "--poses is missing", "say how many blocks to choose");
  select.poses = *poses;
  select.nuisance = whole_number(values, "nuisance", 0, 100000).value_or(0);
  if (values.count("criterion") > 0) select.criterion = text_of(values, "criterion");
  if (values.count("method") > 0) select.method = text_of(values, "method");
  select.restarts = whole_number(values, "restarts", 1, 1000000);
  select.fixed = row_list(values, "fixed");
  select.measured = row_list(values, "augment");
  select.repeats = repeats_of(values).value_or(Repeats{});
  select.reserve = values.count("reserve") > 0;
  select.seed = common.seed;
  select.threads = common.threads;
  const auto engine = engine_of(values, "select");
  const Outputs outputs(values, {file}, false);
  return outputs.search_and_write(
      common, time_limit(values), [&](const Monitor& monitor) { return select_blocks(file, select, monitor); }, {},
      engine.get());
}

}  // namespace

Command select_command() {
  return {"select",
          "BLOCKS",
          "The same search on your own whitened Jacobian blocks (.npy n×r×m, or CSV of n·r rows × m columns).",
          select_command_options,
          "posewright select blocks.npy --poses 20 -o plan.json",
          run_select,
          true};
}

}  // namespace posewright::cli
