#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "command.hpp"
#include "posewright/formats/pose_formats.hpp"
#include "posewright/options/tables.hpp"
#include "posewright/support/json.hpp"
#include "posewright/support/table.hpp"
#include "posewright/support/text_file.hpp"
#include "posewright/tasks/export_sequence.hpp"
#include "problem_source.hpp"
#include "session.hpp"
#include "write_result.hpp"

namespace posewright::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t plan_limit = 200'000'000;

po::options_description export_command_options() { return described(export_options()).add(problem_options()); }

ExportOptions options_of(const PoseFormat& format, const po::variables_map& values, const fs::path& output) {
  std::vector<std::string> given;
  for (const auto& row : export_options().rows())
    if (row.read && values.count(row.name) > 0) given.push_back(row.name);
  require_read(format, given);
  ExportOptions result;
  read_options(export_options(), values, result);
  // A program is called as its file.
  if (result.name.empty() && format.controller && !format.extension.empty() && output.extension() == format.extension &&
      std::find(format.options.begin(), format.options.end(), "name") != format.options.end())
    result.name = output.stem().string();
  return result;
}

/// The problem that a program is checked against; none for lists and if nobody asks.
std::optional<Problem> problem_of(const PoseFormat& format, const fs::path& plan, const po::variables_map& values) {
  if (!format.moves_robot()) {
    for (const char* option : {"problem", "unchecked", "package", "parameters"})
      if (values.count(option) > 0)
        throw InputError({}, fmt::format("--{} is not read for {}", option, format.name), "lists are not checked");
    return std::nullopt;
  }
  if (values.count("unchecked") > 0) return std::nullopt;
  return problem_for_plan(problem_file(values, plan), values, plan);
}

/// Path of each file.
std::vector<fs::path> places(const PoseFormat& format, const Exported& exported, const fs::path& output) {
  std::vector<fs::path> result;
  const bool to_file = !output.empty() && !fs::is_directory(output) && output.has_filename();
  if (!format.several_files && to_file) return {output};
  // Files of one program are called as the program.
  const bool named = to_file && !format.extension.empty() && output.extension() == format.extension;
  if (named && output.filename() != exported.files.front().name)
    throw InputError({},
                     fmt::format("--name {} is not the name of {}",
                                 fs::path(exported.files.front().name).stem().string(), output.filename().string()),
                     "a " + format.name + " program is called as its file");
  const fs::path folder = named ? output.parent_path() : output;
  for (const ExportedFile& file : exported.files) result.push_back(folder / file.name);
  return result;
}

/// Refuses to replace measured values in a file by predictions. Such a file still begins as ours does.
void keep_measurements(const PoseFormat& format, const std::vector<fs::path>& files, const Exported& exported) {
  if (!format.to_be_filled) return;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const std::string& bytes = exported.files[i].bytes;
    if (begins_with(files[i], bytes.substr(0, bytes.find('\n'))) && !holds(files[i], bytes))
      throw CannotDo(files[i].string() + " exists and may hold measurements by now; --force replaces it");
  }
}

/// Files that differ from the text to write.
std::vector<fs::path> changed(const std::vector<fs::path>& files, const Exported& exported) {
  std::vector<fs::path> result;
  for (std::size_t i = 0; i < files.size(); ++i)
    if (!holds(files[i], exported.files[i].bytes)) result.push_back(files[i]);
  return result;
}

/// The first file is the program, or what opens the others: it is written when they are there.
std::vector<FileToWrite> with_program_last(const std::vector<fs::path>& files, const Exported& exported) {
  std::vector<FileToWrite> result;
  for (std::size_t i = 0; i < files.size(); ++i) result.push_back({files[i], exported.files[i].bytes});
  std::rotate(result.begin(), result.begin() + 1, result.end());
  return result;
}

void require_ending(const PoseFormat& format, const fs::path& output) {
  if (format.several_files && output.has_extension() && !fs::is_directory(output) &&
      output.extension() != format.extension)
    throw InputError({}, output.string() + " has another ending",
                     format.name + " has several files: name a folder" +
                         (format.extension.empty() ? "" : " or a file that ends in " + format.extension));
  if (format.ending_matters && output.has_filename() && !fs::is_directory(output) &&
      output.extension() != format.extension)
    throw InputError({}, output.string() + " has another ending",
                     format.used_by + " reads files that end in " + format.extension);
}

