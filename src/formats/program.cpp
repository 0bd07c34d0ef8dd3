#include "program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "controller_axes.hpp"
#include "posewright/formats/format_text.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/sha256.hpp"

namespace posewright::formats {
namespace {

bool is_identifier(const std::string& text) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  return !text.empty() && letter(text.front()) &&
         std::all_of(text.begin(), text.end(), [&](char c) { return letter(c) || (c >= '0' && c <= '9') || c == '_'; });
}

std::string program_name(const std::string& given, const ProgramRules& rules) {
  std::string name = given.empty() ? rules.default_name : given;
  if (!is_identifier(name) || name.size() > rules.longest_name)
    throw InputError(
        {}, fmt::format("{} is not a name of a {} program", in_quotes(name), rules.format),
        fmt::format("a letter, then letters, digits and _, at most {} in all (--name)", rules.longest_name));
  if (rules.capitals)
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return char(std::toupper(c)); });
  return name;
}

/// Choices that are changed by hand between poses; a route arrives from the right side without them.
PoseChoices by_hand(const SequencePose& pose) {
  PoseChoices result = pose.choices;
  std::erase_if(result, [](const auto& choice) { return is_approach(choice.first); });
  // The instrument is moved before the load is changed.
  std::reverse(result.begin(),
               std::ranges::find_if(result, [](const auto& c) { return choice_key(c.first) == nullptr; }));
  return result;
}

bool has_approaches(const PoseSequence& sequence) {
  return std::ranges::any_of(sequence.poses.front().choices, [](const auto& c) { return is_approach(c.first); });
}

std::vector<std::string> changes(const SequencePose* before, const SequencePose& pose) {
  std::vector<std::string> result;
  for (const auto& [name, label] : by_hand(pose))
    if (before == nullptr || label_of(before->choices, name) != label)
      result.push_back(shown_choice(name) + ": " + label);
  return result;
}

class Composer {
 public:
  Composer(const PoseSequence& sequence, const Axes& axes, const ProgramRules& rules, RobotProgram& program)
      : sequence_(sequence), axes_(axes), rules_(rules), program_(program) {}

  void compose() {
    if (sequence_.from_home) add_move(home(), "home");
    // Where nothing changes on the way, nobody needs to be told where it begins.
    const bool tell = has_changes(sequence_);
    for (std::size_t k = 0; k < sequence_.poses.size(); ++k) {
      const SequencePose& pose = sequence_.poses[k];
      std::vector<std::string> messages;
      if (tell) messages = changes(k == 0 ? nullptr : &sequence_.poses[k - 1], pose);
      if (!messages.empty()) program_.steps.push_back({ProgramStep::Kind::stop, "", 0, messages});
      if (sequence_.from_home || k > 0) add_via(sequence_.motions, k - (sequence_.from_home ? 0 : 1));
      add_move(add_point(rules_.pose + std::to_string(pose.id), pose.values), fmt::format("pose {}", pose.id));
      std::string comment;
      for (const std::string& name : pose.references)
        comment += (comment.empty() ? "reference targets too: " : ", ") + name;
      program_.steps.push_back({ProgramStep::Kind::measure, comment, 0, {}});
    }
    if (!sequence_.closed || sequence_.motions.empty()) return;
    add_via(sequence_.motions, sequence_.motions.size() - 1);
    add_move(sequence_.from_home ? home() : first_pose(), "back");
  }

 private:
  std::size_t add_point(const std::string& name, const std::vector<double>& q) {
    program_.points.push_back({name, axes_.of(q)});
    axes_.require_inside(program_.points.back().axes, name);
    return program_.points.size() - 1;
  }
  void add_move(std::size_t point, const std::string& comment) {
    program_.steps.push_back({ProgramStep::Kind::move, comment, point, {}});
  }
  std::size_t home() {
    if (!home_) home_ = add_point(rules_.home, sequence_.home);
    return *home_;
  }
  std::size_t first_pose() const {
    for (const ProgramStep& step : program_.steps)
      if (step.kind == ProgramStep::Kind::move) return step.point;
    return 0;
  }
  void add_via(const std::vector<SequenceMotion>& motions, std::size_t index) {
    if (index >= motions.size()) return;
    const auto& points = motions[index].points;
    for (std::size_t i = 1; i + 1 < points.size(); ++i)
      add_move(add_point(rules_.via + std::to_string(++via_), points[i]), i == 1 ? "on the way" : "");
  }

  const PoseSequence& sequence_;
  const Axes& axes_;
  const ProgramRules& rules_;
  RobotProgram& program_;
  std::optional<std::size_t> home_;
  int via_ = 0;
};

std::vector<std::string> motion_notes(const PoseSequence& sequence) {
  if (!sequence.is_route)
    return {"the motions between the poses are not checked for collisions: `posewright route` finds motions that are"};
  return {sequence.from_home ? "the motion to home is not checked: begin with the robot there"
                             : "the motion to the first pose is not checked"};
}

