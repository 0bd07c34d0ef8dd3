#include "account.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <set>

namespace posewright::programs {
namespace {

using Form = FoundPoint::Form;

struct Verdict {
  Treatment treatment = Treatment::left;
  std::string why;
};

Verdict left(std::string why) { return {Treatment::left, std::move(why)}; }
Verdict not_understood(std::string why) { return {Treatment::not_understood, std::move(why)}; }

/// HOME, XHOME, jHome, XPHOME: a place of the joints. HOMEPLATE is none.
bool is_home(const std::string& name) {
  std::string word = upper(name);
  while (!word.empty() && (is_digit(word.back()) || word.back() == '_')) word.pop_back();
  for (const char* home : {"HOME", "XHOME", "JHOME", "PHOME", "XPHOME", "H_POS", "$H_POS"})
    if (word == home) return true;
  return false;
}

std::string scope_of(const ReadProgram& program) {
  const std::filesystem::path file = program.file->name;
  switch (program.language->scope) {
    case Scope::file:
      return program.file->name;
    case Scope::stem:
      return (file.parent_path() / upper(file.stem().string())).string();
    case Scope::folder:
      return file.parent_path().string();
    case Scope::all:
      return "";
  }
  return "";
}

/// Where the first of each kind of use is.
struct Tally {
  std::map<Role, const Use*> first;
  std::vector<Verdict> points;

  const Use* with(Role role) const {
    const auto at = first.find(role);
    return at == first.end() ? nullptr : at->second;
  }
};

class Accountant {
 public:
  explicit Accountant(const std::vector<ReadProgram>& programs) : programs_(programs) {}

  std::vector<ProgramAccount> run() {
    for (const ReadProgram& program : programs_) count_uses(program);
    std::vector<ProgramAccount> accounts;
    for (const ReadProgram& program : programs_) accounts.push_back(points_of(program));
    for (std::size_t i = 0; i < programs_.size(); ++i) add_motions(programs_[i], accounts[i]);
    return accounts;
  }

 private:
  std::string key(const ReadProgram& program, const std::string& name) const {
    return program.language->format + '\n' + scope_of(program) + '\n' +
           (program.language->capitals ? upper(name) : name);
  }

  void count_uses(const ReadProgram& program) {
    for (const Use& use : program.reading.uses) {
      if (use.role != Role::operand && use.role != Role::changed && use.role != Role::passed)
        moving_.insert(scope_of(program));
      if (!use.name.empty()) tallies_[key(program, use.name)].first.try_emplace(use.role, &use);
    }
  }

  ProgramAccount points_of(const ReadProgram& program) {
    ProgramAccount account{program.file->name, program.language->format, {}};
    const Reading& reading = program.reading;
    std::vector<const Use*> inline_use(reading.points.size(), nullptr);
    for (const Use& use : reading.uses)
      if (use.point) inline_use[*use.point] = &use;
    for (std::size_t i = 0; i < reading.points.size(); ++i) {
      const FoundPoint& point = reading.points[i];
      Verdict verdict;
      std::string what = point.name;
      if (const Use* use = inline_use[i]) {
        verdict = of_inline(program, point, *use);
        what = use->instruction;
      } else {
        Tally& tally = tallies_[key(program, point.name)];
        verdict = of_named(program, point, tally);
        tally.points.push_back(verdict);
        if (!point.label.empty()) what += " " + point.label;
      }
      account.entries.push_back({point.line, what.empty() ? "point" : what, verdict.treatment, verdict.why, int(i)});
    }
    return account;
  }

  static Verdict by_form(const ReadProgram& program, const FoundPoint& point) {
    if (point.form == Form::unclear) return not_understood(point.why);
    if (point.form == Form::pose)
      return {Treatment::not_compensated, "given by position and orientation: the controller finds its joints"};
    for (const std::string& axis : program.axes)
      if (std::none_of(point.axes.begin(), point.axes.end(),
                       [&](const auto& a) { return upper(a.first) == upper(axis); }))
        return not_understood(fmt::format("has no axis {}: it stays where it is", axis));
    return {Treatment::compensated, ""};
  }