void print_table(bool json) {
  if (json) {
    nlohmann::ordered_json list = {{"schema", "posewright/formats/1"}, {"formats", nlohmann::ordered_json::array()}};
    for (const PoseFormat& format : pose_formats())
      list["formats"].push_back({{"name", format.name},
                                 {"description", format.description},
                                 {"used_by", format.used_by},
                                 {"extension", format.extension},
                                 {"needs", format.needs},
                                 {"options", format.options},
                                 {"read_back", format.read != nullptr},
                                 {"note", format.controller ? no_controller_note : ""}});
    fmt::print("{}", json_text(list));
    return;
  }
  Table table({"format", "what", "read by", "ending", "--from", "needs"}, "l");
  for (const PoseFormat& format : pose_formats())
    table.row({format.name + (format.controller ? " *" : ""), format.description, format.used_by,
               format.extension.empty() ? "folder" : format.extension, format.read != nullptr ? "yes" : "",
               format.needs});
  fmt::print("{}\n* {}\n", table.text(), no_controller_note);
}

std::string summary_json(const PoseFormat& format, const PoseSequence& sequence, const std::vector<fs::path>& files,
                         const std::vector<std::string>& notes) {
  nlohmann::ordered_json json = {{"schema", "posewright/export/1"}, {"format", format.name}, {"plan", sequence.file}};
  json["poses"] =
      std::count_if(sequence.poses.begin(), sequence.poses.end(), [](const auto& pose) { return !pose.measured; });
  json["files"] = nlohmann::ordered_json::array();
  for (const fs::path& file : files) json["files"].push_back(file.string());
  json["notes"] = notes;
  return json_text(json);
}

int run_export(const po::variables_map& values, const Words& positional) {
  const CommonOptions common = common_values(values);
  const std::string to = text_of(values, "to");
  if (to.empty() || to == "list") {
    print_table(common.json);
    return done;
  }
  const PoseFormat& format = find_pose_format(to);
  const fs::path plan = single(positional, "PLAN");
  const std::string given = text_of(values, "output");
  const bool to_stdout = given == "-";
  if (to_stdout && (common.json || format.several_files))
    throw InputError({}, format.several_files ? format.name + " has several files" : "--json and -o - both need stdout",
                     "give -o a file or folder");
  const fs::path output = to_stdout ? fs::path() : fs::path(given);
  const ExportOptions export_settings = options_of(format, values, output);
  require_ending(format, output);
  const PoseSequence sequence = parse_sequence(read_text(plan, plan_limit), plan.string());
  const std::optional<Problem> problem = problem_of(format, plan, values);
  const Exported exported = export_sequence(format, sequence, export_settings, problem ? &*problem : nullptr);
  if (to_stdout) {
    std::fwrite(exported.files.front().bytes.data(), 1, exported.files.front().bytes.size(), stdout);
    print_notes(exported.notes);
    return done;
  }
  const std::vector<fs::path> files = places(format, exported, output);
  std::vector<fs::path> inputs = {plan};
  if (const fs::path file = export_settings.controller.path; !file.empty()) inputs.push_back(file);
  const NewFolders folders(format.several_files ? files : std::vector<fs::path>());
  if (values.count("force") == 0) keep_measurements(format, files, exported);
  check_outputs(changed(files, exported), inputs, values.count("force") > 0);
  write_results(with_program_last(files, exported));
  print_notes(exported.notes);
  if (common.json) {
    fmt::print("{}", summary_json(format, sequence, files, exported.notes));
  } else {
    fmt::print("{}", written_text(files));
  }
  return done;
}

}  // namespace

Command export_command() {
  return {"export",
          "PLAN",
          "Writes the poses of a plan or route as robot programs and as pose lists of calibration tools.",
          export_command_options,
          "posewright export route.json --to kuka-krl -o CALPOSES.src",
          run_export};
}

}  // namespace posewright::cli
