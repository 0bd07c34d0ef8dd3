#include "convex_distance.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "posewright/support/dense.hpp"

namespace posewright {
namespace {

constexpr int most_steps = 200;
// How far the shortest vector may exceed the slab, m.
constexpr double close_enough = 1e-9;
// What touches is less apart, m.
constexpr double contact = 1e-10;

/// A point of each body, and the way from one to the other.
struct Corner {
  Eigen::Vector3d of_a, of_b, way;
};

/// Corners of a simplex that its shortest vector rests on, with their shares.
struct Simplex {
  std::array<Corner, 4> corners;
  std::array<double, 4> shares{};
  int count = 0;
  Eigen::Vector3d sum(Eigen::Vector3d Corner::*part) const {
    Eigen::Vector3d total = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < std::size_t(count); ++i) total += shares[i] * (corners[i].*part);
    return total;
  }
};

/// The point of the affine hull of some corners that is nearest to the origin, if it is between them.
bool rests_within(Simplex& face) {
  const Eigen::Vector3d first = face.corners[0].way;
  Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3> edges(3, face.count - 1);
  for (int i = 1; i < face.count; ++i) edges.col(i - 1) = face.corners[std::size_t(i)].way - first;
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1> shares(face.count - 1);
  if (face.count > 1) shares = edges.colPivHouseholderQr().solve(-first);
  face.shares[0] = 1 - shares.sum();
  for (int i = 1; i < face.count; ++i) face.shares[std::size_t(i)] = shares[i - 1];
  return std::all_of(face.shares.begin(), face.shares.begin() + face.count, [](double s) { return s >= 0; });
}

/// The face of a simplex with the shortest vector of all; each is tried.
Simplex shortest_face(const Simplex& whole) {
  Simplex best;
  double least = std::numeric_limits<double>::infinity();
  for (unsigned subset = 1; subset < 1U << whole.count; ++subset) {
    Simplex face;
    for (std::size_t i = 0; i < std::size_t(whole.count); ++i)
      if (subset >> i & 1U) face.corners[std::size_t(face.count++)] = whole.corners[i];
    if (!rests_within(face)) continue;
    const double length = face.sum(&Corner::way).norm();
    if (length < least) {
      least = length;
      best = face;
    }
  }
  return best;
}

Eigen::Vector3d placed_farthest(const Solid& solid, const Eigen::Isometry3d& X, const Eigen::Vector3d& direction) {
  return X * solid.farthest(X.linear().transpose() * direction);
}

Corner corner_towards(const Solid& a, const Eigen::Isometry3d& X_a, const Solid& b, const Eigen::Isometry3d& X_b,
                      const Eigen::Vector3d& n) {
  const Eigen::Vector3d p = placed_farthest(a, X_a, n), q = placed_farthest(b, X_b, -n);
  return {p, q, q - p};
}

}  // namespace

ConvexDistance convex_distance(const Solid& a, const Eigen::Isometry3d& X_a, const Solid& b,
                               const Eigen::Isometry3d& X_b) {
  const Eigen::Vector3d apart = X_b * b.centre() - X_a * a.centre();
  Simplex simplex;
  simplex.corners[0] = corner_towards(a, X_a, b, X_b, apart.norm() > 0 ? apart : Eigen::Vector3d::UnitX().eval());
  simplex.shares[0] = 1;
  simplex.count = 1;
  double width = 0;
  for (int step = 0; step < most_steps; ++step) {
    const Eigen::Vector3d way = simplex.sum(&Corner::way);
    const double length = way.norm();
    if (length < contact) return {0.0, simplex.sum(&Corner::of_a), simplex.sum(&Corner::of_b)};
    const Corner next = corner_towards(a, X_a, b, X_b, way);
    width = std::max(width, next.way.dot(way) / length);
    if (length - width < close_enough || simplex.count == 4) break;
    simplex.corners[std::size_t(simplex.count++)] = next;
    simplex = shortest_face(simplex);
    // Rounding ends it where no corner makes the way shorter.
    if (simplex.sum(&Corner::way).norm() >= length) break;
  }
  return {width, simplex.sum(&Corner::of_a), simplex.sum(&Corner::of_b)};
}

double width_between(const Solid& a, const Eigen::Isometry3d& X_a, const Solid& b, const Eigen::Isometry3d& X_b,
                     const Eigen::Vector3d& n) {
  const double width = n.dot(X_b.translation() - X_a.translation()) - a.support(X_a.linear().transpose() * n) -
                       b.support(-(X_b.linear().transpose() * n));
  return width / n.norm();
}

}  // namespace posewright
