#include "posewright/problem/read_problem.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "posewright/problem/design_keys.hpp"
#include "posewright/support/file.hpp"
#include "posewright/support/sha256.hpp"
#include "posewright/support/text.hpp"
#include "posewright/support/text_file.hpp"
#include "sections.hpp"

namespace posewright {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t size_limit = 10'000'000;

void require_known_version(const yaml::Section& root) {
  const yaml::Value& version = root.at("posewright");
  const std::string text = version.text("the schema version 1 is expected");
  if (text != "1") version.fail("is " + in_quotes(text), "the only known schema version is 1");
}

/// What instruments are off by counts beside what the robot is.
void require_unmodelled_variant(const Problem& problem) {
  if (std::ranges::any_of(problem.variants, [](const VariantSpec& one) { return one.unmodelled.has_value(); })) return;
  const auto* list = instruments_of(problem.measurement);
  if (list == nullptr) return;
  for (const MeasurementSpec& one : *list)
    if (one.unmodelled > 0)
      throw InputError(problem.at(one.line),
                       "unmodelled of '" + one.name + "' stands beside no unmodelled of a variant",
                       "unmodelled: auto in variants");
}

bool is_below(const std::string& key, const std::string& other) { return key.starts_with(other + "."); }

/// Each key beside the design once with its last value, at its first place: a command that repeats a key of its plan
/// has the plan's problem. Where a key above or below stands between, both stay.
KeyEdits last_values(const KeyEdits& edits) {
  KeyEdits kept;
  for (const KeyEdit& edit : edits) {
    if (is_of_design(edit)) continue;
    const auto last = std::find_if(kept.rbegin(), kept.rend(), [&](const KeyEdit& other) {
      return other.key == edit.key || is_below(other.key, edit.key) || is_below(edit.key, other.key);
    });
    if (last != kept.rend() && last->key == edit.key) last->value = edit.value;
    else kept.push_back({edit.key, edit.value, "--set " + edit.key});
  }
  return kept;
}

}  // namespace

Problem read_problem(const fs::path& file, const Packages& packages, const KeyEdits& changed) {
  std::error_code code;
  // A device may never end.
  if (fs::is_character_file(file, code) || fs::is_block_file(file, code))
    throw InputError({file.string(), 0}, "is a device", "a file is needed");
  return parse_problem(read_file(file, size_limit), file, packages, changed);
}

Problem parse_problem(const std::string& text, const fs::path& file, const Packages& packages, const KeyEdits& stated) {
  const KeyEdits changed = last_values(stated);
  const std::string file_name = file.string();
  if (text.size() > size_limit)
    throw InputError({file_name, 0}, fmt::format("has {} bytes", text.size()),
                     fmt::format("at most {} are read", size_limit));
  require_text(text, file_name);
  YAML::Node document = yaml::load_document(text, file_name);
  yaml::change_keys(document, changed);
  const yaml::Section root(yaml::Value(document, 1, "", file_name));
  // A later version may have other keys, so it is judged first.
  require_known_version(root);
  root.allow({"posewright", "robot", "measurement", "variants", "workspace", "design"});

  Problem problem;
  problem.file = file;
  std::string hashed = text;
  for (const KeyEdit& edit : changed) hashed += "\n" + edit.said_by + "=" + edit.value;
  problem.sha256 = sha256_hex(hashed);
  problem.changed = changed;
  const yaml::Value& robot = root.at("robot");
  problem.packages = packages;
  problem.robot = read_robot(robot, file, packages);
  problem.robot_line = robot.line();
  problem.measurement = read_measurement(root.at("measurement"));
  problem.variants = read_variants(root.at("variants"));
  if (const yaml::Value* workspace = root.find("workspace"))
    problem.workspace = read_workspace(*workspace, problem.robot, file.parent_path());
  require_unmodelled_variant(problem);
  read_ways(root, problem);
  if (std::holds_alternative<GivenPosesSpec>(problem.robot) && problem.workspace.limits.empty())
    robot.fail("with poses alone has no limits", "workspace: pose: {x: [0.3, 0.7], …, roll: [150 deg, 210 deg], …}");
  if (const yaml::Value* design = root.find("design"))
    problem.design = read_design(*design, problem.variants, file.parent_path());
  set_design(problem, stated);
  return problem;
}

}  // namespace posewright
