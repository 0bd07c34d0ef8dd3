#include <fmt/format.h>
#include <unistd.h>

#include <numbers>
#include <system_error>

#include "command.hpp"
#include "live_page.hpp"
#include "posewright/options/tables.hpp"
#include "posewright/support/json.hpp"
#include "posewright/support/table.hpp"
#include "problem_source.hpp"
#include "questions.hpp"
#include "result_files.hpp"
#include "session.hpp"
#include "terminal.hpp"
#include "write_result.hpp"

namespace posewright::cli {
namespace {

namespace fs = std::filesystem;

po::options_description init_command_options() { return described(init_options()).add(package_options()); }

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

InitCall given_call(const po::variables_map& values, const Words& positional) {
  InitCall call;
  if (values.count("samples") == 0) call.facts.robot = single(positional, "ROBOT");
  else if (!positional.empty()) throw InputError({}, "ROBOT and --samples", "one of them");
  call.facts.packages = packages_of(values);
  read_options(init_options(), values, call);
  call.facts.schema =
      installed_file({"share/posewright/schemas/problem.schema.json", "schemas/problem.schema.json"}).string();
  return call;
}

void ask_instrument(InitFacts& facts) {
  ask("Instrument: tracker, or a camera (a name of --camera list, WIDTHxHEIGHT@FOCAL)", "tracker",
      [&](const std::string& answer) {
        facts.camera = answer != "tracker";
        if (facts.camera) facts.lens = find_camera(answer);
      });
}

/// Asks for missing facts that only the user knows.
void ask_for_the_rest(InitCall& call) {
  InitFacts& facts = call.facts;
  if (!call.names_instrument()) ask_instrument(facts);
  if (facts.camera && !call.board_given)
    ask("Board: rows x columns x spacing of its points", "6x9x25mm",
        [&](const std::string& answer) { facts.board = parse_board(answer); });
  if (facts.camera && facts.on_hand)
    ask("Camera on the hand, or fixed in the cell", "hand", [&](const std::string& answer) {
      if (answer != "hand" && answer != "fixed") throw InputError({}, "'" + answer + "'", "hand or fixed");
      facts.on_hand = answer == "hand";
    });
  const std::string what = !facts.camera ? "tracker" : facts.on_hand ? "board" : "camera";
  if (!facts.place)
    ask("Where the " + what + " stands, X,Y,Z in the base frame", "in front", [&](const std::string& answer) {
      if (answer != "in front") facts.place = place_of({"place", {answer}});
    });
  if (!facts.accuracy && !facts.poses) {
    ask("Required accuracy, with unit", "none", [&](const std::string& answer) {
      if (answer != "none") facts.accuracy = size_of({"accuracy", {answer}}, {Quantity::length}, true).value;
    });
    const std::string standard = facts.accuracy ? "as many as it takes" : facts.camera && !facts.arm ? "15" : "30";
    ask("Number of poses", standard, [&](const std::string& answer) {
      if (answer == standard) return;
      facts.poses = whole_of({"poses", {answer}}, least_init_poses, most_init_poses);
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

/// The file that the problem is made from.
const fs::path& source_of(const InitFacts& facts) { return facts.samples.empty() ? facts.robot : facts.samples; }

/// Files that the problem was made from, under the names that it has for them.
std::vector<FileToWrite> files_for_page(const fs::path& source, const InitResult& result) {
  std::vector<FileToWrite> files;
  std::error_code code;
  for (const fs::path& file : files_read())
    files.push_back({fs::equivalent(file, source, code) ? source : file, read_file(file)});
  if (!result.expanded.file.empty()) files.push_back(result.expanded);
  return files;
}

void print_page(const fs::path& page, bool opened) {
  if (opened) fmt::print("{} is opened in the browser.\n", page.string());
  else fmt::print("No browser can be started here. Open this page in one: {}\n", fs::absolute(page).string());
}

void print_summary(const InitFacts& facts, const InitResult& result, const fs::path& file,
                   const po::variables_map& values) {
  if (!facts.samples.empty()) {
    fmt::print("{}: hand-eye calibration\nCheck the file, then run: posewright calibrate {} {}\n", file.string(),
               file.string(), facts.samples.string());
    return;
  }
  fmt::print("{}: {} joints from {} to {}, {}\n", file.string(), result.joints, result.base,
             fmt::join(result.tips, ", "),
             !facts.camera   ? std::string("laser tracker")
             : facts.on_hand ? facts.lens.name + " on the hand"
                             : facts.lens.name + " fixed");
  fmt::print("Check the file, then run: posewright plan {}{}\n", file.string(), words_again(values));
}

int run_init(const po::variables_map& values, const Words& positional) {
  const CommonOptions common = common_values(values);
  if (text_of(values, "camera") == "list") {
    print_cameras(common.json);
    return done;
  }
  InitCall call = given_call(values, positional);
  InitFacts& facts = call.facts;
  facts.files_beside = text_of(values, "output") != "-";
  const std::string output = values.count("output") > 0 ? text_of(values, "output") : "problem.yaml";
  if (output.empty()) throw InputError({}, "-o names no file", "a file, or - for stdout");
  const bool to_stdout = output == "-";
  const bool show = values.count("show") > 0;
  if (show && to_stdout) throw InputError({}, "--show and -o -", "--show needs a problem file: -o FILE");
  if (show) require_live_page();
  if (to_stdout && common.json) throw InputError({}, "--json and -o - both need stdout", "give -o a file");
  if (!to_stdout) {
    require_new(output, "", values.count("force") > 0);
    check_outputs({output}, {source_of(facts)}, true);
  }
  if (can_ask() && facts.samples.empty() && values.count("yes") == 0 && !common.json) ask_for_the_rest(call);
  else if (!call.names_instrument())
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
  const fs::path page = show ? fs::path(output).replace_extension(".html") : fs::path();
  if (show) {
    files.push_back({page, page_with_problem({output, result.text}, files_for_page(source_of(facts), result))});
    require_new(page, files.back().bytes, values.count("force") > 0);
    check_outputs({output, page}, {source_of(facts)}, true);
  }
  files.push_back({output, result.text});
  write_results(files);
  const bool opened = show && open_in_browser(page);
  if (common.json) {
    nlohmann::ordered_json json = {
        {"schema", "posewright/init/1"},
        {"problem", output},
        {facts.samples.empty() ? "urdf" : "samples",
         result.expanded.file.empty() ? source_of(facts).string() : result.expanded.file.string()},
        {"base", result.base},
        {"joints", result.joints},
        {"notes", result.notes}};
    if (result.tips.size() == 1) json["tip"] = result.tips.front();
    else if (!result.tips.empty()) json["tips"] = result.tips;
    if (show) json["page"] = page.string();
    fmt::print("{}", json_text(json));
    return done;
  }
  print_summary(facts, result, output, values);
  if (show) print_page(page, opened);
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
