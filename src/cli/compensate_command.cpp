#include <fmt/format.h>

#include "command.hpp"
#include "posewright/model/apply_parameters.hpp"
#include "posewright/model/calibrated_values.hpp"
#include "posewright/model/corrected_urdf.hpp"
#include "posewright/model/dh_table.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/model/ur_kinematics.hpp"
#include "posewright/model/variant_columns.hpp"
#include "posewright/options/tables.hpp"
#include "posewright/problem/calibrated_problem.hpp"
#include "posewright/results/calibrated_dh_table.hpp"
#include "posewright/results/compensation.hpp"
#include "posewright/support/json.hpp"
#include "posewright/tasks/compensate_documents.hpp"
#include "problem_source.hpp"
#include "session.hpp"
#include "terminal.hpp"
#include "write_result.hpp"

namespace posewright::cli {
namespace {

namespace fs = std::filesystem;

po::options_description compensate_command_options() { return described(compensate_options()).add(package_options()); }

/// The robot that was calibrated, with its parameters.
Problem calibrated_problem(const po::variables_map& values, const fs::path& parameters) {
  const std::string given = text_of(values, "problem");
  Problem problem = given_problem(given.empty() ? problem_of_parameters(parameters) : fs::path(given), values);
  print_notes(apply_parameters(problem, read_calibrated_parameters(parameters), {}));
  return problem;
}

/// Paths of the output: one file by its name, several into a folder under their own names.
std::vector<fs::path> output_places(const po::variables_map& values, const Words& files) {
  const fs::path output = output_file(values, "output");
  if (output.empty()) return {};
  std::error_code code;
  const bool folder =
      fs::is_directory(output, code) || (!fs::exists(output, code) && (files.size() > 1 || !output.has_filename()));
  if (files.empty()) throw InputError({}, "-o without a file of poses", "PARAMETERS FILE…");
  if (files.size() > 1 && !folder)
    throw InputError({}, output.string() + " is not a folder", "several files go to a folder");
  std::vector<fs::path> result;
  for (const std::string& file : files) result.push_back(folder ? output / fs::path(file).filename() : output);
  return result;
}

/// Output files of the robot itself, as `calibrate` writes them.
struct RobotFiles {
  fs::path urdf, xacro, kinematics;  ///< empty: not asked for
  std::optional<DhTable> table;
  std::vector<FileToWrite> files;
  std::vector<std::string> notes;

  RobotFiles(const po::variables_map& values, std::optional<DhConvention> dh)
      : urdf(output_file(values, "urdf")),
        xacro(output_file(values, "xacro")),
        kinematics(output_file(values, "ur-kinematics")),
        dh_(dh) {}

  bool any() const { return !urdf.empty() || !xacro.empty() || !kinematics.empty() || dh_; }

  void make(const Problem& problem) {
    if (!any()) return;
    const auto* arm = std::get_if<SerialArmSpec>(&problem.robot);
    if (arm == nullptr)
      throw InputError({}, "--urdf, --xacro, --ur-kinematics and --dh are for serial arms", "robot: urdf");
    const SourcePlace place = problem.at(arm->line);
    const VariantSpec& variant = find_variant(problem, problem.parameters->variant.value);
    const std::vector<CalibratedValue> values =
        calibrated_values({problem, variant}, *make_model({problem, variant}), {});
    if (!urdf.empty()) {
      const CorrectedUrdf corrected = corrected_urdf(*arm, place, variant.convention, values);
      add(urdf, corrected.text, "URDF", corrected.left_out);
    }
    if (!xacro.empty()) {
      const CorrectedUrdf corrected = corrected_xacro(*arm, place, variant.convention, values);
      add(xacro, corrected.text, "xacro file", corrected.left_out);
    }
    if (!kinematics.empty()) {
      const UrKinematics ur = ur_kinematics(*arm, place, variant.convention, values,
                                            "posewright_" + problem.parameters->sha256.substr(0, 16));
      add(kinematics, ur.text, "kinematics file", ur.left_out);
      notes.emplace_back(
          "the hash of the kinematics file differs from the controller's own calibration, so the driver will warn");
    }
    if (dh_) table = dh_table(*arm, place, variant.convention, values, *dh_);
  }

