#include <fmt/format.h>

#include "command.hpp"
#include "posewright/support/task_log.hpp"
#include "terminal.hpp"
#include "write_result.hpp"

namespace posewright::cli {
namespace {

po::options_description merge_command_options() {
  po::options_description options("Options");
  options.add_options()                                                 //
      ("output,o", text("LOG"), "joined log, for --resume (required)")  //
      ("force", "replace a file that posewright did not write");
  return options;
}

int run_merge(const po::variables_map& values, const Words& positional) {
  if (positional.empty()) throw InputError({}, "no logs are named", "see posewright help merge");
  if (values.count("output") == 0) throw InputError({}, "-o is missing", "name the file for the whole log");
  const std::filesystem::path output = output_file(values, "output", "");
  const std::vector<std::filesystem::path> parts(positional.begin(), positional.end());
  check_output_files(values, {output}, parts);
  const LoggedTasks whole = merged(parts);
  write_results({{output, task_log_bytes(whole)}});
  std::string counts;
  for (const auto& [number, group] : whole.groups)
    counts += (counts.empty() ? "" : ", ") + fmt::format("{} {}", group.count, group.name);
  if (common_values(values).json) fmt::print("{{\"log\": \"{}\"}}\n", output.string());
  else print_report(fmt::format("{} logs hold {}.\n", parts.size(), counts) + written_text({output}));
  return done;
}

}  // namespace

Command merge_command() {
  return {"merge",
          "LOG...",
          "Joins the logs of the shares of a large computation into one.",
          merge_command_options,
          "posewright merge part1.log part2.log -o whole.log",
          run_merge};
}

}  // namespace posewright::cli
