#pragma once

#include <span>
#include <string>
#include <vector>

namespace posewright {

/// One constraint on configurations. Members are const and may run in several threads at once.
class ValidityCheck {
 public:
  virtual ~ValidityCheck() = default;
  /// What a user reads in the table of rejections, e.g. "actuator travel"; several where a check knows several causes.
  virtual std::vector<std::string> reasons() const = 0;
  /// Index into reasons() of what forbids q, or −1.
  virtual int violation(std::span<const double> q) const = 0;
  /// Whether it follows motions, and so takes a hundred times as long as checks of one configuration.
  virtual bool follows_motions() const { return false; }
};

/// A constraint with one reason.
class SingleCheck : public ValidityCheck {
 public:
  explicit SingleCheck(std::string reason) : reason_(std::move(reason)) {}
  std::vector<std::string> reasons() const override { return {reason_}; }
  int violation(std::span<const double> q) const override { return holds(q) ? -1 : 0; }

 private:
  virtual bool holds(std::span<const double> q) const = 0;
  std::string reason_;
};

}  // namespace posewright
