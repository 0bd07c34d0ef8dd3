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
  /// Index of an axis of the language among the joints; their number if it is none.
  std::size_t index_of(std::size_t axis) const { return axis < places_.size() ? places_[axis] : axes_.size(); }
  /// As the controller counts them, wherever that is.
  std::vector<double> count(const std::vector<double>& joints) const;
  /// Throws CannotDo for an axis beyond the range that the settings give it.
  std::vector<double> values(const std::vector<double>& joints) const;
  /// A value as text.
  std::string text(double value) const;

 private:
  void require_settings(std::optional<double> coupling) const;
  void name_axes();

  const Language& language_;
  std::vector<std::string> names_, units_, axes_;
  std::vector<std::size_t> places_;  ///< of the language's axes among the joints
  ControllerSettings settings_;
  double coupling_ = 0.0;
};

}  // namespace posewright::programs
