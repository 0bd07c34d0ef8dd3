#include "posewright/report/report_result.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include "posewright/lists/parameters_file.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/json.hpp"
#include "posewright/support/text_file.hpp"

namespace posewright {
namespace {

constexpr const char* plan_schema = "posewright/plan/1";
constexpr const char* allowed = "plan.json, or the --json output of calibrate, compare, next, simulate or stations";

/// A result with a page: its schema, the command that writes it, and what its page cannot do without.
struct Kind {
  std::string_view schema, command;
  std::vector<const char*> keys;
};

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all = {
      {"posewright/calibration/1",
       "calibrate",
       {"problem", "data", "variant", "parameters", "residuals", "axes", "before", "poses", "readings", "tests",
        "histogram", "left_out", "effects_left_out", "smooth_effect"}},
      {"posewright/calibrations/1", "calibrate", {"problem", "data", "choice", "models"}},
      {"posewright/comparison/1", "compare", {"problem", "variants", "plans", "scores", "aliases", "worth"}},
      {"posewright/simulation/1",
       "simulate",
       {"problem", "variant", "truth", "plan", "draws", "options", "parameters", "histogram", "chi_square", "verdict"}},
      {"posewright/next/1",
       "next",
       {"problem", "variant", "verdict", "stop", "reason", "measured", "parameters", "places", "required", "confidence",
        "curve", "ahead", "poses", "candidates"}},
      {"posewright/stations/1", "stations", {"problem", "base", "obstacles", "ranking"}}};
  return all;
}

/// Advice for results without a page.
constexpr std::array<std::pair<std::string_view, const char*>, 3> others = {
    {{"posewright/route/1", "a route is shown with its plan: posewright report PLAN --route FILE"},
     {"posewright/report/1", "these are already the numbers of a page"},
     {"posewright/compensation/1", "it has no page; use its poses and programs"}}};

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& what, const std::string& instead) {
  throw InputError({file.string(), 0}, what, instead);
}

nlohmann::json read_result(const std::filesystem::path& file, std::string& text) {
  text = read_text(file, plan_size_limit);
  if (text.starts_with("posewright_parameters:") || text.find("\nposewright_parameters:") != std::string::npos)
    refuse(file, "is a parameters file, which holds no residuals",
           "posewright calibrate … --json prints the result that has a page");
  try {
    nlohmann::json json = parse_json(text);
    if (json.is_object() && json.contains("schema") && json["schema"].is_string()) return json;
  } catch (const nlohmann::json::out_of_range&) {
    refuse(file, "has a number that is too large", allowed);
  } catch (const nlohmann::json::exception&) {
    refuse(file, "is no JSON", allowed);
  }
  refuse(file, "is not a result of posewright", allowed);
}

const Kind& kind_of(const std::filesystem::path& file, const std::string& schema) {
  for (const Kind& kind : kinds())
    if (kind.schema == schema) return kind;
  for (const auto& [other, instead] : others)
    if (other == schema) refuse(file, "is of schema " + schema, instead);
  refuse(file, "is of schema " + schema + ", which has no page", allowed);
}

}  // namespace

bool is_plan(const std::filesystem::path& file) {
  std::string text;
  const std::string schema = read_result(file, text).at("schema");
  if (schema == plan_schema) return true;
  kind_of(file, schema);
  return false;
}

ResultReport report_result(const std::filesystem::path& file) {
  ResultReport report;
  const nlohmann::json json = read_result(file, report.result_json);
  const Kind& kind = kind_of(file, json.at("schema"));
  for (const char* key : kind.keys)
    if (!json.contains(key))
      refuse(file, std::string("has no ") + key,
             "the output of posewright " + std::string(kind.command) + " --json of this version");
  const nlohmann::json& problem = json["problem"];
  if (!problem.is_object() || !problem.contains("file") || !problem["file"].is_string())
    refuse(file, "names no problem file", "problem: {file: …}");
  report.title = title_of(problem["file"].get<std::string>());
  report.file = file.string();
  report.ended = json.contains("stop") && json["stop"].is_boolean() && json["stop"].get<bool>();
  return report;
}

std::string title_of(const std::filesystem::path& problem) {
  std::string title = problem.stem().string();
  if (const std::string folder = problem.parent_path().filename().string(); title == "problem" && !folder.empty())
    title = folder;
  return title;
}

}  // namespace posewright
