#include "posewright/results/compensation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "document.hpp"
#include "posewright/formats/json_values.hpp"
#include "posewright/support/table.hpp"

namespace posewright {
namespace {

using Json = nlohmann::ordered_json;

// More lines than these nobody reads; --json has all.
constexpr std::size_t most_failures = 20, most_lines = 20;

std::string length_in_mm(double metres) { return fmt::format("{:.6f}", metres * 1e3); }
std::string angle_in_deg(double radians) { return fmt::format("{:.6f}", radians * 180 / std::numbers::pi); }

Json tip_error_json(const TipError& error) {
  return {{"position", finite_or_null(error.position)}, {"rotation", finite_or_null(error.rotation)}};
}

Json error_summary_json(const TipErrorSummary& s) {
  return {{"position_rms", s.position_rms},
          {"position_largest", s.position_largest},
          {"rotation_rms", s.rotation_rms},
          {"rotation_largest", s.rotation_largest}};
}

Json commanded_list_json(const CompensatedList& list, const Compensation& all) {
  Json poses = Json::array();
  const std::size_t axes = all.axes.size();
  for (std::size_t i = 0; i < list.solutions.size(); ++i) {
    const CommandSolver::Solution& s = list.solutions[i];
    Json pose = {{"id", list.ids[i]}, {"line", list.lines[i] > 0 ? Json(list.lines[i]) : Json(nullptr)}};
    pose["compensated"] = s.outcome == CommandSolver::Outcome::reached;
    Json configuration = Json::array();
    for (std::size_t k = 0; k < list.width; ++k)
      if (!all.coordinates[k].choice()) configuration.push_back(list.configuration(i)[k]);
    pose["configuration"] = configuration;
    if (all.parallel) {
      pose["actuators"] = Json::object();
      for (std::size_t k = 0; k < axes; ++k) pose["actuators"][all.axes[k].name] = list.actuators[i * axes + k];
    }
    pose["before"] = tip_error_json(s.before);
    pose["after"] = tip_error_json(s.after);
    poses.push_back(std::move(pose));
  }
  return {{"file", list.file}, {"poses", std::move(poses)}};
}

const char* treatment_key(Treatment treatment) {
  switch (treatment) {
    case Treatment::compensated:
      return "compensated";
    case Treatment::left:
      return "left";
    case Treatment::not_compensated:
      return "not_compensated";
    case Treatment::not_understood:
      return "not_understood";
  }
  return "";
}

Json account_json(const ProgramAccount& program) {
  Json json = {{"file", program.file}, {"format", program.format}, {"lines", Json::array()}};
  for (const Treatment t :
       {Treatment::compensated, Treatment::left, Treatment::not_compensated, Treatment::not_understood})
    json[treatment_key(t)] = program.count(t);
  for (const ProgramEntry& entry : program.entries)
    json["lines"].push_back({{"line", entry.line},
                             {"what", entry.what},
                             {"treatment", treatment_key(entry.treatment)},
                             {"why", entry.why.empty() ? Json(nullptr) : Json(entry.why)}});
  return json;
}

std::string words_of(Treatment treatment) {
  if (treatment == Treatment::left) return "left on purpose";
  std::string words = treatment_key(treatment);
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

/// Every motion and point of a program, with the reason where it is not compensated.
std::string account_text(const ProgramAccount& program) {
  std::string text =
      fmt::format("\n{} ({}): {} compensated, {} left on purpose, {} not compensated, {} not understood\n",
                  program.file, program.format, program.count(Treatment::compensated), program.count(Treatment::left),
                  program.count(Treatment::not_compensated), program.count(Treatment::not_understood));
  Table table({"line", "motion or point", "", ""}, "rl");
  std::size_t hidden = 0;
  std::map<Treatment, std::size_t> shown;
  for (const ProgramEntry& entry : program.entries) {
    if (++shown[entry.treatment] <= most_lines)
      table.row({std::to_string(entry.line), entry.what, words_of(entry.treatment), entry.why});
    else ++hidden;
  }
  text += table.text();
  return hidden == 0 ? text : text + fmt::format("  … and {} more lines (--json)\n", hidden);
}

}  // namespace

std::string compensation_text(const Compensation& c) {
  const std::size_t all = c.compensated + c.failures.size();
  std::string text =
      fmt::format("{} of {} {} compensated, variant {}{}\n\n", c.compensated, all, all == 1 ? "pose is" : "poses are",
                  c.variant, c.position_only ? ", positions alone" : "");
  if (const std::size_t open = c.open_lines(); open > 0)
    text.insert(text.size() - 2,
                fmt::format("; {} of the programs {} not", open == 1 ? "1 line" : fmt::format("{} lines", open),
                            open == 1 ? "is" : "are"));
  if (c.compensated > 0) {
    Table errors({"error of the tip, predicted", "RMS", "largest"});
    errors.row({"position before [mm]", length_in_mm(c.before.position_rms), length_in_mm(c.before.position_largest)});
    errors.row({"position after [mm]", length_in_mm(c.after.position_rms), length_in_mm(c.after.position_largest)});
    errors.row(
        {"orientation before [deg]", angle_in_deg(c.before.rotation_rms), angle_in_deg(c.before.rotation_largest)});
    errors.row({"orientation after [deg]", angle_in_deg(c.after.rotation_rms), angle_in_deg(c.after.rotation_largest)});
    text += errors.text() + "\n";
    Table changes({c.parallel ? "change of actuator" : "change of joint", "", "RMS", "largest"}, "llr");
    for (const AxisChange& axis : c.axes) {
      const auto shown = [&](double value) { return axis.unit == "m" ? length_in_mm(value) : angle_in_deg(value); };
      changes.row({axis.name, axis.unit == "m" ? "mm" : "deg", shown(axis.rms), shown(axis.largest)});
    }
    text += changes.text();
  }
  for (const ProgramAccount& program : c.programs) text += account_text(program);
  if (!c.lines.empty()) {
    const LineDeviation& worst = *std::ranges::max_element(c.lines, {}, &LineDeviation::largest);
    text += fmt::format("\n{} straight {} between poses: the tool {} ({}:{})\n", c.lines.size(),
                        c.lines.size() == 1 ? "motion" : "motions",
                        std::isfinite(worst.largest)
                            ? fmt::format("leaves the line by up to {} mm", length_in_mm(worst.largest))
                            : "cannot follow the line",
                        worst.file, worst.line);
  }
  if (c.failures.empty()) return text;
  text += fmt::format("\nNot compensated: {}\n", c.failures.size());
  for (std::size_t i = 0; i < std::min(most_failures, c.failures.size()); ++i)
    text += "  " + c.failures[i].text() + "\n";
  if (c.failures.size() > most_failures)
    text += fmt::format("  … and {} more (--json)\n", c.failures.size() - most_failures);
  return text;
}

Json compensation_json(const Problem& problem, const Compensation& c) {
  Json json = begin_document("posewright/compensation/1", problem);
  json["variant"] = c.variant;
  json["position_only"] = c.position_only;
  json["poses"] = c.compensated + c.failures.size();
  json["compensated"] = c.compensated;
  json["names"] = Json::array();
  json["units"] = Json::array();
  for (const Coordinate& coordinate : c.coordinates)
    if (!coordinate.choice()) {
      json["names"].push_back(coordinate.name);
      json["units"].push_back(coordinate.unit);
    }
  json["error"] = {{"before", error_summary_json(c.before)}, {"after", error_summary_json(c.after)}};
  json["changes"] = list_json(c.axes, [](const AxisChange& axis) {
    return Json{{"name", axis.name}, {"unit", axis.unit}, {"rms", axis.rms}, {"largest", axis.largest}};
  });
  json["not_compensated"] = list_json(c.failures, [](const NotCompensated& n) {
    return Json{{"file", n.file}, {"line", n.line > 0 ? Json(n.line) : Json(nullptr)}, {"id", n.id}, {"why", n.why}};
  });
  json["lists"] = list_json(c.lists, [&](const CompensatedList& list) { return commanded_list_json(list, c); });
  json["programs"] = list_json(c.programs, account_json);
  json["lines"] = list_json(c.lines, [](const LineDeviation& line) {
    return Json{{"file", line.file}, {"line", line.line}, {"largest", finite_or_null(line.largest)}};
  });
  json["notes"] = c.notes;
  return json;
}

std::string NotCompensated::text() const {
  return fmt::format("{}{}: pose {}: {}", file, line > 0 ? fmt::format(":{}", line) : "", id, why);
}

void Compensation::add_account(ProgramAccount account, const CompensatedList& list) {
  for (ProgramEntry& entry : account.entries) {
    if (entry.point < 0 || list.solutions[std::size_t(entry.point)].outcome == CommandSolver::Outcome::reached)
      continue;
    entry.treatment = Treatment::not_compensated;
    for (const NotCompensated& failure : failures)
      if (failure.file == list.file && failure.id == list.ids[std::size_t(entry.point)]) entry.why = failure.why;
  }
  programs.push_back(std::move(account));
}

void Compensation::settle_motions() {
  std::map<std::string, std::string> open;
  for (const ProgramAccount& program : programs)
    for (const ProgramEntry& entry : program.entries)
      if (entry.treatment == Treatment::not_compensated && !entry.target.empty())
        open.insert({entry.target, entry.why});
  for (ProgramAccount& program : programs)
    for (ProgramEntry& entry : program.entries) {
      const auto at = open.find(entry.target);
      if (entry.point >= 0 || at == open.end() || entry.treatment != Treatment::compensated) continue;
      entry.treatment = Treatment::not_compensated;
      entry.why = at->second;
    }
}

std::size_t Compensation::open_lines() const {
  std::size_t count = 0;
  for (const ProgramAccount& program : programs)
    count += program.count(Treatment::not_compensated) + program.count(Treatment::not_understood);
  return count;
}

}  // namespace posewright
