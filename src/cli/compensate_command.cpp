#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "command.hpp"
#include "posewright/controller/known_controllers.hpp"
#include "posewright/lists/parameters_file.hpp"
#include "posewright/lists/pose_document.hpp"
#include "posewright/model/apply_parameters.hpp"
#include "posewright/model/calibrated_values.hpp"
#include "posewright/model/corrected_urdf.hpp"
#include "posewright/model/dh_table.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/model/ur_kinematics.hpp"
#include "posewright/model/variant.hpp"
#include "posewright/problem/calibrated_problem.hpp"
#include "posewright/results/compensation.hpp"
#include "posewright/results/dh_table.hpp"
#include "posewright/support/json.hpp"
#include "problem_source.hpp"
#include "result_files.hpp"
#include "session.hpp"
#include "terminal.hpp"
#include "write_result.hpp"

namespace posewright::cli {
namespace {

namespace fs = std::filesystem;

po::options_description compensate_command_options() {
  po::options_description options("Options");
  options.add_options()                                                                                         //
      ("output,o", text("FILE|DIR"), "corrected file; a folder for several files")                              //
      ("partial", "write files even if some poses or program lines are not compensated; those stay unchanged")  //
      ("from", text("FORMAT"), "format of the files (by ending and first character: JSON, CSV, programs)")      //
      ("controller", text("NAME"),
       "controller of programs: known name, or YAML file with sign, zero_deg, range_deg, …")               //
      ("coupling", text("F"), "programs: J3 of the controller is J3 - F*J2 of the robot; 0: no coupling")  //
      ("tool", po::value<Words>(),
       "tool frame of poses in programs: [NAME=]X Y Z and angles, in the language's order and units")  //
      ("base", po::value<Words>(), "base or user frame of these poses, in the same form")              //
      ("world", text("POSE"),
       "pose of the controller's world frame in the robot's base: x y z roll pitch yaw, mm and deg")    //
      ("flange", text("POSE"), "pose of the controller's flange in the robot's tip, in the same form")  //
      ("near", text("JOINTS"),
       "URScript: joints near those of poses that follow no known joints, deg, as the robot's file counts them")  //
      ("line-deviation", text("MM"), "largest allowed distance of the tool from straight lines of programs")      //
      ("problem", text("FILE"), "problem file of the robot (the one named by the parameters, unchanged)")         //
      ("with-base", "poses refer to the measurement frame: include the estimated pose of the base")               //
      ("without-tool", "leave out the tool's correction, if another tool was measured")                           //
      ("position-only", "correct the position of the tip only (robots with fewer than six axes)")                 //
      ("elastic-target", "the poses include the nominal deflection under load already")                           //
      ("most", text("DEG"), "largest correction of a joint (10; prismatic joints: 10 mm per degree)");
  options.add_options()                                                                                           //
      ("urdf", text("FILE"), "the robot's URDF with the calibrated kinematics")                                   //
      ("xacro", text("FILE"), "the robot's xacro file with the calibrated kinematics; comments and macros stay")  //
      ("ur-kinematics", text("FILE"), "kinematics.yaml of ur_description (Universal Robots)")                     //
      ("dh", text("KIND"), "table of Denavit-Hartenberg parameters: distal or proximal (modified)")               //
      ("force", "replace files that posewright did not write");
  options.add(package_options());
  return options;
}

/// The robot that was calibrated, with its parameters.
Problem calibrated_problem(const po::variables_map& values, const fs::path& parameters) {
  const std::string given = text_of(values, "problem");
  Problem problem = given_problem(given.empty() ? problem_of_parameters(parameters) : fs::path(given), values);
  print_notes(apply_parameters(problem, read_calibrated_parameters(parameters), {}));
  return problem;
}

CompensateOptions compensation_options(const po::variables_map& values, const CommonOptions& common) {
  CompensateOptions options;
  options.solver.with_base = values.count("with-base") > 0;
  options.solver.with_tool = values.count("without-tool") == 0;
  options.solver.position_only = values.count("position-only") > 0;
  options.elastic_target = values.count("elastic-target") > 0;
  if (const auto most = number_between(values, "most", 0.01, 180)) {
    options.solver.most_angle = *most * std::numbers::pi / 180;
    options.solver.most_length = *most * 0.01;
  }
  options.threads = common.threads;
  return options;
}

/// Numbers between blanks or commas; none if something else is among them.
std::vector<double> numbers_of(std::string text) {
  std::replace(text.begin(), text.end(), ',', ' ');
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  std::vector<double> numbers;
  double number = 0;
  while (stream >> number) numbers.push_back(number);
  return stream.eof() ? numbers : std::vector<double>();
}

std::vector<double> pose_numbers(const std::string& option, const std::string& text) {
  std::vector<double> numbers = numbers_of(text);
  if (numbers.size() < 6 || numbers.size() > 7)
    throw InputError({}, fmt::format("--{} has '{}'", option, text),
                     "six numbers, seven with a quaternion: mm and deg (URScript: m and a rotation vector in rad)");
  return numbers;
}

/// Joints in deg as rad.
std::vector<double> near_joints(const std::string& text) {
  std::vector<double> joints = numbers_of(text);
  if (joints.size() != 6) throw InputError({}, fmt::format("--near has '{}'", text), "six joints in deg");
  for (double& joint : joints) joint *= std::numbers::pi / 180;
  return joints;
}

std::map<std::string, std::vector<double>> named_poses(const po::variables_map& values, const std::string& option) {
  std::map<std::string, std::vector<double>> poses;
  if (values.count(option) == 0) return poses;
  for (const std::string& text : values[option].as<Words>()) {
    const std::size_t equal = text.find('=');
    std::string name = equal == std::string::npos ? "" : text.substr(0, equal);
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return char(std::toupper(c)); });
    poses[name] = pose_numbers(option, equal == std::string::npos ? text : text.substr(equal + 1));
  }
  return poses;
}

