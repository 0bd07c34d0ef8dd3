#include <fmt/format.h>

#include <array>
#include <chrono>
#include <initializer_list>
#include <optional>
#include <thread>

#include "command.hpp"
#include "posewright/options/tables.hpp"
#include "posewright/report/draw_problem.hpp"
#include "posewright/report/judge_poses.hpp"
#include "posewright/report/report_problem.hpp"
#include "posewright/report/report_result.hpp"
#include "problem_source.hpp"
#include "session.hpp"
#include "signals.hpp"
#include "write_result.hpp"

namespace posewright::cli {
namespace {

po::options_description report_command_options() { return described(report_options()).add(problem_options()); }

/// Writes the page, or its data to stdout.
template <class Report>
void hand_out(const Report& report, const CommonOptions& common, const std::filesystem::path& page,
              const std::vector<std::string>& notes) {
  if (!page.empty()) write_results({{page, report_html(report)}});
  if (common.json) {
    fmt::print("{}", report_json(report));
    return;
  }
  for (const std::string& note : notes) fmt::print("{}\n", note);
  fmt::print("{}", written_text({page}));
}

/// A plan, its problem and what it was made of.
struct GivenPlan {
  std::filesystem::path file;
  Problem problem;
};

GivenPlan given_plan(const po::variables_map& values, const std::filesystem::path& plan,
                     std::vector<std::filesystem::path>& inputs) {
  GivenPlan given{plan, problem_for_plan(problem_file(values, plan), values, plan)};
  for (const std::filesystem::path& file : files_of(given.problem)) inputs.push_back(file);
  return given;
}

int report_plan(const po::variables_map& values, const CommonOptions& common, const std::filesystem::path& page,
                const std::filesystem::path& file) {
  ReportOptions options;
  read_options(report_options(), values, options);
  std::vector<std::filesystem::path> inputs{file};
  const GivenPlan plan = given_plan(values, file, inputs);
  if (!options.route.empty()) inputs.push_back(options.route);
  check_output_files(values, {page}, inputs);
  const auto [report, was_interrupted] = watched(common, time_limit(values), [&](const Monitor& monitor) {
    return report_problem(plan.problem, plan.file, options, monitor);
  });
  hand_out(report, common, page, report.notes);
  return was_interrupted ? interrupted : done;
}

/// Checks the combination of files before anything is read.
void refuse_options(const po::variables_map& values, std::initializer_list<const char*> names,
                    const std::string& shown) {
  for (const char* name : names)
    if (values.count(name) > 0)
      throw InputError({}, std::string("--") + name + " does not go with " + shown, "it goes with one PLAN");
}

int judge_list(const po::variables_map& values, const CommonOptions& common, const std::filesystem::path& file) {
  refuse_options(values, {"output", "route", "brief", "watch", "time-limit"}, "--judge");
  const Problem problem = problem_for_plan(problem_file(values, file), values, file);
  const auto [judged, was_interrupted] = watched(
      common, 0, [&](const Monitor& monitor) { return judge_poses(problem, file, text_of(values, "judge"), monitor); });
  fmt::print("{}", common.json ? report_json(judged) : judged_text(judged));
  return was_interrupted ? interrupted : done;
}

int report_cell(const po::variables_map& values, const CommonOptions& common, const std::filesystem::path& page,
                const std::filesystem::path& file) {
  refuse_options(values, {"route", "problem", "judge", "watch"}, "a problem file");
  const Problem problem = given_problem(file, values);
  check_output_files(values, {page}, files_of(problem));
  DrawOptions options;
  options.ways = values.count("brief") == 0;
  set_run(options, common.seed, common.threads);
  const auto [report, was_interrupted] = watched(
      common, time_limit(values), [&](const Monitor& monitor) { return draw_problem(problem, options, monitor); });
  if (was_interrupted) return interrupted;
  hand_out(report, common, page, report.faults);
  return done;
}

int report_plans(const po::variables_map& values, const CommonOptions& common, const std::filesystem::path& page,
                 const Words& files) {
  refuse_options(values, {"route", "brief", "time-limit", "judge", "watch"}, "two plans");
  std::vector<std::filesystem::path> inputs;
  std::vector<GivenPlan> plans;
  TwoPlansReport report;
  for (std::size_t i = 0; i < 2; ++i) {
    if (!is_plan(files[i])) throw InputError({files[i], 0}, "is no plan", "two plans are shown side by side");
    inputs.emplace_back(files[i]);
    plans.push_back(given_plan(values, files[i], inputs));
    report.files[i] = files[i];
  }
  check_output_files(values, {page}, inputs);
  ReportOptions options;
  options.sizes = options.candidates = false;
  options.threads = common.threads;
  report.plans = watched(common, 0, [&](const Monitor& monitor) {
                   return std::array<Report, 2>{report_problem(plans[0].problem, plans[0].file, options, monitor),
                                                report_problem(plans[1].problem, plans[1].file, options, monitor)};
                 }).result;
  report.title = report.plans[0].title;
  if (report.plans[1].title != report.title) report.title += " and " + report.plans[1].title;
  std::vector<std::string> notes;
  for (std::size_t i = 0; i < 2; ++i)
    for (const std::string& note : report.plans[i].notes) notes.push_back(report.files[i] + ": " + note);
  hand_out(report, common, page, notes);
  return done;
}

/// Reads the file until it is a result again: whoever writes it may be in the middle of it.
std::optional<ResultReport> changed_result(const std::filesystem::path& file, std::string& seen) {
  try {
    ResultReport report = report_result(file);
    if (report.result_json == seen) return std::nullopt;
    seen = report.result_json;
    return report;
  } catch (const InputError&) {
    return std::nullopt;
  }
}

/// Writes the page at every change of the result until it says that nothing more comes, or a signal. The last page
/// stands still.
int follow_result(const CommonOptions& common, const std::filesystem::path& page, const std::filesystem::path& file) {
  constexpr auto between_looks = std::chrono::milliseconds(200);
  constexpr double refresh = 2.0;
  ResultReport report = report_result(file);
  std::string seen = report.result_json;
  const Watch watch(common, 0);
  const auto write = [&](bool more) {
    report.refresh = more ? refresh : 0.0;
    write_results({{page, report_html(report)}});
    // Signals are passed over while files are written; between them one is to be heard.
    if (more) begin_stage(SignalStage::searching);
  };
  write(!report.ended);
  if (!common.quiet) print_notes({"open " + page.string() + "; it follows " + file.string() + " (Ctrl-C ends)"});
  while (!report.ended && !watch.monitor().should_stop()) {
    std::this_thread::sleep_for(between_looks);
    std::optional<ResultReport> changed = changed_result(file, seen);
    if (!changed) continue;
    report = std::move(*changed);
    write(!report.ended);
  }
  if (!report.ended) write(false);
  fmt::print("{}", written_text({page}));
  return watch.was_interrupted() ? interrupted : done;
}

int run_report(const po::variables_map& values, const Words& positional) {
  const CommonOptions common = common_values(values);
  const std::filesystem::path page = output_file(values, "output", "report.html");
  if (positional.size() == 2) return report_plans(values, common, page, positional);
  const std::filesystem::path file = single(positional, "PLAN, RESULT or PROBLEM");
  if (is_problem(file)) return report_cell(values, common, page, file);
  const bool watch = values.count("watch") > 0;
  if (is_plan(file)) {
    if (watch) throw InputError({}, "--watch does not go with a plan", "it goes with one RESULT");
    return values.count("judge") > 0 ? judge_list(values, common, file) : report_plan(values, common, page, file);
  }
  refuse_options(values, {"route", "problem", "brief", "time-limit", "judge", "package", "parameters"}, "a result");
  check_output_files(values, {page}, {file});
  if (watch) {
    if (page.empty() || common.json) throw InputError({}, "--watch writes a page", "-o FILE without --json");
    return follow_result(common, page, file);
  }
  hand_out(report_result(file), common, page, {});
  return done;
}

}  // namespace

Command report_command() {
  return {"report",
          "RESULT [PLAN]",
          "Writes an HTML page of a plan, of two plans, of a problem before its plan, or of a result of calibrate, "
          "compare, "
          "next, simulate, stations.",
          report_command_options,
          "posewright report plan.json --route route.json -o report.html",
          run_report};
}

}  // namespace posewright::cli
