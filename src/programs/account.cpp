#include "account.hpp"

#include <fmt/format.h>

#include <algorithm>
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

/// True if the instruction moves the robot.
bool is_motion(const Use& use) {
  return use.role != Role::operand && use.role != Role::changed && use.role != Role::passed;
}

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

/// Place of the first use of each kind.
struct Tally {
  std::map<Role, const Use*> first;
  std::vector<FramePair> frames;  ///< that motions to it are in
  std::vector<Verdict> points;

  const Use* with(Role role) const {
    const auto at = first.find(role);
    return at == first.end() ? nullptr : at->second;
  }
};

class Accountant {
 public:
  Accountant(const std::vector<ReadProgram>& programs, const ProgramRobot& robot)
      : programs_(programs), robot_(robot), frames_(robot.frames) {}

  std::vector<Accounted> run() {
    for (const ReadProgram& program : programs_) {
      count_uses(program);
      number_poses(program);
      frames_.add(*program.language, program.reading);
      if (!program.reading.displaced.empty()) displaced_.try_emplace(scope_of(program), program.reading.displaced);
    }
    std::vector<Accounted> accounts;
    for (const ReadProgram& program : programs_) accounts.push_back(points_of(program));
    for (std::size_t i = 0; i < programs_.size(); ++i) {
      add_motions(programs_[i], accounts[i].account);
      add_lines(programs_[i], accounts[i].account);
      if (const Language& language = *programs_[i].language; language.pose != nullptr && language.pose().nearest)
        accounts[i].motions = motions_of(programs_[i]);
    }
    return accounts;
  }

 private:
  std::string key(const ReadProgram& program, const std::string& name) const {
    return program.language->format + '\n' + scope_of(program) + '\n' +
           (program.language->capitals ? upper(name) : name);
  }

  void count_uses(const ReadProgram& program) {
    for (const Use& use : program.reading.uses) {
      if (is_motion(use)) moving_.insert(scope_of(program));
      if (use.name.empty()) continue;
      Tally& tally = tallies_[key(program, use.name)];
      tally.first.try_emplace(use.role, &use);
      if (use.role == Role::pose &&
          std::find(tally.frames.begin(), tally.frames.end(), use.frames) == tally.frames.end())
        tally.frames.push_back(use.frames);
    }
  }

  /// The point of a use: that of its name whose value is the last one above it.
  int target_of(const ReadProgram& program, const Use& use) const {
    if (use.point) return int(*use.point);
    int found = -1;
    const std::vector<FoundPoint>& points = program.reading.points;
    for (std::size_t i = 0; i < points.size(); ++i)
      if (!points[i].name.empty() && points[i].name == use.name && points[i].index == use.index &&
          (found < 0 || points[i].line <= use.line))
        found = int(i);
    return found;
  }

  std::vector<FoundMotion> motions_of(const ReadProgram& program) const {
    std::vector<FoundMotion> motions;
    for (const Use& use : program.reading.uses)
      if (use.moves && use.role == Role::pose)
        motions.push_back({use.line, beginning_of(program, use), target_of(program, use), use.along});
    return motions;
  }

  /// The point whose joints decide at which ones a motion ends.
  int beginning_of(const ReadProgram& program, const Use& use) const {
    if (use.near.empty()) return use.before ? target_of(program, program.reading.uses[*use.before]) : -1;
    Use near{use.line, ""};
    near.name = use.near;
    return target_of(program, near);
  }

  /// Straight motions to poses from the point of the motion above.
  void add_lines(const ReadProgram& program, ProgramAccount& account) const {
    std::string before;
    for (const Use& use : program.reading.uses) {
      if (!use.moves || !is_motion(use)) continue;
      std::string now;
      if (use.role == Role::pose)
        now = use.point ? inline_key(program, *use.point) : element_key(program, use.name, use.index);
      if (const auto at = placed_.find(now); use.straight && !before.empty() && at != placed_.end())
        account.lines.push_back({use.line, before, now, at->second.X_TipTool});
      before = now;
    }
  }

  /// "pose 3" in a remark is the number of the pose that the next motion leads to.
  void number_poses(const ReadProgram& program) {
    std::vector<std::pair<int, int>> remarks;  // lines and numbers
    int line = 1;
    const std::string_view text = program.file->text;
    for (std::size_t begin = 0; begin < text.size(); ++line) {
      const std::size_t end = std::min(text.find('\n', begin), text.size());
      if (const int number = pose_of_remark(text.substr(begin, end - begin)); number > 0)
        remarks.emplace_back(line, number);
      begin = end + 1;
    }
    for (const auto& [at, number] : remarks) {
      const Use* next = nullptr;
      for (const Use& use : program.reading.uses)
        if (use.role == Role::pose && use.line > at && (next == nullptr || use.line < next->line)) next = &use;
      if (next == nullptr) continue;
      if (next->point) numbers_[inline_key(program, *next->point)] = number;
      else numbers_[element_key(program, next->name, next->index)] = number;
    }
  }

  /// The number in ";pose 3", "! pose 3", "# pose 3", "'pose 3", "// pose 3", "  12:  !pose 3 ;"; 0: another line.
  static int pose_of_remark(std::string_view line) {
    const std::size_t word = line.find("pose ");
    if (word == std::string_view::npos || word == 0) return 0;
    const std::size_t first = line.find_first_not_of("0123456789: \t;!#'/");
    return first == word ? std::atoi(std::string(line.substr(word + 5, 9)).c_str()) : 0;
  }

  std::string element_key(const ReadProgram& program, const std::string& name, std::optional<long> index) const {
    return key(program, name) + '\n' + (index ? std::to_string(*index) : "");
  }
  static std::string inline_key(const ReadProgram& program, std::size_t point) {
    return program.file->name + '\n' + std::to_string(point);
  }

