#include "axis_counter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "posewright/formats/format_text.hpp"
#include "posewright/support/error.hpp"

namespace posewright::programs {
namespace {

constexpr std::size_t turning_axes = 6, second = 1, third = 2;
constexpr double degree = std::numbers::pi / 180;

}  // namespace

AxisCounter::AxisCounter(const Language& language, std::vector<std::string> names, std::vector<std::string> units,
                         const ControllerSettings& settings, std::optional<double> coupling)
    : language_(language), names_(std::move(names)), units_(std::move(units)), settings_(settings) {
  if (!coupling) coupling = settings.coupling;
  require_settings(coupling);
  coupling_ = coupling.value_or(0);
  name_axes();
  for (const std::string& axis : language_.axes)
    places_.push_back(std::size_t(std::find(axes_.begin(), axes_.end(), axis) - axes_.begin()));
}

void AxisCounter::require_settings(std::optional<double> coupling) const {
  const std::string& format = language_.format;
  if (language_.needs_coupling && !coupling)
    throw InputError({}, format + " needs --coupling F",
                     "how the controller counts its third axis; 0: as the robot's file");
  if (language_.axes.empty() && coupling && *coupling != 0)
    throw InputError({}, format + " has the robot's own joints: no coupling is read", "--coupling 0, or none");
  if (language_.angle == Angle::pulses && settings_.pulses_per_degree.empty())
    throw InputError({}, format + " needs pulses_per_degree in --controller FILE", "they differ from robot to robot");
  for (const auto& [size, key] :
       {std::pair(settings_.sign.size(), "sign"), std::pair(settings_.zero_deg.size(), "zero_deg"),
        std::pair(settings_.pulses_per_degree.size(), "pulses_per_degree"),
        std::pair(settings_.range_deg.size(), "range_deg"), std::pair(settings_.axes.size(), "axes")})
    if (size > 0 && size != names_.size())
      throw InputError({settings_.file, settings_.lines.count(key) > 0 ? settings_.lines.at(key) : 0},
                       fmt::format("{} has {} entries", key, size),
                       fmt::format("the robot has {} joints", names_.size()));
  if (coupling.value_or(0) != 0 && names_.size() <= third)
    throw InputError({}, "--coupling is for robots of three axes or more", "");
}

void AxisCounter::name_axes() {
  axes_ = language_.axes.empty() ? names_ : settings_.axes;
  if (!axes_.empty()) return;
  const bool external = language_.axes.size() > turning_axes;
  if (names_.size() > language_.axes.size() || (names_.size() > turning_axes && external))
    throw CannotDo(fmt::format("{} has six turning axes, the robot {} joints{}", language_.format, names_.size(),
                               external ? "; name the controller's axes in --controller FILE (axes)" : ""));
  axes_.assign(language_.axes.begin(), language_.axes.begin() + std::ptrdiff_t(names_.size()));
}

std::vector<double> AxisCounter::joints(const std::vector<double>& values) const {
  std::vector<double> result;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    double value = values[i];
    if (language_.angle == Angle::pulses) value /= settings_.pulses_per_degree[i];
    const bool turns = units_[i] == "rad";
    const bool si = language_.angle == Angle::radians && (turns || language_.decimals < 0);
    const double unit = si ? 1.0 : turns ? degree : 1e-3;
    // zero_deg is in degrees, or mm, whatever the program counts in.
    if (!settings_.zero_deg.empty()) value -= settings_.zero_deg[i] * (si && turns ? degree : si ? 1e-3 : 1.0);
    if (!settings_.sign.empty()) value *= settings_.sign[i];
    result.push_back(value * unit);
  }
  if (const std::size_t a = index_of(second), b = index_of(third); a < result.size() && b < result.size())
    result[b] += coupling_ * result[a];
  return result;
}

std::vector<double> AxisCounter::count(const std::vector<double>& joints) const {
  std::vector<double> result;
  const std::size_t a = index_of(second), b = index_of(third);
  for (std::size_t i = 0; i < joints.size(); ++i) {
    double value = joints[i];
    if (i == b && a < joints.size()) value -= coupling_ * joints[a];
    value /= units_[i] == "rad" ? degree : 1e-3;
    if (!settings_.sign.empty()) value *= settings_.sign[i];
    if (!settings_.zero_deg.empty()) value += settings_.zero_deg[i];
    result.push_back(value);
  }
  return result;
}

std::vector<double> AxisCounter::values(const std::vector<double>& joints) const {
  std::vector<double> result = count(joints);
  for (std::size_t i = 0; i < result.size(); ++i) {
    double& value = result[i];
    if (!settings_.range_deg.empty() && (value < settings_.range_deg[i][0] || value > settings_.range_deg[i][1]))
      throw CannotDo(fmt::format("axis {} of the controller would be at {:.3f}; {} allows {} to {}", axes_[i], value,
                                 settings_.file, settings_.range_deg[i][0], settings_.range_deg[i][1]));
    if (language_.angle == Angle::radians) value *= units_[i] == "rad" ? degree : language_.decimals < 0 ? 1e-3 : 1.0;
    if (language_.angle == Angle::pulses) value *= settings_.pulses_per_degree[i];
  }
  return result;
}

std::string AxisCounter::text(double value) const {
  if (language_.decimals < 0) return formats::yaml_number(value);
  return formats::fixed(value, language_.angle == Angle::pulses ? 0 : settings_.decimals.value_or(language_.decimals));
}

}  // namespace posewright::programs
