#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <iostream>
#include <numbers>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "command.hpp"
#include "posewright/options/tables.hpp"
#include "posewright/support/base64.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/file.hpp"
#include "posewright/support/json.hpp"
#include "posewright/support/run_program.hpp"
#include "posewright/support/table.hpp"
#include "posewright/support/text.hpp"
#include "problem_source.hpp"
#include "session.hpp"
#include "terminal.hpp"
#include "write_result.hpp"

namespace posewright::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view problem_slot = "@GIVEN_PROJECT@";

void replace_all(std::string& text, const std::string& old, const std::string& with) {
  for (std::size_t at = text.find(old); at != std::string::npos; at = text.find(old, at + with.size()))
    text.replace(at, old.size(), with);
}

fs::path plain(const fs::path& file) { return fs::absolute(file).lexically_normal(); }

/// A file of the installation that this program belongs to, else of the folder it was built in; empty if neither has
/// it.
/// @param places  paths from a folder above the program, the first that is there is taken
fs::path installed_file(const std::vector<std::string>& places) {
  std::error_code code;
  const fs::path program = fs::read_symlink("/proc/self/exe", code);
  for (fs::path folder = program.parent_path(); folder.has_relative_path(); folder = folder.parent_path())
    for (const std::string& place : places)
      if (fs::path file = folder / place; fs::is_regular_file(file, code)) return file;
  return {};
}

fs::path live_page() { return installed_file({"share/posewright/posewright.html", "wasm-package/posewright.html"}); }

/// Throws CannotDo if posewright.html is not in this installation.
void require_live_page() {
  if (live_page().empty())
    throw CannotDo("the page that plans (posewright.html) is not in this installation; see docs/live.md");
}

/// posewright.html with a problem in it, as bytes.
/// @param problem  its folder is the root of the page's files; names of files elsewhere are changed in the page's copy
/// @param files    that the problem names; the page itself puts meshes where the URDF names them
/// Throws CannotDo if posewright.html is not in this installation.
std::string page_with_problem(const FileToWrite& problem, const std::vector<FileToWrite>& files) {
  require_live_page();
  const fs::path folder = plain(problem.file).parent_path();
  std::string text = problem.bytes;
  nlohmann::ordered_json contents = nlohmann::ordered_json::object();
  for (const FileToWrite& file : files) {
    const fs::path absolute = plain(file.file), relative = absolute.lexically_relative(folder);
    const bool inside = !relative.empty() && *relative.begin() != "..";
    const std::string name = (inside ? relative : absolute.relative_path()).generic_string();
    contents[name] = base64(file.bytes);
    replace_all(text, absolute.generic_string(), name);
    if (!inside) replace_all(text, relative.generic_string(), name);
  }
  const std::string name = problem.file.filename().generic_string();
  contents[name] = base64(text);
  std::string data = json_text(nlohmann::ordered_json{{"problem", name}, {"files", contents}}, JsonLayout::one_line);
  replace_all(data, "<", "\\u003c");  // no byte of the data may end the element that holds them
  std::string page = read_file(live_page());
  const std::size_t slot = page.find(problem_slot);
  if (slot == std::string::npos) throw CannotDo(live_page().string() + " has no place for a problem: another version");
  return page.replace(slot, problem_slot.size(), data);
}

/// Shows a page in the user's browser without waiting for it; false where none can be started.
bool open_in_browser(const fs::path& page) {
  // The shell lets the browser run on. Without a screen xdg-open would start one of the terminal.
  const auto started = run_program(
      {"sh", "-c",
       "[ -n \"$DISPLAY$WAYLAND_DISPLAY$BROWSER\" ] || [ \"$(uname)\" = Darwin ] || exit 1\n"
       "for opener in xdg-open open; do command -v $opener >/dev/null && { $opener \"$1\" >/dev/null 2>&1 & exit 0; }; "
       "done\nexit 1",
       "sh", fs::absolute(page).string()});
  return started && started->status == 0;
}

/// True if stdin and stderr are terminals, so that questions make sense.
bool can_ask() { return ::isatty(STDIN_FILENO) != 0 && ::isatty(STDERR_FILENO) != 0; }

/// Asks on stderr until `take` accepts the answer, which is `standard` where nothing but Enter is typed. What `take`
/// throws as InputError is shown before the next try. Throws InputError where the input ends.
void ask(const std::string& question, const std::string& standard,
         const std::function<void(const std::string&)>& take) {
  while (true) {
    print_aside(fmt::format("{} [{}]: ", question, standard));
    std::string line;
    if (!std::getline(std::cin, line)) throw InputError({}, "no answer to '" + question + "'", "the input ended");
    const std::string answer(trimmed_blanks(line));
    try {
      take(answer.empty() ? standard : answer);
      return;
    } catch (const InputError& error) {
      print_error(error.what());
    }
  }
}

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
  Table table({"camera", "image", "focal length", "view", "source"}, "lrrrl");
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
