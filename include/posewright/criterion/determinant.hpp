#pragma once

#include "posewright/criterion/criterion.hpp"

namespace posewright {

/// `o1`, D-optimality: Φ = log det of the information of the interest parameters, i.e. of the Schur complement
/// S = M_ii − M_in M_nn⁻¹ M_ni where there are nuisance columns: log det S = log det M − log det M_nn.
/// Borm & Menq (1991), Int. J. Robotics Research 10(1); Fedorov (1972), ch. 3, for the exchange.
class DeterminantCriterion : public Criterion {
 public:
  std::string name() const override { return "o1"; }
  std::unique_ptr<DesignState> start(const CandidateView& view, std::vector<int> members) const override;
};

}  // namespace posewright
