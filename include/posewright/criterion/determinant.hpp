#pragma once

#include <string>
#include <utility>

#include "posewright/criterion/criterion.hpp"

namespace posewright {

/// `o1`, D-optimality: Φ = log det of the information of the interest parameters, i.e. of the Schur complement
/// S = M_ii − M_in M_nn⁻¹ M_ni where there are nuisance columns: log det S = log det M − log det M_nn.
/// Borm & Menq (1991), Int. J. Robotics Research 10(1); Fedorov (1972), ch. 3, for the exchange.
class DeterminantCriterion : public Criterion {
 public:
  /// @param name  what users call it: o1, or ds where the elimination is meant to show
  explicit DeterminantCriterion(std::string name = "o1") : name_(std::move(name)) {}
  std::string name() const override { return name_; }
  std::unique_ptr<DesignState> start(const CandidateView& view, std::vector<int> members) const override;

 private:
  std::string name_;
};

}  // namespace posewright
