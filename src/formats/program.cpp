#include "program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "posewright/formats/format_text.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/sha256.hpp"

namespace posewright::formats {
namespace {

constexpr std::size_t turning_axes = 6;

/// Joint values as a controller counts them. Refers to what it is made from.
class Axes {
 public:
  /// Throws InputError if a setting is missing or of another number than the joints, CannotDo if the plan's
  /// joints are not the controller's.
  Axes(const PoseSequence& sequence, const ExportOptions& options, const ProgramRules& rules)
      : sequence_(sequence), settings_(options.controller), rules_(rules) {
    allow_settings(settings_, rules.format, rules.settings);
    coupling_ = options.coupling ? options.coupling : settings_.coupling;
    require_settings();
    name_axes();
    require_joints();
    require_length(settings_.sign.size(), "sign");
    require_length(settings_.zero_deg.size(), "zero_deg");
    require_plausible_zeros();
    require_length(settings_.pulses_per_degree.size(), "pulses_per_degree");
    require_length(settings_.range_deg.size(), "range_deg");
  }

  const std::vector<std::string>& names() const { return names_; }
  /// sign · (value, J3 less f · J2) + zero, deg; mm for what slides.
  std::vector<double> of(const std::vector<double>& q) const {
    std::vector<double> result;
    for (std::size_t i = 0; i < q.size(); ++i) {
      double value = q[i];
      if (coupling_ && names_[i] == rules_.axes[2]) value -= *coupling_ * q[std::size_t(index_of(rules_.axes[1]))];
      value = to_degrees_or_millimetres(value, sequence_.units[i]);
      if (!settings_.sign.empty()) value *= settings_.sign[i];
      if (!settings_.zero_deg.empty()) value += settings_.zero_deg[i];
      result.push_back(value);
    }
    return result;
  }
  /// Throws CannotDo for an axis beyond what the settings say it may be. `point` is what the pose is called.
  void require_inside(const std::vector<double>& axes, const std::string& point) const {
    for (std::size_t i = 0; i < settings_.range_deg.size(); ++i) {
      const auto [lower, upper] = settings_.range_deg[i];
      if (axes[i] >= lower && axes[i] <= upper) continue;
      const char* unit = sequence_.units[i] == "rad" ? "deg" : "mm";
      throw CannotDo(fmt::format("{}: axis {} of the controller would be at {:.3f} {}; {} allows {} to {}", point,
                                 names_[i], axes[i], unit, settings_.file, lower, upper));
    }
  }
  /// Notes on what the user must check.
  std::vector<std::string> notes() const {
    if (settings_.sign.empty() && settings_.zero_deg.empty())
      return {
          "joint signs and zeros are taken to be those of the plan's robot: check them on the controller at slow "
          "speed (--controller FILE changes them)"};
    return {};
  }

 private:
  void require_settings() const {
    const auto refuse = [&](const char* what, const char* why) {
      throw InputError({}, fmt::format("{} needs {}", rules_.format, what), why);
    };
    if (rules_.coupling_needed != nullptr && !coupling_) refuse("--coupling F", rules_.coupling_needed);
    if (rules_.signs_needed == nullptr) return;
    if (settings_.pulses_per_degree.empty()) refuse("pulses_per_degree in --controller FILE", rules_.signs_needed);
    if (settings_.sign.empty()) refuse("sign in --controller FILE", rules_.signs_needed);
    if (settings_.zero_deg.empty()) refuse("zero_deg in --controller FILE", rules_.signs_needed);
  }

  void name_axes() {
    names_ = settings_.axes;
    if (!names_.empty()) {
      if (names_.size() != sequence_.names.size())
        throw InputError({settings_.file, settings_.lines.at("axes")}, fmt::format("axes has {} names", names_.size()),
                         fmt::format("the plan has {} joints", sequence_.names.size()));
    } else {
      names_.assign(rules_.axes.begin(), rules_.axes.begin() + turning_axes);
    }
    std::vector<std::string> sorted = names_;
    std::sort(sorted.begin(), sorted.end());
    for (const std::string& name : names_)
      if (std::find(rules_.axes.begin(), rules_.axes.end(), name) == rules_.axes.end() ||
          std::count(sorted.begin(), sorted.end(), name) > 1)
        throw InputError({settings_.file, settings_.lines.count("axes") > 0 ? settings_.lines.at("axes") : 0},
                         "axes has " + in_quotes(name), fmt::format("each once of {}", fmt::join(rules_.axes, ", ")));
  }

  void require_joints() const {
    if (names_.size() != sequence_.names.size())
      throw CannotDo(fmt::format(
          "{} has six turning axes, the plan {} joints ({}){}", rules_.format, sequence_.names.size(),
          fmt::join(sequence_.names, ", "),
          sequence_.names.size() < turning_axes ? "; no program for fewer axes is written, lists of poses are (csv)"
          : rules_.axes.size() > turning_axes   ? "; name the controller's axes in --controller FILE (axes)"
                                                : ""));
    for (std::size_t i = 0; i < turning_axes; ++i)
      if (index_of(rules_.axes[i]) < 0)
        throw CannotDo(fmt::format("{} needs axis {}: programs of robots with fewer than six axes are not written",
                                   rules_.format, rules_.axes[i]));
      else if (sequence_.units[std::size_t(index_of(rules_.axes[i]))] != "rad")
        throw CannotDo(
            fmt::format("{}: axis {} turns, joint {} slides{}", rules_.format, rules_.axes[i],
                        in_quotes(sequence_.names[std::size_t(index_of(rules_.axes[i]))]),
                        rules_.axes.size() > turning_axes ? "; name external axes in --controller FILE (axes)" : ""));
  }

  void require_length(std::size_t size, const char* key) const {
    if (size > 0 && size != sequence_.names.size())
      throw InputError({settings_.file, settings_.lines.at(key)}, fmt::format("{} has {} numbers", key, size),
                       fmt::format("the plan has {} joints", sequence_.names.size()));
  }

  void require_plausible_zeros() const {
    for (std::size_t i = 0; i < settings_.zero_deg.size(); ++i)
      if (sequence_.units[i] == "rad" && std::abs(settings_.zero_deg[i]) > 360)
        throw InputError({settings_.file, settings_.lines.at("zero_deg")},
                         fmt::format("zero_deg has {} for a joint that turns", settings_.zero_deg[i]),
                         "-360 to 360; mm where the axis slides");
  }

  int index_of(const std::string& axis) const {
    const auto at = std::find(names_.begin(), names_.end(), axis);
    return at == names_.end() ? -1 : int(at - names_.begin());
  }

  const PoseSequence& sequence_;
  const ControllerSettings& settings_;
  const ProgramRules& rules_;
  std::optional<double> coupling_;
  std::vector<std::string> names_;
};

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

/// Time of a route's motions. Its seconds are those of the speed that its workspace states, full speed by default.
std::string time_of(const PoseSequence& sequence, double percent) {
  double seconds = 0;
  for (const SequenceMotion& motion : sequence.motions) seconds += motion.seconds;
  if (seconds == 0) return {};
  return fmt::format(": about {:.0f} s of motion if the route's {:.0f} s are at full speed", 100 / percent * seconds,
                     seconds);
}

}  // namespace

void allow_settings(const ControllerSettings& settings, const char* format, const std::vector<std::string>& keys) {
  for (const auto& [key, line] : settings.lines)
    if (std::find(keys.begin(), keys.end(), key) == keys.end())
      throw InputError({settings.file, line}, fmt::format("'{}' is not read for {}", key, format),
                       fmt::format("allowed: {}", fmt::join(keys, ", ")));
}

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
