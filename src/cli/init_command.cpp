#include <fmt/format.h>
#include <unistd.h>

#include <charconv>
#include <numbers>
#include <system_error>

#include "command.hpp"
#include "posewright/outputs/table.hpp"
#include "posewright/problem/units.hpp"
#include "posewright/support/json.hpp"
#include "posewright/tasks/init_problem.hpp"
#include "problem_source.hpp"
#include "questions.hpp"
#include "result_files.hpp"
#include "session.hpp"
#include "terminal.hpp"
#include "write_result.hpp"

namespace posewright::cli {
namespace {

namespace fs = std::filesystem;

po::options_description init_command_options() {
  po::options_description options("Options");
  options.add_options()                                                                                               //
      ("tracker", "laser tracker, with three reflectors on the flange")                                               //
      ("camera", text("NAME"), "camera and board: a name, WIDTHxHEIGHT@FOCAL in px, or list for the table of names")  //
      ("board", text("RxCxS"), "rows, columns, spacing of its points (6x9x25mm)")                                     //
      ("fixed-camera", "camera fixed in the cell, board on the hand")                                                 //
      ("arm", "identify the arm's parameters too, not only the pose of the camera")                                   //
      ("at", text("X,Y,Z"), "position of tracker, board or fixed camera in the base frame (in front)")                //
      ("poses", text("N"), "number of poses (30; hand-eye calibration: 15)")                                          //
      ("accuracy", text("LENGTH"), "required accuracy, with unit; without --poses it sets their number")              //
      ("base", text("LINK"), "first link of the chain (parent of the first joint)")                                   //
      ("tip", text("LINK"), "last link of the chain (tool0, flange or the last one)")                                 //
      ("floor", text("HEIGHT"),
       "height of floor or table in the base frame, with unit, or none (under the robot's foot)")        //
      ("xacro", po::value<Words>()->value_name("NAME=VALUE")->composing(), "argument of a .xacro file")  //
      ("output,o", text("FILE"), "problem file (problem.yaml; - for stdout)")                            //
      ("force", "replace an existing file")                                                              //
      ("yes", "ask no questions, even on a terminal");
  options.add(package_options());
  return options;
}

void print_cameras(bool json) {
  if (json) {
    nlohmann::ordered_json list = {{"schema", "posewright/cameras/1"}, {"cameras", nlohmann::ordered_json::array()}};
    for (const KnownCamera& camera : known_cameras())
      list["cameras"].push_back({{"name", camera.name},
                                 {"width", camera.width},
                                 {"height", camera.height},
                                 {"focal", camera.focal},
                                 {"horizontal_view", camera.horizontal_view()},
                                 {"vertical_view", camera.vertical_view()},
                                 {"source", camera.source}});
    fmt::print("{}", json_text(list));
    return;
  }
  using A = Table::Align;
  Table table({"camera", "image", "focal length", "view", "source"}, {A::left, A::right, A::right, A::right, A::left});
  constexpr double degrees = 180 / std::numbers::pi;
  for (const KnownCamera& camera : known_cameras())
    table.row({camera.name, fmt::format("{} x {}", camera.width, camera.height), fmt::format("{} px", camera.focal),
               fmt::format("{:.1f} x {:.1f} deg", camera.horizontal_view() * degrees, camera.vertical_view() * degrees),
               camera.source});
  fmt::print("{}", table.text());
}

double length_of(const std::string& text, const std::string& what) {
  const Measured value = parse_measured(text, {Quantity::length});
  if (value.quantity == Quantity::number && value.value != 0)
    throw InputError({}, what + " " + text + " has no unit", "0.1mm, for example");
  return value.value;
}

double accuracy_of(const std::string& text) {
  const double accuracy = length_of(text, "accuracy");
  if (!(accuracy > 0)) throw InputError({}, "accuracy " + text, "a length > 0 with its unit, 0.1mm");
  return accuracy;
}

/// Three lengths with commas between; metres where no unit is written.
Eigen::Vector3d place_of(const std::string& text) {
  Eigen::Vector3d place;
  std::size_t begin = 0;
  for (int k = 0; k < 3; ++k) {
    const std::size_t end = k < 2 ? text.find(',', begin) : text.size();
    if (end == std::string::npos || (k == 2 && text.find(',', begin) != std::string::npos))
      throw InputError({}, "place " + text, "three lengths X,Y,Z, in m where no unit is written");
    place[k] = parse_measured(text.substr(begin, end - begin), {Quantity::length}).value;
    begin = end + 1;
  }
  return place;
}

std::vector<std::pair<std::string, std::string>> xacro_arguments(const po::variables_map& values) {
  std::vector<std::pair<std::string, std::string>> arguments;
  if (values.count("xacro") == 0) return arguments;
  for (const std::string& text : values["xacro"].as<Words>()) {
    const std::size_t equal = text.find('=');
    if (equal == std::string::npos || equal == 0) throw InputError({}, "--xacro " + text, "NAME=VALUE is expected");
    arguments.emplace_back(text.substr(0, equal), text.substr(equal + 1));
  }
  return arguments;
}

/// The schema of the installation that this program belongs to, else of its sources; empty if it is in neither.
std::string schema_file() {
  std::error_code code;
  const fs::path program = fs::read_symlink("/proc/self/exe", code);
  for (fs::path folder = program.parent_path(); folder.has_relative_path(); folder = folder.parent_path())
    for (const char* place : {"share/posewright/schemas", "schemas"})
      if (const fs::path file = folder / place / "problem.schema.json"; fs::is_regular_file(file, code))
        return file.string();
  return {};
}

void take_instrument(InitFacts& facts, const po::variables_map& values) {
  const bool tracker = values.count("tracker") > 0, camera = values.count("camera") > 0;
  if (tracker && camera) throw InputError({}, "--tracker and --camera", "one instrument is allowed");
  facts.camera = camera;
  for (const char* option : {"board", "fixed-camera", "arm"})
    if (tracker && values.count(option) > 0)
      throw InputError({}, fmt::format("--{} does not go with --tracker", option), "it belongs to --camera");
  if (camera) facts.lens = find_camera(text_of(values, "camera"));
  if (values.count("board") > 0) facts.board = parse_board(text_of(values, "board"));
  facts.on_hand = values.count("fixed-camera") == 0;
  facts.arm = values.count("arm") > 0;
}

InitFacts given_facts(const po::variables_map& values, const Words& positional) {
  InitFacts facts;
  facts.robot = single(positional, "ROBOT");
  facts.xacro = xacro_arguments(values);
  facts.packages = packages_of(values);
  facts.base = text_of(values, "base");
  facts.tip = text_of(values, "tip");
  take_instrument(facts, values);
  if (values.count("at") > 0) facts.place = place_of(text_of(values, "at"));
  if (const std::string floor = text_of(values, "floor"); floor == "none") facts.no_floor = true;
  else if (!floor.empty()) facts.floor = length_of(floor, "floor");
  facts.poses = whole_number(values, "poses", 2, 10000);
  if (values.count("accuracy") > 0) facts.accuracy = accuracy_of(text_of(values, "accuracy"));
  facts.schema = schema_file();
  return facts;
}

void ask_instrument(InitFacts& facts) {
  ask("Instrument: tracker, or a camera (a name of --camera list, WIDTHxHEIGHT@FOCAL)", "tracker",
      [&](const std::string& answer) {
        facts.camera = answer != "tracker";
        if (facts.camera) facts.lens = find_camera(answer);
      });
}

/// Asks for missing facts that only the user knows.
void ask_for_the_rest(InitFacts& facts, const po::variables_map& values) {
  if (values.count("tracker") + values.count("camera") == 0) ask_instrument(facts);
  if (facts.camera && values.count("board") == 0)
    ask("Board: rows x columns x spacing of its points", "6x9x25mm",
        [&](const std::string& answer) { facts.board = parse_board(answer); });
  if (facts.camera && values.count("fixed-camera") == 0)
    ask("Camera on the hand, or fixed in the cell", "hand", [&](const std::string& answer) {
      if (answer != "hand" && answer != "fixed") throw InputError({}, "'" + answer + "'", "hand or fixed");
      facts.on_hand = answer == "hand";
    });
  const std::string what = !facts.camera ? "tracker" : facts.on_hand ? "board" : "camera";
  if (!facts.place)
    ask("Where the " + what + " stands, X,Y,Z in the base frame", "in front", [&](const std::string& answer) {
      if (answer != "in front") facts.place = place_of(answer);
    });
  if (!facts.accuracy && !facts.poses) {
    ask("Required accuracy, with unit", "none", [&](const std::string& answer) {
      if (answer != "none") facts.accuracy = accuracy_of(answer);
    });
    const std::string standard = facts.accuracy ? "as many as it takes" : facts.camera && !facts.arm ? "15" : "30";
    ask("Number of poses", standard, [&](const std::string& answer) {
      if (answer == standard) return;
      int number = 0;
      const auto [end, code] = std::from_chars(answer.data(), answer.data() + answer.size(), number);
      if (code != std::errc() || end != answer.data() + answer.size() || number < 2 || number > 10000)
        throw InputError({}, "'" + answer + "'", "a whole number from 2 to 10000");
      facts.poses = number;
    });
  }
}

std::string words_again(const po::variables_map& values) {
  std::string words;
  if (values.count("package") > 0)
    for (const std::string& package : values["package"].as<Words>()) words += " --package " + package;
  return words;
}

void require_new(const fs::path& file, const std::string& text, bool force) {
  std::error_code code;
  if (!force && fs::exists(file, code) && fs::is_regular_file(file, code) && fs::file_size(file, code) > 0 &&
      !holds(file, text))
    throw CannotDo(file.string() + " exists; --force replaces it");
}

void print_summary(const InitFacts& facts, const InitResult& result, const fs::path& file,
                   const po::variables_map& values) {
  fmt::print("{}: {} joints from {} to {}, {}\n", file.string(), result.joints, result.base, result.tip,
             !facts.camera   ? std::string("laser tracker")
             : facts.on_hand ? facts.lens.name + " on the hand"
                             : facts.lens.name + " fixed in the cell");
  fmt::print("Check the file, then run: posewright plan {}{}\n", file.string(), words_again(values));
}

int run_init(const po::variables_map& values, const Words& positional) {
  const CommonOptions common = common_values(values);
  if (text_of(values, "camera") == "list") {
    print_cameras(common.json);
    return done;
  }
  InitFacts facts = given_facts(values, positional);
  facts.files_beside = text_of(values, "output") != "-";
  const std::string output = values.count("output") > 0 ? text_of(values, "output") : "problem.yaml";
  if (output.empty()) throw InputError({}, "-o names no file", "a file, or - for stdout");
  const bool to_stdout = output == "-";
  if (to_stdout && common.json) throw InputError({}, "--json and -o - both need stdout", "give -o a file");
  if (!to_stdout) {
    require_new(output, "", values.count("force") > 0);
    check_outputs({output}, {facts.robot}, true);
  }
  if (can_ask() && values.count("yes") == 0 && !common.json) ask_for_the_rest(facts, values);
  else if (values.count("tracker") + values.count("camera") == 0)
    throw InputError({}, "no instrument is named", "--tracker or --camera NAME (--camera list: the table)");
  const auto [result, was_interrupted] = watched(common, 0, [&](const Monitor& monitor) {
    return init_problem(facts, to_stdout ? fs::path("problem.yaml") : fs::path(output), monitor);
  });
  if (was_interrupted) return interrupted;
  print_notes(result.notes);
  if (to_stdout) {
    fmt::print("{}", result.text);
    return done;
  }
  std::vector<FileToWrite> files;
  if (!result.expanded.file.empty()) {
    require_new(result.expanded.file, result.expanded.bytes, values.count("force") > 0);
    check_outputs({output, result.expanded.file}, {facts.robot}, true);
    files.push_back(result.expanded);
  }
  files.push_back({output, result.text});
  write_results(files);
  if (common.json)
    fmt::print("{}", json_text(nlohmann::ordered_json{
                         {"schema", "posewright/init/1"},
                         {"problem", output},
                         {"urdf", result.expanded.file.empty() ? facts.robot.string() : result.expanded.file.string()},
                         {"base", result.base},
                         {"tip", result.tip},
                         {"joints", result.joints},
                         {"notes", result.notes}}));
  else print_summary(facts, result, output, values);
  return done;
}

}  // namespace

Command init_command() {
  return {"init",
          "ROBOT",
          "Writes a commented problem file for a URDF or xacro that plans at once.",
          init_command_options,
          "posewright init robot.urdf --camera realsense-d435 --board 6x9x25mm",
          run_init};
}

}  // namespace posewright::cli
