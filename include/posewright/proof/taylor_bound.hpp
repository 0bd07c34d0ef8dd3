#pragma once

#include <Eigen/Core>
#include <mutex>
#include <vector>

#include "posewright/planning/workspace_bound.hpp"
#include "posewright/proof/bounded_space.hpp"
#include "posewright/proof/box_search.hpp"

namespace posewright {

/// Middles of the boxes whose bound exceeds a number, in any order; actuators may not reach them.
struct SeenAbove {
  double limit = 0.0;
  std::mutex mutex{};
  std::vector<std::vector<double>> middles{};
};

/// Largest d(q) = ‖J(q) T‖² over the space's continuous axes, as far as its actuators move, by Taylor models on boxes
/// (theory.md eq. (42), (43)). On each box d = p ± r and what is not negative at feasible configurations, c_i = p_i ±
/// r_i, are enclosed. What the c_i rule out is cut off the box; of the rest d ≤ d + Σ λ_i c_i for any λ ≥ 0, and the
/// largest Bernstein coefficient of the polynomial's, with the radii, bounds that. λ makes up for the slope of d across
/// the limits, so that the bound is of second order at a largest value on a limit, too.
/// @param space  one with an enclosure
/// Stops as largest_value() of boxes; a bound of −∞: no configuration is feasible.
/// @param seen  null: none are kept
BoxSearchResult largest_enclosed(const BoundedSpace& space, const Eigen::MatrixXd& T, const BoxSearchOptions& options,
                                 const Monitor& monitor, SeenAbove* seen = nullptr);

/// Middles of boxes in which ‖J(q) T‖² may exceed a limit, as further starts of searches; empty: the space encloses
/// nothing.
WorkspaceBoundOptions::FurtherStarts middles_of_uncut_boxes(const ConfigurationSpace& space, int columns,
                                                            const WorkspaceBoundOptions& options);

}  // namespace posewright
