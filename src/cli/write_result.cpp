#include "write_result.hpp"

#include <fmt/format.h>

#include "posewright/outputs/write_plan.hpp"
#include "posewright/support/file.hpp"
#include "terminal.hpp"

namespace posewright::cli {

po::options_description output_options(bool poses) {
  po::options_description options("Output");
  const auto text = [](const char* name) { return po::value<std::string>()->value_name(name); };
  options.add_options()("output,o", text("FILE"), "plan as JSON (plan.json; - for none)");
  if (poses) options.add_options()("poses-csv", text("FILE"), "poses as CSV (poses.csv; - for none)");
  options.add_options()                                         //
      ("force", "replace files that posewright did not write")  //
      ("time-limit", text("S"), "stop after S seconds with the best plan so far");
  return options;
}

std::optional<Repeats> repeats_of(const po::variables_map& values) {
  const std::string text = text_of(values, "repeats");
  if (text.empty()) return std::nullopt;
  if (text == "allow") return Repeats{Repeats::any_number};
  if (text == "forbid") return Repeats{1};
  if (text.find_first_not_of("0123456789") == std::string::npos)
    return Repeats{*whole_number(values, "repeats", 1, 1000000)};
  throw InputError({}, "--repeats " + text, "allowed: allow, forbid, or how often a pose may be measured");
}

Outputs::Outputs(const po::variables_map& values, const std::vector<std::filesystem::path>& inputs, bool poses) {
  const auto file_of = [&](const char* option, const char* standard) {
    const std::string text = values.count(option) > 0 ? text_of(values, option) : standard;
    if (text.empty()) throw InputError({}, std::string("--") + option + " is empty", "name a file, or - for none");
    return text == "-" ? std::filesystem::path() : std::filesystem::path(text);
  };
  plan_ = file_of("output", "plan.json");
  if (poses) poses_ = file_of("poses-csv", "poses.csv");
  std::vector<std::filesystem::path> files;
  for (const auto& file : {plan_, poses_})
    if (!file.empty()) files.push_back(file);
  check_outputs(files, inputs, values.count("force") > 0);
}

int Outputs::search_and_write(const CommonOptions& common, double seconds,
                              const std::function<Plan(const Monitor&)>& search) const {
  Plan plan;
  bool interrupted_by_user = false;
  {
    const Watch watch(common, seconds);
    plan = search(watch.monitor());
    interrupted_by_user = watch.was_interrupted();
  }
  const std::string json = plan_json(plan);
  if (!plan_.empty()) write_file_atomically(plan_, json);
  if (!poses_.empty()) write_file_atomically(poses_, poses_csv(plan));
  if (common.json) {
    fmt::print("{}", json);
  } else {
    print_report(plan_summary(plan));
    if (!plan_.empty()) fmt::print("Written: {}{}\n", plan_.string(), poses_.empty() ? "" : ", " + poses_.string());
  }
  return interrupted_by_user ? interrupted : done;
}

}  // namespace posewright::cli
