#include <fmt/format.h>

#include "command.hpp"
#include "posewright/options/tables.hpp"
#include "posewright/tasks/select_blocks.hpp"
#include "session.hpp"
#include "terminal.hpp"
#include "write_result.hpp"

namespace posewright::cli {
namespace {

po::options_description select_command_options() {
  return described(select_options()).add(output_options(false)).add(task_options());
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
  read_options(select_options(), values, select);
  if (select.poses == 0) throw InputError({}, "--poses is missing", "give the number of blocks to choose");
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
