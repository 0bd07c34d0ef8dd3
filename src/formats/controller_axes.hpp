#pragma once

#include <optional>
#include <string>
#include <vector>

#include "program.hpp"

namespace posewright::formats {

/// Joint values as a controller counts them. Refers to what it is made from.
class Axes {
 public:
  /// Throws InputError if a setting is missing or of another number than the joints, CannotDo if the plan's
  /// joints are not the controller's.
  Axes(const PoseSequence& sequence, const ExportOptions& options, const ProgramRules& rules);

  const std::vector<std::string>& names() const { return names_; }
  /// sign · (value, J3 less f · J2) + zero, deg; mm for what slides.
  std::vector<double> of(const std::vector<double>& q) const;
  /// Throws CannotDo for an axis beyond what the settings say it may be. `point` is what the pose is called.
  void require_inside(const std::vector<double>& axes, const std::string& point) const;
  /// Notes on what the user must check.
  std::vector<std::string> notes() const;

 private:
  void require_settings() const;
  void name_axes();
  void require_joints() const;
  void require_length(std::size_t size, const char* key) const;
  void require_plausible_zeros() const;
  int index_of(const std::string& axis) const;

  const PoseSequence& sequence_;
  const ControllerSettings& settings_;
  const ProgramRules& rules_;
  std::optional<double> coupling_;
  std::vector<std::string> names_;
};

}  // namespace posewright::formats