  static Verdict of_inline(const ReadProgram& program, const FoundPoint& point, const Use& use) {
    if (use.role == Role::step) return left("relative");
    if (use.role == Role::passed) return not_understood("is handed to " + use.instruction);
    return by_form(program, point);
  }

  Verdict of_named(const ReadProgram& program, const FoundPoint& point, const Tally& tally) const {
    if (is_home(point.name) || is_home(point.label)) return left("home: a place of the joints");
    const Use *moved = tally.with(Role::pose), *step = tally.with(Role::step), *offset = tally.with(Role::offset),
              *passed = tally.with(Role::passed), *changed = tally.with(Role::changed),
              *operand = tally.with(Role::operand);
    if (point.name.empty()) return by_form(program, point);
    if ((moved != nullptr || passed != nullptr) && changed != nullptr)
      return not_understood(fmt::format("the program changes it (line {})", changed->line));
    if (moved != nullptr && step != nullptr)
      return not_understood(
          fmt::format("is a pose (line {}) and a relative motion (line {})", moved->line, step->line));
    if (moved != nullptr) return by_form(program, point);
    if (passed != nullptr)
      return not_understood(fmt::format("is handed to {} (line {})", passed->instruction, passed->line));
    if (step != nullptr) return left(fmt::format("relative ({}, line {})", step->instruction, step->line));
    if (offset != nullptr) return left(fmt::format("only used with an offset (line {})", offset->line));
    if (operand != nullptr) return left(fmt::format("an operand (line {})", operand->line));
    if (changed != nullptr)
      return left(fmt::format("the program changes it (line {}) and does not move to it", changed->line));
    const bool taught = program.language->taught_prefix != 0 &&
                        upper(point.name).front() == program.language->taught_prefix &&
                        moving_.count(scope_of(program)) == 0;
    if (taught || point.form == Form::unclear) return by_form(program, point);
    return left("no motion of these files uses it");
  }

  void add_motions(const ReadProgram& program, ProgramAccount& account) const {
    for (const Use& use : program.reading.uses) {
      if (!use.moves || use.point || use.role == Role::operand || use.role == Role::changed || use.role == Role::passed)
        continue;
      const Verdict verdict = of_motion(program, use);
      account.entries.push_back({use.line, use.name.empty() ? use.instruction : use.instruction + " " + use.name,
                                 verdict.treatment, verdict.why});
    }
    std::stable_sort(account.entries.begin(), account.entries.end(),
                     [](const ProgramEntry& a, const ProgramEntry& b) { return a.line < b.line; });
  }

  Verdict of_motion(const ReadProgram& program, const Use& use) const {
    switch (use.role) {
      case Role::step:
        return left("relative");
      case Role::offset:
        return left("computed from " + use.why + " with an offset");
      case Role::standing:
        return left("to where the robot is");
      case Role::other:
        return left(use.why);
      case Role::pose:
        return to_point(program, use);
      default:
        return not_understood(use.why);
    }
  }

  /// As its point, the worst of several.
  Verdict to_point(const ReadProgram& program, const Use& use) const {
    const auto at = tallies_.find(key(program, use.name));
    if (at == tallies_.end() || at->second.points.empty()) {
      if (is_home(use.name)) return left("home: a place of the joints");
      return not_understood(use.name + " has no value in these files" + other_file(program));
    }
    const auto worst =
        std::max_element(at->second.points.begin(), at->second.points.end(),
                         [](const Verdict& a, const Verdict& b) { return int(a.treatment) < int(b.treatment); });
    return *worst;
  }

  static std::string other_file(const ReadProgram& program) {
    const std::string& ending = program.language->code_ending;
    if (ending.empty()) return "";
    return ": give the " + program.language->endings.front() + " file too";
  }

  const std::vector<ReadProgram>& programs_;
  std::map<std::string, Tally> tallies_;
  std::set<std::string> moving_;  ///< scopes with motions
};

}  // namespace

std::vector<ProgramAccount> account_for(const std::vector<ReadProgram>& programs) { return Accountant(programs).run(); }

}  // namespace posewright::programs
