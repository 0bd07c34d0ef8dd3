#include <charconv>

#include "command.hpp"

namespace posewright::cli {

const std::vector<Command>& commands() {
  static const std::vector<Command> table = {
      init_command(),     observe_command(),    plan_command(),     select_command(),
      evaluate_command(), compare_command(),    simulate_command(), calibrate_command(),
      next_command(),     compensate_command(), route_command(),    stations_command(),
      export_command(),   report_command(),     fleet_command(),    merge_command()};
  return table;
}

po::options_description common_options() {
  po::options_description options("Common options");
  options.add_options()                                                           //
      ("seed", text("S"), "seed of all random numbers (0)")                       //
      ("threads", text("T"), "number of threads (all); does not change results")  //
      ("no-cache", "draw candidates anew, and keep none for later commands")      //
      ("json", "print the result as JSON, and nothing else, to stdout")           //
      ("markdown", "tables as Markdown")                                          //
      ("quiet", "do not show progress")                                           //
      ("verbose", "show progress even if stderr is not a terminal")               //
      ("help", "show this help");
  return options;
}

CommonOptions common_values(const po::variables_map& values) {
  CommonOptions common;
  common.json = values.count("json") > 0;
  common.quiet = values.count("quiet") > 0;
  common.cache = values.count("no-cache") == 0;
  common.verbose = values.count("verbose") > 0;
  common.threads = whole_number(values, "threads", 1, 4096).value_or(0);
  const std::string seed = text_of(values, "seed");
  const auto [end, code] = std::from_chars(seed.data(), seed.data() + seed.size(), common.seed);
  if (!seed.empty() && (code != std::errc() || end != seed.data() + seed.size()))
    throw InputError({}, "--seed " + seed + " is not a seed", "a whole number from 0 to 18446744073709551615");
  return common;
}

std::string single(const Words& positional, const std::string& what) {
  if (positional.empty()) throw InputError({}, what + " is missing", "see posewright --help");
  if (positional.size() > 1)
    throw InputError({}, "unexpected argument '" + positional[1] + "'", "one " + what + " is expected");
  return positional.front();
}

void add_option(po::options_description& options, const OptionRow& row) {
  if (row.value.empty()) {
    options.add_options()(row.name.c_str(), row.help.c_str());
  } else if (row.kind == OptionKind::list) {
    options.add_options()(row.name.c_str(), po::value<Words>()->value_name(row.value)->composing(), row.help.c_str());
  } else {
    options.add_options()(row.name.c_str(), text(row.value.c_str()), row.help.c_str());
  }
}

std::optional<GivenOption> given_option(const po::variables_map& values, const OptionRow& row) {
  const std::string name = row.long_name();
  if (values.count(name) == 0) return std::nullopt;
  GivenOption given{"--" + name, {}};
  if (row.kind == OptionKind::list) given.values = values[name].as<Words>();
  else if (!row.value.empty()) given.values = {text_of(values, name)};
  return given;
}

std::optional<int> whole_number(const po::variables_map& values, const std::string& option, long lower, long upper) {
  if (values.count(option) == 0) return std::nullopt;
  return whole_of({"--" + option, {text_of(values, option)}}, lower, upper);
}

std::string text_of(const po::variables_map& values, const std::string& option) {
  return values.count(option) > 0 ? values[option].as<std::string>() : std::string();
}

}  // namespace posewright::cli
