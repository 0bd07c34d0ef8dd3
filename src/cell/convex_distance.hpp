#pragma once

#include <Eigen/Geometry>

#include "posewright/cell/solid.hpp"

namespace posewright {

/// Distance of two convex bodies, m, and a point of each that are as far apart; 0 where they touch.
struct ConvexDistance {
  double distance;
  Eigen::Vector3d of_a, of_b;
};

/// By the smallest simplex of differences of their points (Gilbert, Johnson & Keerthi 1988): with the shortest vector
/// to each of a simplex' faces, vertices, edges and triangles alike, so that parallel edges and faces need no
/// tolerance. What is returned is the width of a slab between the two, so never more than their distance.
/// @param a, b  box, cylinder, sphere, or the convex hull of a mesh; no half spaces
ConvexDistance convex_distance(const Solid& a, const Eigen::Isometry3d& X_a, const Solid& b,
                               const Eigen::Isometry3d& X_b);

/// Width of the slab across a direction n of any length that parts two convex bodies, m: a lower bound of their
/// distance; negative where they overlap along n.
double width_between(const Solid& a, const Eigen::Isometry3d& X_a, const Solid& b, const Eigen::Isometry3d& X_b,
                     const Eigen::Vector3d& n);

}  // namespace posewright
