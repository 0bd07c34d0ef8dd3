#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "command.hpp"
#include "design_options.hpp"
#include "posewright/results/plan.hpp"
#include "posewright/results/stated_error.hpp"
#include "posewright/support/bytes.hpp"
#include "posewright/support/json.hpp"
#include "posewright/support/table.hpp"
#include "posewright/tasks/plan_fleet.hpp"
#include "problem_source.hpp"
#include "session.hpp"
#include "terminal.hpp"
#include "write_result.hpp"

namespace posewright::cli {
namespace {

namespace fs = std::filesystem;

DesignOptions fleet_keys() { return {"poses", "restarts"}; }

po::options_description fleet_command_options() {
  po::options_description options("Options");
  options.add_options()                                                                                    //
      ("output-dir", text("DIR"), "folder for NAME.plan.json and NAME.poses.csv, created if missing (.)")  //
      ("force", "replace files that posewright did not write")                                             //
      ("time-limit", text("S"), "stop after S seconds; finished plans are written");
  add_design_options(options, fleet_keys());
  add_set_option(options);
  options.add(task_options()).add(package_options());
  return options;
}

/// Name of a problem's files: the file's name, or its folder's where every file is called "problem".
std::vector<std::string> names_of(const std::vector<Problem>& problems) {
  std::vector<std::string> names;
  std::map<std::string, int> count;
  for (const Problem& problem : problems) {
    const fs::path file = fs::absolute(problem.file);
    const bool plain = file.stem() == "problem" && file.has_parent_path();
    names.push_back(plain ? file.parent_path().filename().string() : file.stem().string());
    if (count[names.back()]++ > 0)
      throw InputError({}, problem.file.string() + ": its plan would be named " + names.back() + " as another's",
                       "problem files of different names are needed");
  }
  return names;
}

struct FleetFiles {
  fs::path plan, poses;
};

void write(const FleetFiles& files, const FleetPlan& plan) {
  ByteReader bytes(plan.rendered);
  const auto json = bytes.get<std::string>(), csv = bytes.get<std::string>();
  write_results({{files.poses, csv}, {files.plan, json}});
}

std::string fleet_text(const std::vector<std::string>& names, const std::vector<FleetPlan>& fleet) {
  Table table({"robot", "variant", "poses", "log det", "of the best at least", "predicted error", "from noise alone"},
              "llr");
  std::string failures;
  for (std::size_t i = 0; i < fleet.size(); ++i) {
    const FleetPlan& plan = fleet[i];
    if (!plan.why_not.empty()) {
      failures += names[i] + ": " + plan.why_not + "\n";
      continue;
    }
    table.row({names[i], plan.variant, std::to_string(plan.poses), fmt::format("{:.4f}", plan.log_det),
               plan.efficiency ? percent(*plan.efficiency) : "", plan.expected ? with_effect_text(*plan.expected) : "",
               plan.expected ? shown_value(plan.expected->by_noise, "m") : ""});
  }
  return table.text() + (failures.empty() ? "" : "\nNot planned:\n" + failures);
}

std::string fleet_json(const std::vector<std::string>& names, const std::vector<Problem>& problems,
                       const std::vector<FleetPlan>& fleet, const std::vector<FleetFiles>& files) {
  nlohmann::ordered_json plans = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < fleet.size(); ++i) {
    nlohmann::ordered_json one{{"name", names[i]}, {"problem", problems[i].file.string()}};
    if (!fleet[i].why_not.empty()) {
      one["why_not"] = fleet[i].why_not;
    } else {
      one["variant"] = fleet[i].variant;
      one["plan"] = files[i].plan.string();
      one["poses"] = fleet[i].poses;
      one["log_det"] = fleet[i].log_det;
      if (fleet[i].efficiency) one["efficiency"] = *fleet[i].efficiency;
      if (fleet[i].expected) one["expected_error"] = expected_error_json(*fleet[i].expected);
      one["seconds"] = fleet[i].seconds;
    }
    plans.push_back(std::move(one));
  }
  return json_text(nlohmann::ordered_json{{"schema", "posewright/fleet/1"}, {"plans", std::move(plans)}});
}

int run_fleet(const po::variables_map& values, const Words& positional) {
  const CommonOptions common = common_values(values);
  if (positional.empty()) throw InputError({}, "no problem files are named", "see posewright help fleet");
  RunOptions run;
  set_run(run, common.seed, common.threads);
  const auto engine = engine_of(values, "fleet");
  std::vector<Problem> problems;
  std::vector<fs::path> inputs, outputs;
  for (const std::string& file : positional) {
    problems.push_back(designed_problem(file, values, fleet_keys()));
    const auto named = files_of(problems.back());
    inputs.insert(inputs.end(), named.begin(), named.end());
  }
  const std::vector<std::string> names = names_of(problems);
  const fs::path folder = values.count("output-dir") > 0 ? text_of(values, "output-dir") : ".";
  std::vector<FleetFiles> files;
  for (const std::string& name : names) {
    files.push_back({folder / (name + ".plan.json"), folder / (name + ".poses.csv")});
    outputs.insert(outputs.end(), {files.back().plan, files.back().poses});
  }
  std::error_code code;
  if (engine->writes()) {
    fs::create_directories(folder, code);
    check_output_files(values, outputs, inputs);
  }
  const auto render = [&](const Plan& plan, std::size_t i) {
    const std::string csv = poses_csv(plan);
    ByteWriter bytes;
    bytes.put(plan_json(plan, written_with(files[i].plan, {{files[i].poses, csv}})));
    bytes.put(csv);
    return bytes.take();
  };
  const auto [fleet, was_interrupted] = watched(
      common, time_limit(values), [&](const Monitor& monitor) { return plan_fleet(problems, run, render, monitor); },
      engine.get());
  for (std::size_t i = 0; i < fleet.size(); ++i)
    if (fleet[i].why_not.empty()) write(files[i], fleet[i]);
  if (common.json) fmt::print("{}", fleet_json(names, problems, fleet, files));
  else print_report(fleet_text(names, fleet));
  if (was_interrupted) return interrupted;
  return std::all_of(fleet.begin(), fleet.end(), [](const FleetPlan& plan) { return plan.why_not.empty(); })
             ? done
             : cannot_do;
}

}  // namespace

Command fleet_command() {
  return {"fleet",
          "PROBLEM...",
          "Plans several robots, each by its own problem file.",
          fleet_command_options,
          "posewright fleet examples/delta/problem.yaml examples/gough/problem.yaml --output-dir plans",
          run_fleet,
          true};
}

}  // namespace posewright::cli
