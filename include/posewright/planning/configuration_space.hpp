#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "posewright/blocks/block_array.hpp"
#include "posewright/criterion/spacing.hpp"

namespace posewright {

/// Source of candidates: the feasible set and the block of any configuration in it. Planners that look beyond the
/// candidates see this and nothing of robots.
class ConfigurationSpace {
 public:
  struct Axis {
    double lower = 0.0, upper = 0.0;
    bool continuous = true;         ///< false: a choice; keeps the value that a start has
    bool turns = false;             ///< an angle, rad
    std::vector<double> choices{};  ///< of a choice: its values
  };
  /// Evaluations of one thread.
  class Probe {
   public:
    virtual ~Probe() = default;
    virtual bool feasible(std::span<const double> q) = 0;
    /// Reason that forbids q, for messages; empty: q is feasible.
    virtual std::string forbidden_by(std::span<const double> q) { return feasible(q) ? "" : "something"; }
    /// True if the quick checks allow q, as wherever feasible() is true. For searches that end elsewhere.
    virtual bool perhaps_feasible(std::span<const double> q) { return feasible(q); }
    /// Writes the block in the task's coordinates (whitened as the candidates are), rows `stride` doubles apart. False
    /// if q has none.
    virtual bool block(std::span<const double> q, double* rows, int stride) = 0;
    /// Smooth margins at q: nowhere feasible where one is negative, and where all are positive at most
    /// something forbids q that is seldom met. False if there are none.
    virtual bool margins(std::span<const double>, std::span<double>) { return false; }
    /// Gradient of a number that depends on q through JᵀJ alone, along each continuous axis.
    /// @param slope  its derivative by J (r × m), J the block as block() writes it at q
    /// @param gradient  size of the axes; undefined for choices
    /// @return false if derivatives are not known here: BlockGradient then takes differences of blocks
    virtual bool gradient(std::span<const double> /*q*/, const BlockArray::RowMatrix& /*slope*/,
                          std::span<double> /*gradient*/) {
      return false;
    }
  };

  virtual ~ConfigurationSpace() = default;
  virtual const std::vector<Axis>& axes() const = 0;
  /// True if every configuration within the axes' limits is feasible.
  virtual bool is_box() const = 0;
  /// Number of smooth functions of q that bound the feasible set within the axes' limits, so that a search may follow
  /// them with a gradient. None: what else bounds it is known as yes or no alone.
  virtual std::optional<int> margins() const { return is_box() ? std::optional(0) : std::nullopt; }
  /// Distance of poses that are not candidates (no points in it): the task's spacing, or, if poses may not
  /// repeat, what counts as a repeat. An empty unit: no distance is kept.
  virtual const Spacing& spacing() const = 0;
  /// Configuration of a candidate of the task.
  virtual std::span<const double> candidate(int index) const = 0;
  virtual std::unique_ptr<Probe> probe() const = 0;
};

}  // namespace posewright