  Accounted points_of(const ReadProgram& program) {
    Accounted result{{program.file->name, program.language->format, {}}, {}, {}, {}};
    const Reading& reading = program.reading;
    result.frames.resize(reading.points.size());
    std::vector<const Use*> inline_use(reading.points.size(), nullptr);
    for (const Use& use : reading.uses)
      if (use.point) inline_use[*use.point] = &use;
    for (std::size_t i = 0; i < reading.points.size(); ++i) {
      const FoundPoint& point = reading.points[i];
      const std::string element =
          inline_use[i] != nullptr ? inline_key(program, i) : element_key(program, point.name, point.index);
      const auto number = numbers_.find(element);
      result.measured.push_back(number == numbers_.end() ? 0 : number->second);
      Verdict verdict;
      std::string what = point.name, target;
      if (const Use* use = inline_use[i]) {
        verdict = of_inline(program, point, *use);
        if (verdict.treatment == Treatment::compensated)
          verdict = placed(program, point, {use->frames}, result.frames[i]);
        what = use->instruction;
      } else {
        target = key(program, point.name);
        Tally& tally = tallies_[target];
        verdict = of_named(program, point, tally);
        if (verdict.treatment == Treatment::compensated)
          verdict = placed(program, point, tally.frames, result.frames[i]);
        tally.points.push_back(verdict);
        if (!point.label.empty()) what += " " + point.label;
      }
      result.account.entries.push_back(
          {point.line, what.empty() ? "point" : what, verdict.treatment, verdict.why, int(i), target, element});
      if (result.frames[i]) placed_.insert({element, *result.frames[i]});
    }
    return result;
  }

  /// Frames of a pose that is to be compensated; a point of joints has none.
  Verdict placed(const ReadProgram& program, const FoundPoint& point, std::vector<FramePair> used,
                 std::optional<PlacedFrames>& frames) const {
    if (point.form != Form::pose) return {Treatment::compensated, ""};
    if (!point.frames.tool.name.empty() || used.empty()) used = {point.frames};
    if (!point.frames.base.name.empty())
      for (FramePair& pair : used) pair.base = point.frames.base;
    if (used.size() > 1) return {Treatment::not_compensated, "motions to it have several tools or bases"};
    for (const FrameName* frame : {&used.front().tool, &used.front().base})
      if (const Use* changed = changed_frame(program, *frame))
        return {Treatment::not_compensated,
                fmt::format("the program changes {} (line {})", changed->name, changed->line)};
    Verdict verdict{Treatment::not_compensated, ""};
    frames = frames_.of(*program.language, used.front(), verdict.why);
    if (frames) verdict.treatment = Treatment::compensated;
    return verdict;
  }

  /// The use that gives a tool or base another value.
  const Use* changed_frame(const ReadProgram& program, const FrameName& frame) const {
    const auto at = tallies_.find(key(program, frame.name.substr(0, frame.name.find('['))));
    return frame.name.empty() || at == tallies_.end() ? nullptr : at->second.with(Role::changed);
  }

  Verdict by_form(const ReadProgram& program, const FoundPoint& point) const {
    if (point.form == Form::unclear) return not_understood(point.why);
    if (point.form == Form::pose) return by_pose(program, point);
    for (const std::string& axis : program.axes)
      if (std::none_of(point.axes.begin(), point.axes.end(),
                       [&](const auto& a) { return upper(a.first) == upper(axis); }))
        return not_understood(fmt::format("has no axis {}: it stays where it is", axis));
    return {Treatment::compensated, ""};
  }

  Verdict by_pose(const ReadProgram& program, const FoundPoint& point) const {
    const auto refuse = [](const std::string& why) { return Verdict{Treatment::not_compensated, why}; };
    if (program.language->pose == nullptr)
      return refuse("given by position and orientation: those of " + program.language->format + " are not compensated");
    if (!robot_.why_no_poses.empty()) return refuse("given by position and orientation: " + robot_.why_no_poses);
    if (const auto at = displaced_.find(scope_of(program)); at != displaced_.end()) return refuse(at->second);
    const PoseForm& form = program.language->pose();
    std::vector<std::string> needed = form.values;
    needed.insert(needed.end(), form.status.begin(), form.status.begin() + long(form.required));
    for (const std::string& name : needed)
      if (std::none_of(point.axes.begin(), point.axes.end(), [&](const auto& a) { return a.first == name; }))
        return not_understood(fmt::format("has no {}: the controller has a value of its own for it", name));
    return {Treatment::compensated, ""};
  }

  Verdict of_inline(const ReadProgram& program, const FoundPoint& point, const Use& use) {
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
      if (!use.moves || use.point || !is_motion(use)) continue;
      const Verdict verdict = of_motion(program, use);
      account.entries.push_back({use.line, use.name.empty() ? use.instruction : use.instruction + " " + use.name,
                                 verdict.treatment, verdict.why, -1,
                                 use.role == Role::pose && !use.name.empty() ? key(program, use.name) : ""});
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
  const ProgramRobot& robot_;
  FrameValues frames_;
  std::map<std::string, std::string> displaced_;  ///< scopes, and by what
  std::map<std::string, PlacedFrames> placed_;    ///< of poses, by element
  std::map<std::string, int> numbers_;            ///< of poses, by element or place in a file
  std::map<std::string, Tally> tallies_;
  std::set<std::string> moving_;  ///< scopes with motions
};

}  // namespace

std::vector<Accounted> account_for(const std::vector<ReadProgram>& programs, const ProgramRobot& robot) {
  return Accountant(programs, robot).run();
}

}  // namespace posewright::programs
