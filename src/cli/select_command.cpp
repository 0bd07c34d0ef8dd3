#include <fmt/format.h>

#include <charconv>

#include "command.hpp"
#include "planners/registry.hpp"
#include "posewright/criterion/registry.hpp"
#include "posewright/tasks/select_blocks.hpp"
#include "task_options.hpp"
#include "terminal.hpp"
#include "write_result.hpp"

namespace posewright::cli {
namespace {

po::options_description select_command_options() {
  po::options_description options("Options");
  options.add_options()                                                                                            //
      ("poses", text("N"), "number of blocks to choose (required)")                                                //
      ("rows", text("r"), "rows of a block; needed for CSV and two-dimensional .npy")                              //
      ("nuisance", text("k"), "the first k columns are nuisance parameters, estimated along with the others (0)")  //
      ("criterion", text("NAME"), ("criterion to maximise: " + criterion_names() + " (o1)").c_str())               //
      ("method", text("NAME"), ("planner: " + planner_names() + " (exchange)").c_str())                            //
      ("restarts", text("k"), "starts of the search (10, or what --time-limit allows)")                            //
      ("fixed", text("ROWS"), "blocks that must be chosen: 3,17,25, counted from 0")                               //
      ("augment", text("ROWS"), "already measured blocks; chooses N additional ones")                              //
      ("repeats", text("allow|forbid|k"), "how often a block may be chosen (forbid)")(
          "gap", text("P"), "gap in percent at which branch_and_bound stops (proved to rounding)")(
          "reserve", "optimise for the loss of the worst single block")(
          "spread", "spread the blocks over the processes (mpirun, srun), if one memory cannot hold them");
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
                       "numbers of blocks from 0, separated by commas: 3,17,25");
    rows.push_back(row);
    if (next == end) return rows;
    at = next + 1;
  }
}

/// Traffic between the processes for each exchange.
void tell_of_spread(const SpreadTraffic& traffic, int processes, const CommonOptions& common) {
  if (!common.verbose) return;
  const auto each = [](long of_all, long count) { return count > 0 ? double(of_all) / double(count) : 0.0; };
  print_aside(fmt::format(
      "posewright: blocks spread over {} processes; {} looks for an exchange, an all-reduce of {} bytes each; {} "
      "blocks "
      "of {} bytes sent to all; the busiest process had {:.2f} messages of {:.0f} bytes in all for a look, {:.2f} of "
      "{:.0f} for a block\n",
      processes, traffic.looks, traffic.look_bytes, traffic.blocks, traffic.block_bytes,
      each(traffic.most_of_looks.messages, traffic.looks), each(traffic.most_of_looks.bytes, traffic.looks),
      each(traffic.most_of_blocks.messages, traffic.blocks), each(traffic.most_of_blocks.bytes, traffic.blocks)));
}

/// Spread candidates have no tasks of their own: an exchange follows from the one before.
void require_no_log(const po::variables_map& values) {
  for (const char* option : {"resume", "shard"})
    if (values.count(option) > 0)
      throw InputError({}, std::string("--") + option + " with --spread",
                       "one exchange follows from the other: there are no finished tasks to keep");
}

int run_select(const po::variables_map& values, const Words& positional) {
  const CommonOptions common = common_values(values);
  const std::filesystem::path file = single(positional, "BLOCKS");
  SelectOptions select;
  select.rows = whole_number(values, "rows", 1, 100000);
  const auto poses = whole_number(values, "poses", 1, 1000000);
  if (!poses) throw InputError({}, "--poses is missing", "give the number of blocks to choose");
  select.poses = *poses;
  select.nuisance = whole_number(values, "nuisance", 0, 100000).value_or(0);
  if (values.count("criterion") > 0) select.criterion = text_of(values, "criterion");
  if (values.count("method") > 0) select.method = text_of(values, "method");
  select.restarts = whole_number(values, "restarts", 1, 1000000);
  select.fixed = row_list(values, "fixed");
  select.measured = row_list(values, "augment");
  select.repeats = repeats_of(values).value_or(Repeats{});
  if (const auto gap = number_below(values, "gap", 100, "percent, above 0 and below 100, are allowed"))
    select.gap = *gap / 100;
  select.reserve = values.count("reserve") > 0;
  select.seed = common.seed;
  select.threads = common.threads;
  const bool spread = values.count("spread") > 0;
  if (spread) require_no_log(values);
  const auto engine = engine_of(values, "select");
  const Outputs outputs(values, {file}, false);
  if (spread)
    return outputs.search_and_write(
        common, time_limit(values),
        [&](const Monitor& monitor) {
          SpreadTraffic traffic;
          Plan plan = select_spread(file, select, engine->workers(), monitor, traffic);
          tell_of_spread(traffic, engine->workers().processes(), common);
          return plan;
        },
        {}, engine.get());
  return outputs.search_and_write(
      common, time_limit(values), [&](const Monitor& monitor) { return select_blocks(file, select, monitor); }, {},
      engine.get());
}

}  // namespace

Command select_command() {
  return {"select",
          "BLOCKS",
          "Plans with your own Jacobian blocks, scaled to unit noise (.npy n×r×m, or CSV of n·r rows × m columns).",
          select_command_options,
          "posewright select blocks.npy --poses 20 -o plan.json",
          run_select,
          true};
}

}  // namespace posewright::cli
