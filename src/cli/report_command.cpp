#include <fmt/format.h>

#include "command.hpp"
#include "posewright/tasks/report_problem.hpp"
#include "problem_source.hpp"
#include "result_files.hpp"
#include "session.hpp"
#include "write_result.hpp"

namespace posewright::cli {
namespace {

po::options_description report_command_options() {
  po::options_description options("Options");
  options.add_options()                                                                                       //
      ("output,o", text("FILE"), "the page (report.html; - for none)")                                        //
      ("route", text("FILE"), "route of the plan: its order and motions are shown (none)")                    //
      ("problem", text("FILE"), "problem file (the one the plan names)")                                      //
      ("brief", "leave out what takes long: other numbers of poses, sensitivity of candidates, moved poses")  //
      ("force", "replace files that posewright did not write")                                                //
      ("time-limit", text("S"), "begin no other number of poses after S seconds");
  options.add(problem_options());
  return options;
}

int run_report(const po::variables_map& values, const Words& positional) {
  const CommonOptions common = common_values(values);
  const std::filesystem::path plan = single(positional, "PLAN");
  ReportOptions report_options;
  report_options.route = text_of(values, "route");
  report_options.sizes = report_options.candidates = report_options.moves = values.count("brief") == 0;
  report_options.threads = common.threads;
  const std::filesystem::path file = problem_file(values, plan);
  const std::filesystem::path page = output_file(values, "output", "report.html");
  const Problem problem = problem_for_plan(file, values, plan);
  std::vector<std::filesystem::path> inputs = files_of(problem);
  inputs.push_back(plan);
  if (!report_options.route.empty()) inputs.push_back(report_options.route);
  check_output_files(values, {page}, inputs);
  const auto [report, was_interrupted] = watched(common, time_limit(values), [&](const Monitor& monitor) {
    return report_problem(problem, plan, report_options, monitor);
  });
  if (!page.empty()) write_results({{page, report_html(report)}});
  if (common.json) {
    fmt::print("{}", report_json(report));
  } else {
    for (const std::string& note : report.notes) fmt::print("{}\n", note);
    fmt::print("{}", written_text({page}));
  }
  return was_interrupted ? interrupted : done;
}

}  // namespace

Command report_command() {
  return {"report",
          "PLAN",
          "Writes a page to look at: robot, poses, accuracy, what each pose brings.",
          report_command_options,
          "posewright report plan.json --route route.json -o report.html",
          run_report};
}

}  // namespace posewright::cli
