#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

namespace posewright {

struct TourOptions {
  bool closed = false;       ///< back to where it began
  std::optional<int> start;  ///< first node; none: any (an open tour begins where that is cheapest)
  std::uint64_t seed = 0;
  bool exact = true;  ///< whether few nodes are solved exactly
  int kicks = 300;    ///< restarts of the local search from a disturbed tour, if it is not solved exactly
};

/// Nodes in the order of the cheapest tour found. Up to `exact_nodes` nodes it is the cheapest there is (dynamic
/// programming, Held & Karp 1962); beyond that Boost.Graph's 2-approximation by a spanning tree is improved by
/// reversing and moving stretches (2-opt, Or-opt) and disturbed by double bridges (Martin, Otto & Felten 1991).
/// @param cost  n × n, symmetric, not negative, finite
std::vector<int> cheapest_tour(const Eigen::MatrixXd& cost, const TourOptions& options);
inline constexpr int exact_nodes = 12;

}  // namespace posewright
