#include "write_result.hpp"

#include <fmt/format.h>

#include "posewright/results/plan.hpp"
#include "processes.hpp"
#include "result_files.hpp"
#include "terminal.hpp"

namespace posewright::cli {

po::options_description output_options(bool poses) {
  po::options_description options("Output");
  options.add_options()("output,o", text("FILE"), "plan as JSON (plan.json; - for none)");
  if (poses)
    options.add_options()("poses-csv", text("FILE"),
                          "poses as CSV (poses.csv beside plan.json, a-poses.csv beside a.json; - for none)");
  options.add_options()                                         //
      ("force", "replace files that posewright did not write")  //
      ("time-limit", text("S"), "stop after S seconds with the best plan so far");
  return options;
}

std::filesystem::path output_file(const po::variables_map& values, const std::string& option, const char* standard) {
  const std::string text = values.count(option) > 0 ? text_of(values, option) : standard;
  if (text.empty()) throw InputError({}, "--" + option + " is empty", "name a file, or - for none");
  return text == "-" ? std::filesystem::path() : std::filesystem::path(text);
}

void check_output_files(const po::variables_map& values, const std::vector<std::filesystem::path>& outputs,
                        const std::vector<std::filesystem::path>& inputs) {
  std::vector<std::filesystem::path> files;
  for (const auto& file : outputs)
    if (!file.empty()) files.push_back(file);
  check_outputs(files, inputs, values.count("force") > 0);
}

std::string written_text(const std::vector<std::filesystem::path>& outputs) {
  std::string names;
  for (const auto& output : outputs)
    if (!output.empty()) names += (names.empty() ? "" : ", ") + output.string();
  return names.empty() ? names : "Written: " + names + "\n";
}

namespace {

/// plan.json: plan-validation.json.
std::filesystem::path for_validation(std::filesystem::path file) {
  if (file.empty()) return file;
  return file.replace_filename(file.stem().string() + "-validation" + file.extension().string());
}

/// plan.json: poses.csv; arm.plan.json: arm.poses.csv; a.json: a-poses.csv. Two plans in a folder have two lists.
std::filesystem::path list_beside(std::filesystem::path plan) {
  if (plan.empty()) return "poses.csv";
  const std::string stem = plan.stem().string(), word = "plan";
  const bool begins = stem.starts_with(word + "-") || stem == word;
  if (begins) return plan.replace_filename("poses" + stem.substr(word.size()) + ".csv");
  if (stem.ends_with(".plan")) return plan.replace_filename(stem.substr(0, stem.size() - word.size()) + "poses.csv");
  return plan.replace_filename(stem + "-poses.csv");
}

std::string validation_text(const Plan& plan) {
  std::string ids;
  for (const PlannedPose& pose : plan.poses)
    if (!pose.measured) ids += (ids.empty() ? "" : ", ") + std::to_string(pose.id);
  return fmt::format("\nFor validation, not to be fitted: poses {}, chosen by criterion {} in addition to the plan's\n",
                     ids, plan.criterion);
}

}  // namespace

Outputs::Outputs(const po::variables_map& values, const std::vector<std::filesystem::path>& inputs, bool poses,
                 bool validation) {
  plan_ = output_file(values, "output", "plan.json");
  if (poses) poses_ = output_file(values, "poses-csv", list_beside(plan_).c_str());
  if (validation) {
    validation_plan_ = for_validation(plan_);
    validation_poses_ = for_validation(poses_);
  }
  // Several processes that try the same file would be in each other's way.
  if (started_workers()->rank() == 0)
    check_output_files(values, {plan_, poses_, validation_plan_, validation_poses_}, inputs);
}

std::string Outputs::write(const Plan& plan, const std::filesystem::path& json, const std::filesystem::path& csv) {
  std::vector<FileToWrite> files;
  if (!csv.empty()) files.push_back({csv, poses_csv(plan)});
  std::string text = plan_json(plan, json.empty() ? std::vector<WrittenWith>() : written_with(json, files));
  if (!json.empty()) files.push_back({json, text});
  write_results(files);
  return text;
}

int Outputs::search_and_write(const CommonOptions& common, double seconds,
                              const std::function<Plan(const Monitor&)>& search,
                              const std::function<Plan(const Plan&, const Monitor&)>& validation,
                              TaskEngine* engine) const {
  const auto [plan, was_interrupted] = watched(common, seconds, search, engine);
  const auto show = [&, &found = plan](const std::string& json, const std::string& written) {
    if (common.json) fmt::print("{}", json);
    else print_report(plan_summary(found) + written);
  };
  try {
    const std::string json = write(plan, plan_, poses_);
    show(json, written_text({plan_, poses_}));
  } catch (const CannotDo&) {
    // What a long search found is told, whatever becomes of its files.
    show(plan_json(plan), "");
    throw;
  }
  if (!validation || was_interrupted) return was_interrupted ? interrupted : done;
  try {
    const auto [second, stopped] =
        watched(common, seconds, [&, &first = plan](const Monitor& monitor) { return validation(first, monitor); });
    write(second, validation_plan_, validation_poses_);
    if (!common.json) print_report(validation_text(second) + written_text({validation_plan_, validation_poses_}));
    return stopped ? interrupted : done;
  } catch (const CannotDo& error) {
    throw CannotDo(std::string("--validation: ") + error.what());
  }
}

}  // namespace posewright::cli
