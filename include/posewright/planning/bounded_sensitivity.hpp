#pragma once

#include <memory>
#include <vector>

#include "posewright/planning/box_search.hpp"
#include "posewright/planning/harmonic_form.hpp"

namespace posewright {

class ConfigurationSpace;

/// Degrees of each function along every axis.
using HarmonicDegrees = std::vector<std::vector<int>>;

/// Counterexamples of a proof: feasible configurations whose own d = ‖J T‖² is above a limit.
struct Refutation {
  const ConfigurationSpace& space;
  int rows = 0;  ///< of a block
  double above = 0.0;
};

/// A sensitivity of which boxes can be judged, over the axes of a form.
class BoundedSensitivity {
 public:
  virtual ~BoundedSensitivity() = default;
  virtual const HarmonicForm& form() const = 0;
  /// False if a value was not finite, or something is no polynomial of the stated degrees at random places.
  virtual bool defined() const = 0;
  virtual std::vector<SearchBox> first_boxes() const = 0;
  /// @param refutation  places that it keeps as LargestFound::refuting; null: none
  virtual std::unique_ptr<BoxJudge> judge(const Refutation* refutation = nullptr) const = 0;
  /// Coefficients of the tensor that a box is bounded by.
  virtual double size() const = 0;
  /// Cost of a box, in coefficients of an existing tensor.
  virtual double work() const = 0;
};

/// Largest value of several, each over its own axes.
BoxSearchResult largest_value(const std::vector<std::unique_ptr<BoundedSensitivity>>& functions,
                              const BoxSearchOptions& options, const Monitor& monitor,
                              const Refutation* refutation = nullptr);

}  // namespace posewright
