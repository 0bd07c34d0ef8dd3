#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "posewright/planning/ascent.hpp"
#include "posewright/planning/configuration_space.hpp"
#include "posewright/proof/harmonic_bound.hpp"
#include "posewright/support/dense.hpp"

namespace posewright {

/// Memory of a judge for its places. One thread's.
class RefutingPlaces {
 public:
  /// @param refutation  null: nothing is kept
  /// @param T  columns × any, of the space's own blocks
  RefutingPlaces(const Refutation* refutation, const HarmonicForm& form, const Eigen::MatrixXd& T)
      : refutation_(refutation),
        form_(form),
        T_(T),
        probe_(refutation != nullptr ? refutation->space.probe() : nullptr),
        block_(refutation != nullptr ? refutation->rows : 1, int(T.rows())) {}

  /// Keeps a place if it is feasible and its own d refutes by more than what is kept.
  /// @param bound  d is not larger: a target that is hidden there counts in it, but not in the place's block
  void look(const std::vector<double>& values, double bound, int function, FoundPlace& refuting) {
    if (refutation_ == nullptr) return;
    const double above = std::max(refutation_->above, refuting.value);
    if (!(bound > above)) return;
    const std::vector<double> q = form_.configuration(values);
    if (!block_.at(*probe_, q)) return;
    const double value = (block_.map() * T_).squaredNorm();
    if (value > above && probe_->feasible(q)) refuting = {value, values, function};
  }

 private:
  const Refutation* refutation_;
  const HarmonicForm& form_;
  const Eigen::MatrixXd& T_;
  std::unique_ptr<ConfigurationSpace::Probe> probe_;
  ProbedBlock block_;
};

}  // namespace posewright