/// A number that other points would not have: the first 31 bits of a hash of their names and values.
int number_of(const std::vector<ProgramPoint>& points) {
  std::string text;
  for (const ProgramPoint& point : points) text += fmt::format("{} {}\n", point.name, fmt::join(point.axes, " "));
  return int(std::stoul(sha256_hex(text).substr(0, 8), nullptr, 16) & 0x7fffffffU);
}

/// Speed of a route's motions, whose seconds are those of full speed.
std::string time_of(const PoseSequence& sequence, double percent) {
  double seconds = 0;
  for (const SequenceMotion& motion : sequence.motions) seconds += motion.seconds;
  if (seconds == 0) return {};
  return fmt::format(": about {:.0f} s of motion, {:.0f} s at full speed", 100 / percent * seconds, seconds);
}

}  // namespace

RobotProgram make_program(const PoseSequence& all, const ExportOptions& options, const ProgramRules& rules) {
  const PoseSequence sequence = to_measure(all);
  require_arrivals(sequence);
  RobotProgram program;
  program.name = program_name(options.name, rules);
  const Axes axes(sequence, options, rules);
  program.axes = axes.names();
  for (const std::string& unit : sequence.units) program.slides.push_back(unit == "m");
  program.speed = options.speed.value_or(usual_percent);
  program.settle = options.settle.value_or(sequence.settle > 0 ? sequence.settle : default_settle);
  program.wait = options.wait;
  if (options.wait && !options.digital_input.empty())
    throw InputError({}, "--wait and --digital-input cannot be combined", "leave one of them out");
  program.decimals = options.controller.decimals.value_or(rules.decimals);
  Composer(sequence, axes, rules, program).compose();
  program.number = number_of(program.points);
  program.notes = motion_notes(sequence);
  program.notes.push_back(fmt::format("speed {} % of full speed{}{}", program.speed,
                                      options.speed ? "" : " (--speed changes it)", time_of(sequence, program.speed)));
  for (std::string& note : axes.notes()) program.notes.push_back(std::move(note));
  return program;
}

int signal_number(const std::string& text, const char* option, int first, int last, int otherwise) {
  if (text.empty()) return otherwise;
  int number = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (code != std::errc() || end != text.data() + text.size() || number < first || number > last)
    throw InputError({}, fmt::format("{} {}", option, in_quotes(text)),
                     fmt::format("a whole number from {} to {} is allowed", first, last));
  return number;
}

std::string signal_name(const std::string& text, const char* option, const char* otherwise) {
  if (text.empty()) return otherwise;
  if (!is_identifier(text) || text.size() > 32)
    throw InputError({}, fmt::format("{} {}", option, in_quotes(text)),
                     "the name of a signal of the controller is expected");
  return text;
}

int tool_number(const ExportOptions& options, int otherwise) {
  return signal_number(options.tool, "--tool", 0, 255, otherwise);
}

std::string tool_name(const ExportOptions& options, const char* otherwise) {
  if (options.tool.empty()) return otherwise;
  if (!is_identifier(options.tool) || options.tool.size() > 32)
    throw InputError({}, fmt::format("--tool {}", in_quotes(options.tool)),
                     "the name of a tool of the controller is expected: a letter, then letters, digits and _");
  return options.tool;
}

PoseSequence to_measure(const PoseSequence& sequence) {
  PoseSequence result = sequence;
  std::erase_if(result.poses, [](const SequencePose& pose) { return pose.measured; });
  if (result.poses.empty()) throw CannotDo(sequence.file + ": all poses are measured already");
  const auto plain_zeros = [](std::vector<double>& q) { std::replace(q.begin(), q.end(), -0.0, 0.0); };
  plain_zeros(result.home);
  for (SequencePose& pose : result.poses) plain_zeros(pose.values);
  for (SequenceMotion& motion : result.motions) std::for_each(motion.points.begin(), motion.points.end(), plain_zeros);
  return result;
}

std::vector<std::string> list_notes(const PoseSequence& sequence) {
  std::vector<std::string> notes;
  if (has_changes(sequence))
    notes.emplace_back("the format has no place for stations, load cases and temperatures: they change on the way");
  if (has_approaches(sequence))
    notes.emplace_back("the format has no place for the side that joints arrive from: move as a route does");
  return notes;
}

Exported one_file(const std::string& name, std::string bytes, std::vector<std::string> notes) {
  return {{{name, std::move(bytes)}}, std::move(notes)};
}

void require_arrivals(const PoseSequence& sequence) {
  if (has_approaches(sequence) && !sequence.is_route)
    throw CannotDo(sequence.file +
                   ": its poses are to be reached from a stated side, which a way straight to them may miss; export a "
                   "route of them, which arrives so (posewright route)");
}

bool has_changes(const PoseSequence& sequence) {
  return std::any_of(sequence.poses.begin(), sequence.poses.end(),
                     [&](const SequencePose& pose) { return by_hand(pose) != by_hand(sequence.poses.front()); });
}

}  // namespace posewright::formats
