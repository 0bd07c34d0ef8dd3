#pragma once

#include <boost/program_options.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "posewright/options/option.hpp"

namespace posewright::cli {

namespace po = boost::program_options;

/// Exit codes, the same for every command.
enum ExitCode { done = 0, cannot_do = 1, bad_input = 2, interrupted = 130 };

using Words = std::vector<std::string>;

/// One row a command: what `posewright NAME` does.
struct Command {
  std::string name;
  std::string arguments;  ///< "PROBLEM"
  std::string summary;
  po::options_description (*options)();
  std::string example;
  int (*run)(const po::variables_map& values, const Words& positional);
  bool shares_tasks = false;  ///< among the processes that the program was started as
};

const std::vector<Command>& commands();

Command init_command();
Command plan_command();
Command observe_command();
Command select_command();
Command evaluate_command();
Command compare_command();
Command simulate_command();
Command calibrate_command();
Command compensate_command();
Command next_command();
Command route_command();
Command stations_command();
Command export_command();
Command report_command();
Command fleet_command();
Command merge_command();

/// Options that every command has.
struct CommonOptions {
  std::uint64_t seed = 0;
  int threads = 0;
  bool json = false, quiet = false, verbose = false;
  bool cache = true;  ///< candidates of earlier commands may be taken
};
po::options_description common_options();
CommonOptions common_values(const po::variables_map& values);

/// An option with a value, called `name` in the help.
inline po::typed_value<std::string>* text(const char* name) { return po::value<std::string>()->value_name(name); }

/// The one positional argument, or an error that names it.
std::string single(const Words& positional, const std::string& what);

/// A whole number within [lower, upper] as an optional; InputError names the option and the range.
std::optional<int> whole_number(const po::variables_map& values, const std::string& option, long lower, long upper);
/// The text of an option, empty if it is not given.
std::string text_of(const po::variables_map& values, const std::string& option);

void add_option(po::options_description& options, const OptionRow& row);
/// Words of the user for an option; none if it is not given.
std::optional<GivenOption> given_option(const po::variables_map& values, const OptionRow& row);

/// The options of a table as those of the program.
template <class Options>
po::options_description described(const OptionTable<Options>& table) {
  po::options_description options("Options");
  for (const OptionRow& row : table.rows()) add_option(options, row);
  return options;
}
/// Reads the options that are given into `options`, --seed and --threads too.
template <class Options>
void read_options(const OptionTable<Options>& table, const po::variables_map& values, Options& options) {
  table.read(options, [&](const OptionRow& row) { return given_option(values, row); });
  const CommonOptions common = common_values(values);
  set_run(options, common.seed, common.threads);
}

}  // namespace posewright::cli
