#include "posewright/tasks/next_state.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "posewright/lists/parameters_file.hpp"
#include "posewright/model/variant_columns.hpp"
#include "posewright/study/variant.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/file.hpp"
#include "posewright/support/json.hpp"
#include "posewright/support/sha256.hpp"
#include "posewright/version.hpp"

namespace posewright {
namespace {

using StateJson = nlohmann::ordered_json;

constexpr const char* schema = "posewright/next-state/1";
constexpr std::uintmax_t largest_state = 1'000'000'000;

[[noreturn]] void refuse_damaged(const std::filesystem::path& file, const std::string& how) {
  throw InputError({file.string(), 0}, "is damaged: " + how,
                   "a state that posewright next wrote (--restart begins a new one)");
}

StateJson or_null(const std::optional<double>& value) { return value ? StateJson(*value) : StateJson(nullptr); }

StateJson candidates_json(const NextState& state) {
  if (state.kept == nullptr) return nullptr;
  const Configurations& all = state.kept->configurations;
  StateJson rejected = StateJson::array();
  for (const auto& [reason, count] : all.rejected) rejected.push_back({reason, count});
  return {{"variant", state.variant},   {"seed", state.seed},
          {"asked", state.kept->asked}, {"calibrated", state.kept->calibrated},
          {"drawn", all.drawn},         {"rejected", rejected},
          {"dimension", all.dimension}, {"values", all.values}};
}

std::shared_ptr<const KeptCandidates> candidates_of(const nlohmann::json& json) {
  auto kept = std::make_shared<KeptCandidates>();
  json.at("asked").get_to(kept->asked);
  json.at("calibrated").get_to(kept->calibrated);
  json.at("drawn").get_to(kept->configurations.drawn);
  json.at("dimension").get_to(kept->configurations.dimension);
  json.at("values").get_to(kept->configurations.values);
  for (const nlohmann::json& entry : json.at("rejected"))
    kept->configurations.rejected.emplace_back(entry.at(0).get<std::string>(), entry.at(1).get<long>());
  const int dimension = kept->configurations.dimension;
  const std::size_t numbers = kept->configurations.values.size();
  if (dimension < 1 || numbers == 0 || numbers % std::size_t(dimension) != 0) return nullptr;
  return kept;
}

NextState state_of(const nlohmann::json& json) {
  NextState state;
  json.at("/problem/file"_json_pointer).get_to(state.problem_file);
  json.at("/problem/sha256"_json_pointer).get_to(state.problem_sha256);
  json.at("/problem/parameters_sha256"_json_pointer).get_to(state.parameters_sha256);
  json.at("/data/file"_json_pointer).get_to(state.data_file);
  json.at("/data/bytes"_json_pointer).get_to(state.data_bytes);
  json.at("/data/sha256"_json_pointer).get_to(state.data_sha256);
  for (const nlohmann::json& entry : json.at("history")) {
    NextPoint point;
    entry.at("poses").get_to(point.poses);
    if (!entry.at("expected").is_null()) point.expected = entry.at("expected").get<double>();
    if (!entry.at("upper").is_null()) point.upper = entry.at("upper").get<double>();
    state.history.push_back(point);
  }
  json.at("/proposed/names"_json_pointer).get_to(state.names);
  json.at("/proposed/configurations"_json_pointer).get_to(state.proposed);
  for (const nlohmann::json& entry : json.at("files"))
    state.files.push_back({entry.at("path").get<std::string>(), entry.at("sha256").get<std::string>()});
  const nlohmann::json& candidates = json.at("candidates");
  if (candidates.is_null()) return state;
  candidates.at("variant").get_to(state.variant);
  candidates.at("seed").get_to(state.seed);
  state.kept = candidates_of(candidates);
  return state;
}

}  // namespace

std::optional<NextState> read_next_state(const std::filesystem::path& file) {
  std::error_code code;
  if (!std::filesystem::exists(file, code)) return std::nullopt;
  const std::string text = read_file_to_replace(file, largest_state);
  try {
    const nlohmann::json json = parse_json(text);
    if (!json.is_object() || json.value("schema", "") != schema)
      throw InputError({file.string(), 0}, "is no state of posewright next", "another file for --state");
    NextState state = state_of(json);
    if (state.kept == nullptr && !json.at("candidates").is_null()) refuse_damaged(file, "its candidates are no table");
    return state;
  } catch (const nlohmann::json::exception& error) {
    refuse_damaged(file, error.what());
  }
}

void require_continues(const NextState& state, const std::filesystem::path& file, const Problem& problem,
                       const std::filesystem::path& data, const std::string& text) {
  const std::string restart = "; --restart begins anew, --state names another file";
  if (state.problem_sha256 != problem.sha256)
    throw InputError({file.string(), 0},
                     state.problem_file == problem.file.string()
                         ? "was written before " + state.problem_file + " changed"
                         : "belongs to another problem, " + state.problem_file,
                     "the state of " + problem.file.string() + " as it is now" + restart);
  if (state.parameters_sha256 != parameters_of(problem).sha256)
    throw InputError({file.string(), 0}, "was written with other --parameters", "the same" + restart);
  if (state.data_bytes == 0) return;
  if (text.size() < state.data_bytes)
    throw InputError({data.string(), 0},
                     fmt::format("has {} bytes of whole lines where {} were seen before: it was replaced or cut",
                                 text.size(), state.data_bytes),
                     "a file that grows at its end" + restart);
  if (sha256_hex(std::string_view(text).substr(0, state.data_bytes)) != state.data_sha256)
    throw InputError(
        {data.string(), 0},
        fmt::format("differs from the file of {}: its first {} bytes have changed", file.string(), state.data_bytes),
        "a file that grows at its end" + restart);
}

void reuse(const NextState& state, const Problem& problem, NextOptions& options) {
  if (state.kept == nullptr || state.seed != options.seed) return;
  if (state.variant != find_variant(problem, options.variant).name) return;
  const std::size_t dimension = pose_coordinates(problem, options.variant).size();
  if (std::size_t(state.kept->configurations.dimension) == dimension) options.kept = state.kept;
}

NextState state_after(const Problem& problem, const NextOptions& options, const NextPoses& result,
                      const std::optional<NextState>& before) {
  NextState state;
  if (before) state.history = before->history;
  if (before) state.files = before->files;
  state.problem_file = problem.file.string();
  state.problem_sha256 = problem.sha256;
  state.parameters_sha256 = parameters_of(problem).sha256;
  state.data_file = options.data.string();
  const std::string text = options.text.value_or("");
  state.data_bytes = text.size();
  state.data_sha256 = sha256_hex(text);
  while (!state.history.empty() && state.history.back().poses >= result.measured) state.history.pop_back();
  NextPoint now{result.measured};
  if (!result.curve.empty()) now = result.curve.back();
  state.history.push_back(now);
  for (const PlannedPose& pose : result.poses) {
    state.proposed.emplace_back();
    if (&pose == &result.poses.front())
      for (const NamedValue& v : pose.configuration) state.names.push_back(v.name);
    for (const NamedValue& v : pose.configuration) state.proposed.back().push_back(v.value);
  }
  state.variant = result.variant;
  state.seed = options.seed;
  state.kept = result.kept;
  return state;
}

std::string next_state_text(const NextState& state) {
  StateJson history = StateJson::array(), files = StateJson::array();
  for (const NextPoint& point : state.history)
    history.push_back({{"poses", point.poses}, {"expected", or_null(point.expected)}, {"upper", or_null(point.upper)}});
  for (const WrittenWith& file : state.files) files.push_back({{"path", file.path}, {"sha256", file.sha256}});
  const StateJson json = {
      {"version", version},
      {"problem",
       {{"file", state.problem_file},
        {"sha256", state.problem_sha256},
        {"parameters_sha256", state.parameters_sha256}}},
      {"data", {{"file", state.data_file}, {"bytes", state.data_bytes}, {"sha256", state.data_sha256}}},
      {"history", history},
      {"proposed", {{"names", state.names}, {"configurations", state.proposed}}},
      {"files", files},
      {"candidates", candidates_json(state)}};
  // In one line behind the head by which posewright knows its own files.
  return "{\"schema\": \"" + std::string(schema) + "\", " + json_text(json, JsonLayout::one_line).substr(1) + "\n";
}

WholeLines whole_lines(const std::string& bytes) {
  WholeLines lines;
  const std::size_t end = bytes.rfind('\n');
  lines.text = end == std::string::npos ? "" : bytes.substr(0, end + 1);
  lines.rest = bytes.substr(lines.text.size());
  lines.next_line = 1 + int(std::count(lines.text.begin(), lines.text.end(), '\n'));
  int written = 0;
  for (std::size_t at = 0; at < lines.text.size(); at = lines.text.find('\n', at) + 1)
    if (const std::size_t first = lines.text.find_first_not_of(" \t\r", at);
        first != std::string::npos && lines.text[first] != '\n' && lines.text[first] != '#')
      ++written;
  lines.has_rows = written > 1;
  return lines;
}

}  // namespace posewright
