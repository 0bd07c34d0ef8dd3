#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "posewright/blocks/block_array.hpp"
#include "posewright/cell/necessary_limits.hpp"
#include "posewright/model/harmonic_parts.hpp"
#include "posewright/proof/harmonic_function.hpp"

namespace posewright {

/// Bound of the sensitivity of a space over boxes of its axes (theory.md eq. (39)):
///   d(q) = ‖J(q) T‖² ≤ Σ_k s_k(r_k) ‖B_k T‖²   for every T,
/// B_k polynomials in the cosines and sines of the axes and in numbers that follow from an axis. Discrete axes have one
/// value in a form; a space with choices has a form for each.
class HarmonicForm {
 public:
  /// Evaluations of one thread.
  class Evaluator {
   public:
    virtual ~Evaluator() = default;
    /// Rows of all parts, one part after the other, in the task's coordinates. False if q has none.
    virtual bool rows(std::span<const double> values, BlockArray::RowMatrix& B) = 0;
    /// Squares of the distances that factors depend on, m².
    virtual void distances(std::span<const double> values, std::span<double> squares) = 0;
    /// Terms of the form's limits: as many as limits().values.
    virtual void limit_values(std::span<const double>, std::span<double>) {}
    /// All values at the moving axes, then those of following axes: the meaning of a configuration.
    virtual void complete(std::span<double> values) const = 0;
  };

  virtual ~HarmonicForm() = default;
  /// The space's continuous axes that move, then those that follow one of them or have any phase.
  const std::vector<HarmonicAxis>& axes() const { return axes_; }
  const std::vector<HarmonicPart>& parts() const { return parts_; }
  /// Degree of the part's entries along an axis.
  const std::vector<std::vector<int>>& degrees() const { return degrees_; }
  const std::vector<std::vector<int>>& distance_degrees() const { return distance_degrees_; }
  /// Largest deviation of each squared distance from the mean of all; empty: not known.
  const std::vector<DistanceSpread>& spreads() const { return spreads_; }
  /// Functions that are never negative at feasible configurations; factors of coordinates are of the axes that move.
  const NecessaryLimits& limits() const { return limits_; }
  /// Checks the values of limits along an axis.
  const std::vector<int>& limit_degrees() const { return limit_degrees_; }
  int columns() const { return columns_; }
  virtual std::unique_ptr<Evaluator> evaluator() const = 0;
  /// The space's configuration at values of the axes.
  virtual std::vector<double> configuration(std::span<const double> values) const = 0;
  /// Its inverse: values of the axes at a configuration, whatever its discrete axes are.
  virtual std::vector<double> values(std::span<const double> q) const = 0;

 protected:
  std::vector<HarmonicAxis> axes_;
  std::vector<HarmonicPart> parts_;
  std::vector<std::vector<int>> degrees_, distance_degrees_;
  std::vector<DistanceSpread> spreads_;
  NecessaryLimits limits_;
  std::vector<int> limit_degrees_;
  int columns_ = 0;
};

/// One for each choice of the discrete axes, or why there is none.
struct HarmonicForms {
  std::string why_not;  ///< for messages; empty: d is bounded
  std::vector<std::unique_ptr<HarmonicForm>> forms;
};

}  // namespace posewright
