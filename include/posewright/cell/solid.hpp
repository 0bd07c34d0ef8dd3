#pragma once

#include <Eigen/Geometry>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "posewright/problem/cell_specs.hpp"

namespace posewright {

/// Triangles with shared vertices, m.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<int, 3>> triangles;
};

/// A shape as the collision library sees it. Immutable, so that threads share one.
class Solid {
 public:
  virtual ~Solid() = default;

  /// Sphere that holds all of it; the radius of a half space is infinite.
  const Eigen::Vector3d& centre() const { return centre_; }
  double radius() const { return radius_; }
  /// Lower bound of the distance of a point (own frame) from it: from a box around it, or exact.
  virtual double at_least(const Eigen::Vector3d& point) const = 0;
  /// True if a point (own frame) is in it or on it; for open meshes false.
  virtual bool holds(const Eigen::Vector3d& point) const = 0;
  /// Points whose convex hull has the solid in it: corners, or vertices of a mesh. Empty for a half space.
  const std::vector<Eigen::Vector3d>& corners() const { return corners_; }
  /// Unit normal of a half space n · p ≤ 0, own frame.
  virtual std::optional<Eigen::Vector3d> plane() const { return std::nullopt; }
  /// Largest direction · p of points p of it, own frame; not of a half space.
  virtual double support(const Eigen::Vector3d& direction) const;
  /// A point of it where that is so large.
  virtual Eigen::Vector3d farthest(const Eigen::Vector3d& direction) const;
  /// A ball that is in the solid's convex hull.
  const Eigen::Vector3d& inner_centre() const { return inner_centre_; }
  double inner_radius() const { return inner_radius_; }

 protected:
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();
  double radius_ = 0.0;
  std::vector<Eigen::Vector3d> corners_;
  Eigen::Vector3d inner_centre_ = Eigen::Vector3d::Zero();
  double inner_radius_ = 0.0;
};

/// Meshes are surfaces; closed ones count as solid. Throws std::invalid_argument if nothing is left of a mesh.
std::shared_ptr<const Solid> make_solid(const ShapeSpec& shape, const TriangleMesh* mesh);

/// Distance between two solids in m, at most `cap`; 0 where they touch or one is in the other.
double distance(const Solid& a, const Eigen::Isometry3d& X_a, const Solid& b, const Eigen::Isometry3d& X_b, double cap);

/// Whether two solids are `clear` (m) apart, and about how far, where boxes and hulls have been asked already. Below
/// `clear`, an upper bound of the distance that is below it too; else a lower bound of at least `clear` and at most
/// `cap`. Meshes take a quarter of the time that their distance takes.
/// @param towards_b  null, or where convex solids that do not meet tell a direction from a to b across what is between
/// them, of any length; others leave it as it is
double clearance_of_faces(const Solid& a, const Eigen::Isometry3d& X_a, const Solid& b, const Eigen::Isometry3d& X_b,
                          double clear, double cap, Eigen::Vector3d* towards_b = nullptr);

/// A point of either solid (m, the frame that the placements are in) where the two are nearest to each other; none
/// where they touch, or where the library's points are not as far apart as its distance.
std::optional<std::array<Eigen::Vector3d, 2>> nearest_points(const Solid& a, const Eigen::Isometry3d& X_a,
                                                             const Solid& b, const Eigen::Isometry3d& X_b);

/// Lower bound of the distance, by boxes and spheres around both; may be negative if they overlap.
double distance_at_least(const Solid& a, const Eigen::Isometry3d& X_a, const Solid& b, const Eigen::Isometry3d& X_b);

/// Lower bound of the distance, at most `cap`: that of the convex hulls of meshes less what its iteration may be off
/// by. A few microseconds, where the meshes themselves take hundreds.
/// @param towards_b  see clearance_of_faces()
double distance_of_hulls(const Solid& a, const Eigen::Isometry3d& X_a, const Solid& b, const Eigen::Isometry3d& X_b,
                         double cap, Eigen::Vector3d* towards_b = nullptr);

/// True if the distance of two solids takes no longer than the distance of their hulls.
bool are_convex(const Solid& a, const Solid& b);

/// True if a solid comes nearer than `radius` to the segment.
bool blocks(const Solid& solid, const Eigen::Isometry3d& X, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
            double radius);

/// Triangles of the convex hull. Throws std::invalid_argument for points in one plane.
TriangleMesh convex_hull(const TriangleMesh& mesh);

}  // namespace posewright
