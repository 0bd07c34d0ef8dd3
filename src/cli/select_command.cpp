#include "command.hpp"
#include "planners/registry.hpp"
#include "posewright/criterion/registry.hpp"
#include "posewright/tasks/select_blocks.hpp"
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
      ("restarts", text("k"), "starts of the search (10)")                                       //
      ("repeats", text("allow|forbid|k"), "whether, or how often, a block may be chosen (forbid)")(
          "reserve", "maximise what is left when the block that hurts most is lost");
  options.add(output_options(false));
  return options;
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
  select.restarts = whole_number(values, "restarts", 1, 1000000).value_or(select.restarts);
  select.repeats = repeats_of(values).value_or(Repeats{});
  select.reserve = values.count("reserve") > 0;
  select.seed = common.seed;
  select.threads = common.threads;
  const Outputs outputs(values, {file}, false);
  return outputs.search_and_write(common, time_limit(values),
                                  [&](const Monitor& monitor) { return select_blocks(file, select, monitor); });
}

}  // namespace

Command select_command() {
  return {"select",
          "BLOCKS",
          "The same search on your own whitened Jacobian blocks (.npy n×r×m, or CSV of n·r rows × m columns).",
          select_command_options,
          "posewright select blocks.npy --poses 20 -o plan.json",
          run_select};
}

}  // namespace posewright::cli
