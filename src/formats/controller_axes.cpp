#include "controller_axes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "posewright/formats/format_text.hpp"
#include "posewright/support/error.hpp"

namespace posewright::formats {
namespace {

constexpr std::size_t turning_axes = 6;

}  // namespace

Axes::Axes(const PoseSequence& sequence, const ExportOptions& options, const ProgramRules& rules)
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

std::vector<double> Axes::of(const std::vector<double>& q) const {
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

void Axes::require_inside(const std::vector<double>& axes, const std::string& point) const {
  for (std::size_t i = 0; i < settings_.range_deg.size(); ++i) {
    const auto [lower, upper] = settings_.range_deg[i];
    if (axes[i] >= lower && axes[i] <= upper) continue;
    const char* unit = sequence_.units[i] == "rad" ? "deg" : "mm";
    throw CannotDo(fmt::format("{}: axis {} of the controller would be at {:.3f} {}; {} allows {} to {}", point,
                               names_[i], axes[i], unit, settings_.file, lower, upper));
  }
}

std::vector<std::string> Axes::notes() const {
  if (settings_.sign.empty() && settings_.zero_deg.empty())
    return {
        "joint signs and zeros are taken to be those of the plan's robot: check them on the controller at slow "
        "speed (--controller FILE changes them)"};
  return {};
}

void Axes::require_settings() const {
  const auto refuse = [&](const char* what, const char* why) {
    throw InputError({}, fmt::format("{} needs {}", rules_.format, what), why);
  };
  if (rules_.coupling_needed != nullptr && !coupling_) refuse("--coupling F", rules_.coupling_needed);
  if (rules_.signs_needed == nullptr) return;
  if (settings_.pulses_per_degree.empty()) refuse("pulses_per_degree in --controller FILE", rules_.signs_needed);
  if (settings_.sign.empty()) refuse("sign in --controller FILE", rules_.signs_needed);
  if (settings_.zero_deg.empty()) refuse("zero_deg in --controller FILE", rules_.signs_needed);
}

void Axes::name_axes() {
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

void Axes::require_joints() const {
  if (names_.size() != sequence_.names.size())
    throw CannotDo(fmt::format(
        "{} has six turning axes, the plan {} joints ({}){}", rules_.format, sequence_.names.size(),
        fmt::join(sequence_.names, ", "),
        rules_.axes.size() > turning_axes ? "; name the controller's axes in --controller FILE (axes)" : ""));
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

void Axes::require_length(std::size_t size, const char* key) const {
  if (size > 0 && size != sequence_.names.size())
    throw InputError({settings_.file, settings_.lines.at(key)}, fmt::format("{} has {} numbers", key, size),
                     fmt::format("the plan has {} joints", sequence_.names.size()));
}

void Axes::require_plausible_zeros() const {
  for (std::size_t i = 0; i < settings_.zero_deg.size(); ++i)
    if (sequence_.units[i] == "rad" && std::abs(settings_.zero_deg[i]) > 360)
      throw InputError({settings_.file, settings_.lines.at("zero_deg")},
                       fmt::format("zero_deg has {} for a joint that turns", settings_.zero_deg[i]),
                       "-360 to 360; mm where the axis slides");
}

int Axes::index_of(const std::string& axis) const {
  const auto at = std::find(names_.begin(), names_.end(), axis);
  return at == names_.end() ? -1 : int(at - names_.begin());
}

void allow_settings(const ControllerSettings& settings, const char* format, const std::vector<std::string>& keys) {
  for (const auto& [key, line] : settings.lines)
    if (std::find(keys.begin(), keys.end(), key) == keys.end())
      throw InputError({settings.file, line}, fmt::format("'{}' is not read for {}", key, format),
                       fmt::format("allowed: {}", fmt::join(keys, ", ")));
}

}  // namespace posewright::formats
