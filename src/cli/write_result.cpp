#include "write_result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "posewright/formats/pose_formats.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/json.hpp"
#include "posewright/support/sha256.hpp"
#include "processes.hpp"
#include "session.hpp"
#include "signals.hpp"
#include "terminal.hpp"

namespace posewright::cli {

namespace fs = std::filesystem;

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

NewFolders::NewFolders(const std::vector<fs::path>& files) {
  for (const fs::path& file : files)
    for (fs::path folder = file.parent_path(); !folder.empty() && !fs::exists(folder); folder = folder.parent_path())
      missing_.push_back(folder);
  std::error_code code;
  for (const fs::path& file : files)
    if (file.has_parent_path()) fs::create_directories(file.parent_path(), code);
}

NewFolders::~NewFolders() {
  std::error_code code;
  for (const fs::path& folder : missing_) fs::remove(folder, code);
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

// Plans are smaller; what is larger is not a plan of ours.
constexpr std::size_t most_bytes = 200'000'000;

/// Bytes without a note that they were an input; empty if there are none.
std::string bytes_of(const fs::path& file, std::size_t most) {
  std::ifstream in(file, std::ios::binary);
  std::string bytes(most, '\0');
  in.read(bytes.data(), std::streamsize(bytes.size()));
  bytes.resize(std::size_t(std::max<std::streamsize>(in.gcount(), 0)));
  return bytes;
}

bool is_posewright_json(const std::string& head) {
  return head.substr(0, 64).find("\"schema\": \"posewright/") != std::string::npos;
}

std::string size_limited(const fs::path& file) {
  std::error_code code;
  const auto size = fs::file_size(file, code);
  return code || size > most_bytes ? std::string() : bytes_of(file, std::size_t(size));
}

/// True if the plan or route in `record` says that it was written with `file` as it is now.
bool is_recorded(const fs::path& file, const fs::path& record) {
  std::error_code code;
  if (!fs::is_regular_file(record, code) || !is_posewright_json(bytes_of(record, 64))) return false;
  try {
    const nlohmann::json json = parse_json(size_limited(record));
    for (const nlohmann::json& written : json.value("files", nlohmann::json::array())) {
      const fs::path there = record.parent_path() / written.at("path").get<std::string>();
      if (fs::equivalent(there, file, code) && written.at("sha256") == sha256_hex(size_limited(file))) return true;
    }
  } catch (const nlohmann::json::exception&) {
    return false;
  }
  return false;
}

/// First bytes of what this program writes, and the comment in exported files that may hold one.
bool begins_like_ours(const fs::path& file) {
  const std::string head = bytes_of(file, 2048);
  return head.starts_with("posewright_parameters: 1\n") ||
         head.starts_with("<!doctype html><!-- posewright report -->") || is_posewright_json(head) ||
         head.find(export_mark) != std::string::npos;
}

bool is_earlier_result(const fs::path& file, const std::vector<fs::path>& outputs) {
  if (begins_like_ours(file)) return true;
  std::vector<fs::path> records = outputs;
  for (const char* name : {"plan.json", "route.json"}) records.push_back(file.parent_path() / name);
  return std::any_of(records.begin(), records.end(),
                     [&](const fs::path& record) { return record != file && is_recorded(file, record); });
}

fs::path place_of(const fs::path& file) {
  std::error_code code;
  const fs::path place = fs::weakly_canonical(fs::absolute(followed(file)), code);
  return code ? fs::absolute(file).lexically_normal() : place;
}

void refuse_inputs(const fs::path& output, const std::vector<fs::path>& inputs) {
  std::error_code code;
  if (!fs::is_regular_file(output, code)) return;
  for (const fs::path& input : inputs)
    if (fs::equivalent(output, input, code))
      throw InputError({}, output.string() + " is an input", "write the result to another file");
}

/// A folder of its own for what could not go where it should; empty if there is none to be had.
fs::path new_folder() {
  std::error_code code;
  const fs::path parent = fs::temp_directory_path(code);
  if (code) return {};
  std::string name = (parent / "posewright-XXXXXX").string();
  return ::mkdtemp(name.data()) == nullptr ? fs::path() : fs::path(name);
}

/// " The result is saved as …", or nothing.
std::string saved_elsewhere(const std::vector<FileToWrite>& files) {
  const fs::path folder = new_folder();
  if (folder.empty()) return {};
  std::string names;
  for (const FileToWrite& file : files) {
    try {
      write_file_atomically(folder / file.file.filename(), file.bytes);
      names += (names.empty() ? "" : ", ") + (folder / file.file.filename()).string();
    } catch (const CannotDo&) {
      continue;  // no room for this one either; a smaller one may have it
    }
  }
  std::error_code code;
  if (names.empty()) fs::remove(folder, code);
  return names.empty() ? std::string() : "; saved as " + names;
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

void check_outputs(const std::vector<fs::path>& outputs, const std::vector<fs::path>& inputs, bool force) {
  // It is tried whether files can be made, and they are removed again: not to be left behind.
  begin_stage(SignalStage::finishing);
  const std::vector<fs::path> met = files_read();
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    std::error_code code;
    refuse_inputs(outputs[i], inputs);
    refuse_inputs(outputs[i], met);
    for (std::size_t k = 0; k < i; ++k)
      if (place_of(outputs[i]) == place_of(outputs[k]))
        throw InputError({}, outputs[i].string() + " is named for two outputs", "give each a file of its own");
    if (fs::is_regular_file(outputs[i], code) && fs::file_size(outputs[i], code) > 0 && !force &&
        !is_earlier_result(outputs[i], outputs))
      throw CannotDo(outputs[i].string() + " exists and is not known to be written by posewright; --force replaces it");
    require_writable(outputs[i]);
  }
  begin_stage(SignalStage::nothing_to_lose);
}

bool begins_with(const fs::path& file, const std::string& bytes) {
  std::error_code code;
  return fs::is_regular_file(file, code) && bytes_of(file, bytes.size()) == bytes;
}

bool holds(const fs::path& file, const std::string& bytes) {
  std::error_code code;
  return fs::file_size(file, code) == bytes.size() && !code && begins_with(file, bytes);
}

std::vector<WrittenWith> written_with(const fs::path& main, const std::vector<FileToWrite>& others) {
  std::vector<WrittenWith> result;
  const fs::path folder = place_of(main).parent_path();
  for (const FileToWrite& file : others) {
    const fs::path place = place_of(file.file);
    const fs::path relative = place.lexically_relative(folder);
    result.push_back({(relative.empty() ? place : relative).string(), sha256_hex(file.bytes)});
  }
  return result;
}

namespace {

/// Files of this run that are whole.
std::vector<fs::path> saved;

}  // namespace

std::string saved_before() {
  std::string names;
  for (const fs::path& file : saved) names += (names.empty() ? "; saved as " : ", ") + file.string();
  return names;
}

void write_results(const std::vector<FileToWrite>& files) {
  if (files.empty()) return;
  begin_stage(SignalStage::finishing);
  std::vector<fs::path> names;
  names.reserve(files.size());
  for (const FileToWrite& file : files) names.push_back(file.file);
  saved.reserve(saved.size() + names.size());
  try {
    // Stages that came after the first check may have read more.
    for (const FileToWrite& file : files) refuse_inputs(file.file, files_read());
    write_files(files);
    std::ranges::move(names, std::back_inserter(saved));
  } catch (const std::runtime_error& error) {
    throw CannotDo(error.what() + saved_elsewhere(files));
  }
}

}  // namespace posewright::cli
