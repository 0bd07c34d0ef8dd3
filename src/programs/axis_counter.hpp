#pragma once

#include <optional>
#include <string>
#include <vector>

#include "language.hpp"
#include "posewright/controller/controller_settings.hpp"

namespace posewright::programs {

/// Joint values as a language writes them for a controller, and back.
class AxisCounter {
 public:
  /// @param names  of the robot's joints, `units` rad or m
  /// Throws InputError for settings that are missing or of another number than the joints, CannotDo for joints that the
  /// language has no axes for.
  AxisCounter(const Language& language, std::vector<std::string> names, std::vector<std::string> units,
              const ControllerSettings& settings, std::optional<double> coupling);

  /// Names of the joints in the program, in the robot's order.
  const std::vector<std::string>& axes() const { return axes_; }
  /// SI, the robot's signs and zeros.
  std::vector<double> joints(const std::vector<double>& values) const;
  /// As the controller counts them, wherever that is.
  std::vector<double> count(const std::vector<double>& joints) const;
  /// Throws CannotDo for an axis beyond the range that the settings give it.
  std::vector<double> values(const std::vector<double>& joints) const;
  /// A value as text.
  std::string text(double value) const;

 private:
  void require_settings(std::optional<double> coupling) const;
  void name_axes();
  std::size_t index_of(std::size_t axis) const;

  const Language& language_;
  std::vector<std::string> names_, units_, axes_;
  ControllerSettings settings_;
  double coupling_ = 0.0;
};

}  // namespace posewright::programs
