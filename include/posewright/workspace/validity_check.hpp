#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "posewright/cell/necessary_limits.hpp"

namespace posewright {

/// One constraint on configurations. Members are const and may run in several threads at once.
class ValidityCheck {
 public:
  virtual ~ValidityCheck() = default;
  /// Reasons in the table of rejections, e.g. "actuator travel"; several for a check with several causes.
  virtual std::vector<std::string> reasons() const = 0;
  /// Index into reasons() of the reason that forbids q, or −1.
  virtual int violation(std::span<const double> q) const = 0;
  /// Number of smooth functions of q that are ≥ 0 exactly where it holds; 0 if it seldom forbids what other checks
  /// allow (a singularity). None: it says yes or no alone.
  virtual std::optional<int> margins() const { return std::nullopt; }
  /// These functions at q, in units of the range that each has; false if they have no value there.
  virtual bool margins_at(std::span<const double>, std::span<double>) const { return true; }
  /// Functions that are never negative where it holds, as far as known.
  virtual NecessaryLimits necessary_limits() const { return {}; }
  /// Its values at q.
  virtual void necessary_values(std::span<const double>, std::span<double>) const {}
  /// True if it checks motions, which takes a hundred times as long as checks of one configuration.
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
