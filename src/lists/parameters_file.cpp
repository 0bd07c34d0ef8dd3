#include "posewright/lists/parameters_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "posewright/model/apply_parameters.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/json.hpp"
#include "posewright/support/text_file.hpp"

namespace posewright {
namespace {

std::filesystem::path find_near(const std::string& name, const std::filesystem::path& plan) {
  std::error_code code;
  for (const std::filesystem::path& file : {std::filesystem::path(name), plan.parent_path() / name,
                                            plan.parent_path() / std::filesystem::path(name).filename()})
    if (std::filesystem::is_regular_file(file, code)) return file;
  throw InputError({plan.string(), 0}, "its parameters file '" + name + "' is not there",
                   "name it with --parameters FILE");
}

/// A word as it is where YAML takes it for nothing but a text, else in double quotes.
std::string yaml_text(const std::string& text) {
  static constexpr std::array<std::string_view, 9> words = {"true", "false", "null", "yes", "no",
                                                            "on",   "off",   "y",    "n"};
  std::string lower;
  for (const char c : text) lower += c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || c == '_'; };
  const bool plain =
      !text.empty() && is_letter(lower.front()) && std::find(words.begin(), words.end(), lower) == words.end() &&
      std::all_of(lower.begin(), lower.end(),
                  [&](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '/'; });
  if (plain) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  return quoted + "\"";
}

/// Calls `read` with a key of a plan's problem; not for a file that has none.
template <class Read>
void read_of_problem(const std::filesystem::path& plan, const std::string& name, const Read& read) {
  try {
    const auto json = parse_json(read_text(plan, plan_size_limit));
    const nlohmann::json::json_pointer key("/problem/" + name);
    if (json.is_object() && json.contains(key)) read(json.at(key));
  } catch (const nlohmann::json::exception&) {
    // Another file: a list of poses, JSON of something else.
  }
}

}  // namespace

ParametersFile parameters_of(const Problem& problem) {
  if (!problem.parameters) return {};
  return {problem.parameters->file.string(), problem.parameters->sha256, problem.parameters->variant.value};
}

ParametersFile parameters_of_plan(const std::filesystem::path& plan) {
  ParametersFile stated;
  read_of_problem(plan, "parameters", [&](const nlohmann::json& parameters) {
    const ParametersFile named = {parameters.at("file").get<std::string>(), parameters.at("sha256").get<std::string>(),
                                  parameters.at("variant").get<std::string>()};
    stated = {find_near(named.file, plan).string(), named.sha256, named.variant};
  });
  return stated;
}

KeyEdits edits_of_plan(const std::filesystem::path& plan) {
  KeyEdits edits;
  read_of_problem(plan, "set", [&](const nlohmann::json& stated) {
    KeyEdits all;
    for (const auto& edit : stated)
      all.push_back({edit.at("key").get<std::string>(), edit.at("value").get<std::string>()});
    edits = std::move(all);
  });
  return edits;
}

std::string parameters_note(const std::string& name, const ParametersFile& made_at, const ParametersFile& now) {
  if (made_at.sha256 == now.sha256) return "";
  if (now.file.empty())
    return fmt::format("{} was made at the parameters of {}; this run uses nominal ones (--parameters {})", name,
                       made_at.file, made_at.file);
  if (made_at.file.empty())
    return fmt::format("{} was made at nominal parameters; this run uses those of {}", name, now.file);
  return fmt::format("{} was made at the parameters of {} with sha256 {:.8}…; this run uses those of {} ({:.8}…)", name,
                     made_at.file, made_at.sha256, now.file, now.sha256);
}

void note_parameters(const PoseList& list, const ParametersFile& now, std::vector<std::string>& notes) {
  if (list.problem_sha256.empty()) return;
  if (std::string note = parameters_note(list.name, list.parameters_file, now); !note.empty())
    notes.push_back(std::move(note));
}

std::string parameters_yaml(const ProblemVariant& variant, const std::vector<EstimatedValue>& values,
                            const std::optional<CalibratedEffect>& unmodelled) {
  std::string text = fmt::format(
      "posewright_parameters: 1\nvariant: {}\nconvention: {}\nproblem: {{file: {}, sha256: {}}}\n"
      "# Values in SI.\n",
      yaml_text(variant.spec.name), convention_name(variant.spec.convention), yaml_text(variant.problem.file.string()),
      yaml_text(variant.problem.sha256));
  if (unmodelled) text += fmt::format("unmodelled: {{size: {}, length: {}}}\n", unmodelled->size, unmodelled->length);
  text += "parameters:";
  bool any = false;
  for (const EstimatedValue& entry : values) {
    const CalibratedValue& v = entry.value;
    if (v.correction() == 0.0 && !entry.sigma) continue;
    text += fmt::format("\n  {}: {{value: {}, unit: {}, nominal: {}", yaml_text(v.name), v.value, yaml_text(v.unit),
                        v.nominal);
    if (entry.sigma) text += fmt::format(", sigma: {}", *entry.sigma);
    text += "}";
    any = true;
  }
  return text + (any ? "\n" : " {}\n");
}

}  // namespace posewright
