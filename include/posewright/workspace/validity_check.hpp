#pragma once

#include <span>
#include <string>

namespace posewright {

/// One constraint on configurations. Members are const and may run in several threads at once.
class ValidityCheck {
 public:
  virtual ~ValidityCheck() = default;
  /// What a user reads in the table of rejections, e.g. "actuator travel".
  virtual std::string reason() const = 0;
  virtual bool holds(std::span<const double> q) const = 0;
};

}  // namespace posewright