 private:
  void add(const fs::path& file, const std::string& text, const char* what, const std::vector<std::string>& left_out) {
    files.push_back({file, text});
    for (const std::string& left : left_out) notes.push_back(std::string("not in the ") + what + ": " + left);
  }

  std::optional<DhConvention> dh_;
};

void show_compensation(const CommonOptions& common, const Problem& problem, const Compensation& result,
                       const RobotFiles& robot, const std::vector<fs::path>& written) {
  print_notes(result.notes);
  if (common.json) {
    nlohmann::ordered_json json = compensation_json(problem, result);
    if (robot.table) json["denavit_hartenberg"] = dh_table_json(*robot.table);
    json["written"] = nlohmann::ordered_json::array();
    for (const fs::path& file : written) json["written"].push_back(file.string());
    fmt::print("{}", json_text(json));
    return;
  }
  std::string text = result.lists.empty() ? "" : compensation_text(result);
  for (const std::string& part : {robot.table ? dh_table_text(*robot.table) : "", written_text(written)})
    if (!part.empty()) text += (text.empty() ? "" : "\n") + part;
  print_report(text);
}

int run_compensate(const po::variables_map& values, const Words& positional) {
  const CommonOptions common = common_values(values);
  if (positional.empty()) throw InputError({}, "PARAMETERS is missing", "see posewright help compensate");
  const fs::path parameters = positional.front();
  const Words files(positional.begin() + 1, positional.end());
  CompensateCall call;
  read_options(compensate_options(), values, call);
  RobotFiles robot(values, call.dh);
  if (files.empty() && !robot.any())
    throw InputError({}, "FILE is missing", "poses to compensate, --urdf, --xacro, --ur-kinematics or --dh");
  const std::vector<fs::path> to = output_places(values, files);
  const Problem problem = calibrated_problem(values, parameters);

  std::vector<fs::path> outputs = to, inputs = files_of(problem);
  outputs.insert(outputs.end(), {robot.urdf, robot.xacro, robot.kinematics});
  inputs.insert(inputs.end(), files.begin(), files.end());
  const bool to_folder = !to.empty() && to.front() != fs::path(text_of(values, "output"));
  const NewFolders folders(to_folder ? to : std::vector<fs::path>());
  check_output_files(values, outputs, inputs);
  robot.make(problem);

  CompensatedDocuments made;
  made.result.variant = problem.parameters->variant.value;
  if (!files.empty())
    made = watched(common, 0, [&](const Monitor& monitor) {
             return compensate_documents(problem, {files.begin(), files.end()}, call, monitor);
           }).result;
  Compensation& result = made.result;
  result.notes.insert(result.notes.end(), robot.notes.begin(), robot.notes.end());
  std::vector<fs::path> written;
  if (made.good) {
    std::vector<FileToWrite> all = robot.files;
    for (std::size_t i = 0; i < to.size(); ++i) all.push_back({to[i], made.texts[i]});
    write_results(all);
    for (const FileToWrite& file : all) written.push_back(file.file);
  } else if (!to.empty() || !robot.files.empty()) {
    // No option writes a line that is left by more than is allowed.
    const bool helps = !result.is_whole() && !call.partial;
    result.notes.emplace_back(std::string("no file is written") +
                              (helps ? "; --partial keeps uncompensated poses unchanged" : ""));
  }
  show_compensation(common, problem, result, robot, written);
  return made.good ? done : cannot_do;
}

}  // namespace

Command compensate_command() {
  return {"compensate",
          "PARAMETERS [FILE…]",
          "Corrects poses and robot programs so that the real robot reaches the intended poses.",
          compensate_command_options,
          "posewright compensate calibrated.yaml program.src program.dat -o corrected/",
          run_compensate};
}

}  // namespace posewright::cli
