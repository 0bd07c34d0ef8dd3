#pragma once

#include <span>
#include <vector>

#include "posewright/model/harmonic_parts.hpp"

namespace posewright {

/// Multiplier of a sensitivity before it is bounded, m = constant + slope r̄, r̄ the mean of all squared
/// distances (m²) of a form (theory.md eq. (56)).
struct Multiplier {
  double constant = 1.0, slope = 0.0;
  double value(double mean) const { return constant + slope * mean; }
};

struct Range {
  double lower = 0.0, upper = 0.0;
  double middle() const { return 0.5 * (lower + upper); }
  double half() const { return 0.5 * (upper - lower); }
};

/// Upper bound constant + distance r + difference δ of (plus(r) − minus(r)) m, m at the mean distance r + δ.
struct FactorBound {
  double constant = 0.0, distance = 0.0, difference = 0.0;
  double gap = 0.0;       ///< how far it is above the factor in the middle of both ranges
  bool by_delta = false;  ///< more of the gap comes from the range of δ than from that of r
  double value(double r, double delta) const { return constant + distance * r + difference * delta; }
};

/// Distance in a box: r > 0 and δ in m², and of the multiplier there as a share of that at r.
struct DistanceRanges {
  Range r, delta, ratio{1.0, 1.0};
};

/// Cuts the ranges of δ and of the ratio to what the spread leaves.
void cut_by_spread(DistanceRanges& ranges, const Multiplier& multiplier, const DistanceSpread& spread);

/// Its gap falls with the square of the ranges.
/// @param affine  false: a constant alone, and no multiplier
FactorBound factor_bound(const HarmonicPart& part, const Multiplier& multiplier, const DistanceRanges& ranges,
                         bool affine);

/// The multiplier under which a form's factors are bent least at some places, 1 or one that grows with the distance.
/// @param squares    places × parts, ‖B_k T‖²
/// @param distances  places × distances, squared, m²
Multiplier least_bent(const std::vector<HarmonicPart>& parts, std::span<const std::vector<double>> squares,
                      std::span<const std::vector<double>> distances);

}  // namespace posewright