Eigen::Isometry3d fixed_place(const po::variables_map& values, const std::string& option) {
  const std::string text = text_of(values, option.c_str());
  if (text.empty()) return Eigen::Isometry3d::Identity();
  const std::vector<double> numbers = pose_numbers(option, text);
  if (numbers.size() != 6) throw InputError({}, fmt::format("--{} has seven numbers", option), "x y z roll pitch yaw");
  return place_of_rpy(numbers);
}

DocumentOptions document_options(const po::variables_map& values) {
  DocumentOptions options;
  options.format = text_of(values, "from");
  if (!options.format.empty() && !is_program_format(options.format))
    find_readable_format(options.format, program_format_names());
  if (const std::string name = text_of(values, "controller"); !name.empty())
    options.controller = controller_settings(name);
  if (const auto coupling = number_between(values, "coupling", -10, 10)) options.coupling = *coupling;
  options.frames.tools = named_poses(values, "tool");
  options.frames.bases = named_poses(values, "base");
  if (const std::string near = text_of(values, "near"); !near.empty()) options.near = near_joints(near);
  options.frames.X_BaseWorld = fixed_place(values, "world");
  options.frames.X_TipFlange = fixed_place(values, "flange");
  return options;
}

/// Paths of the output: one file by its name, several into a folder under their own names.
std::vector<fs::path> output_places(const po::variables_map& values, const Words& files) {
  const fs::path output = values.count("output") > 0 ? output_file(values, "output", "") : fs::path();
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

OtherValues other_values(const Compensation& result, const CompensatedList& list) {
  OtherValues values{list.configurations, list.actuators, {}};
  if (result.parallel)
    for (const AxisChange& axis : result.axes) values.actuator_names.push_back(axis.name);
  return values;
}

/// The files of poses as they are written.
std::vector<FileToWrite> pose_files(const std::vector<fs::path>& to, const Compensation& result,
                                    const std::vector<std::unique_ptr<PoseDocument>>& documents,
                                    const Problem& problem) {
  const ParametersFile stated = parameters_of(problem);
  const std::string remark = fmt::format("{}: joints to command for the robot of {} (sha256 {:.12})", compensated_mark,
                                         fs::path(stated.file).filename().string(), stated.sha256);
  std::vector<FileToWrite> files;
  for (std::size_t i = 0; i < to.size(); ++i)
    files.push_back({to[i], documents[i]->text(other_values(result, result.lists[i]), remark)});
  return files;
}

/// A folder that is not there yet, made for what is written and removed again where nothing is.
class NewFolder {
 public:
  explicit NewFolder(const fs::path& folder) : folder_(folder) {
    std::error_code code;
    if (folder_.empty() || fs::exists(folder_, code)) folder_.clear();
    else fs::create_directory(folder_, code);
  }
  ~NewFolder() {
    std::error_code code;
    if (!folder_.empty()) fs::remove(folder_, code);  // not one that has files
  }
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;

 private:
  fs::path folder_;
};

/// Output files of the robot itself, as `calibrate` writes them.
struct RobotFiles {
  fs::path urdf, xacro, kinematics;  ///< empty: not asked for
  std::optional<DhTable> table;
  std::vector<FileToWrite> files;
  std::vector<std::string> notes;

  explicit RobotFiles(const po::variables_map& values)
      : urdf(values.count("urdf") > 0 ? output_file(values, "urdf", "") : fs::path()),
        xacro(values.count("xacro") > 0 ? output_file(values, "xacro", "") : fs::path()),
        kinematics(values.count("ur-kinematics") > 0 ? output_file(values, "ur-kinematics", "") : fs::path()),
        dh_(values.count("dh") > 0 ? word_of({"--dh", {text_of(values, "dh")}}, {"distal", "proximal"}) : "") {}

  bool any() const { return !urdf.empty() || !xacro.empty() || !kinematics.empty() || !dh_.empty(); }

  void make(const Problem& problem) {
    if (!any()) return;
    const auto* arm = std::get_if<SerialArmSpec>(&problem.robot);
    if (arm == nullptr)
      throw InputError({}, "--urdf, --xacro, --ur-kinematics and --dh are for serial arms", "robot: urdf");
    const SourcePlace place = problem.at(arm->line);
    const VariantSpec& variant = find_variant(problem, problem.parameters->variant.value);
    const std::vector<CalibratedValue> values = calibrated_values(problem, variant, *make_model(problem, variant), {});
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
    if (!dh_.empty())
      table = dh_table(*arm, place, variant.convention, values,
                       dh_ == "distal" ? DhConvention::distal : DhConvention::proximal);
  }

 private:
  void add(const fs::path& file, const std::string& text, const char* what, const std::vector<std::string>& left_out) {
    files.push_back({file, text});
    for (const std::string& left : left_out) notes.push_back(std::string("not in the ") + what + ": " + left);
  }

  std::string dh_;
};

/// Poses read, solved, and the files that they make.
Compensation compensate_files(const Words& files, const Problem& problem, DocumentOptions reading,
                              const CompensateOptions& options, const CommonOptions& common,
                              std::vector<std::unique_ptr<PoseDocument>>& documents) {
  Compensation none;
  none.variant = problem.parameters->variant.value;
  if (files.empty()) return none;
  const std::vector<Coordinate> coordinates = compensation_coordinates(problem);
  reading.threads = options.threads;
  try {
    reading.inverse = nominal_inverse(problem);
  } catch (const CannotDo& error) {
    reading.why_no_inverse = error.what();
  }
  std::vector<PoseList> lists;
  std::vector<std::string> notes;
  documents = read_documents({files.begin(), files.end()}, coordinates, reading);
  for (const auto& document : documents) {
    lists.push_back(document->poses());
    notes.insert(notes.end(), document->notes().begin(), document->notes().end());
  }
  Compensation result = watched(common, 0, [&](const Monitor& monitor) {
                          return compensate_problem(problem, lists, options, monitor);
                        }).result;
  result.notes.insert(result.notes.begin(), notes.begin(), notes.end());
  for (std::size_t i = 0; i < documents.size(); ++i)
    if (const ProgramAccount* account = documents[i]->account()) result.add_account(*account, result.lists[i]);
  result.settle_motions();
  check_lines(problem, options, result);
  return result;
}

/// True if all lines stay within --line-deviation; notes name the others.
bool keep_lines(Compensation& result, double allowed) {
  bool kept = true;
  for (const LineDeviation& line : result.lines) {
    if (line.largest <= allowed) continue;
    kept = false;
    result.notes.push_back(
        fmt::format("{}:{}: the tool would leave the line by {:.4f} mm; --line-deviation allows {:.4f}", line.file,
                    line.line, line.largest * 1e3, allowed * 1e3));
  }
  return kept;
}

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
  const CompensateOptions options = compensation_options(values, common);
  const DocumentOptions reading = document_options(values);
  RobotFiles robot(values);
  if (files.empty() && !robot.any())
    throw InputError({}, "FILE is missing", "poses to compensate, --urdf, --xacro, --ur-kinematics or --dh");
  const std::vector<fs::path> to = output_places(values, files);
  const Problem problem = calibrated_problem(values, parameters);

  std::vector<fs::path> outputs = to, inputs = files_of(problem);
  outputs.insert(outputs.end(), {robot.urdf, robot.xacro, robot.kinematics});
  inputs.insert(inputs.end(), files.begin(), files.end());
  const NewFolder folder(!to.empty() && to.front() != fs::path(text_of(values, "output")) ? to.front().parent_path()
                                                                                          : fs::path());
  check_output_files(values, outputs, inputs);
  robot.make(problem);

  std::vector<std::unique_ptr<PoseDocument>> documents;
  Compensation result = compensate_files(files, problem, reading, options, common, documents);
  result.notes.insert(result.notes.end(), robot.notes.begin(), robot.notes.end());
  const auto allowed = number_between(values, "line-deviation", 0, 1000);
  const bool straight = !allowed || keep_lines(result, *allowed * 1e-3);
  const bool good = straight && (result.is_whole() || values.count("partial") > 0);
  std::vector<fs::path> written;
  if (good) {
    std::vector<FileToWrite> all = robot.files;
    for (FileToWrite& file : pose_files(to, result, documents, problem)) all.push_back(std::move(file));
    write_results(all);
    for (const FileToWrite& file : all) written.push_back(file.file);
  } else if (!to.empty() || !robot.files.empty()) {
    result.notes.emplace_back("no file is written; --partial keeps uncompensated poses unchanged");
  }
  show_compensation(common, problem, result, robot, written);
  return good ? done : cannot_do;
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
