#include "posewright/cell/solid.hpp"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/detail/traversal/collision_node.h>
#include <fcl/narrowphase/detail/traversal/distance/mesh_distance_traversal_node.h>
#include <fcl/narrowphase/distance.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <stdexcept>
#include <utility>

#include "convex_distance.hpp"
#include "posewright/support/dense.hpp"

/// The only file that knows FCL: its headers are slow to compile.
namespace posewright {
namespace {

using Mesh = fcl::BVHModel<fcl::OBBRSSd>;
using Geometry = fcl::CollisionGeometryd;

// What the iteration for the distance of two hulls may be off by, and more, m.
constexpr double hull_tolerance = 1e-5;
// What a clearance between meshes exceeds the one asked for by may be told smaller by this factor.
constexpr double most_short = 1.6;
// How far a corner may be above a triangle of a mesh that counts as convex, m.
constexpr double flat = 1e-7;

/// @param towards_b  see clearance_of_faces()
double fcl_distance(const Geometry& a, const Eigen::Isometry3d& X_a, const Geometry& b, const Eigen::Isometry3d& X_b,
                    double cap, Eigen::Vector3d* towards_b = nullptr) {
  fcl::DistanceRequestd request(towards_b != nullptr);
  // The default tolerance overestimates distances of curved shapes by up to millimetres.
  request.gjk_solver_type = fcl::GST_LIBCCD;
  request.distance_tolerance = 1e-9;
  // Between a mesh and a sphere that meet, FCL 0.7 leaves the distance uninitialised.
  const std::pair<int, int> type = std::minmax({int(a.getNodeType()), int(b.getNodeType())});
  if (type.first < fcl::GEOM_BOX && type.second == fcl::GEOM_SPHERE) {
    fcl::CollisionRequestd touch;
    fcl::CollisionResultd touching;
    if (fcl::collide(&a, X_a, &b, X_b, touch, touching) > 0) return 0.0;
  }
  // What is farther than `cap` is never looked at.
  fcl::DistanceResultd result(cap);
  fcl::distance(&a, X_a, &b, X_b, request, result);
  if (towards_b != nullptr && result.min_distance > 0 && result.min_distance < cap)
    *towards_b = result.nearest_points[1] - result.nearest_points[0];
  return std::clamp(result.min_distance, 0.0, cap);
}

/// Goes through the boxes of two meshes only as far as it takes to tell whether they are `clear` apart, and then about
/// how far. A box of each is left out where it can be told to be far enough.
class ClearanceNode : public fcl::detail::MeshDistanceTraversalNodeOBBRSSd {
 public:
  ClearanceNode(double clear, double cap) : clear_(clear), cap_(cap) {}

  bool canStop(double least) const override {
    const double found = result->min_distance;
    if (found < clear_ || least >= std::min(cap_, found)) return true;
    if ((least - clear_) * most_short < found - clear_) return false;
    left_out_ = std::min(left_out_, least);
    return true;
  }
  double left_out() const { return left_out_; }

 private:
  double clear_, cap_;
  mutable double left_out_ = std::numeric_limits<double>::infinity();
};

/// See clearance_of_faces().
double fcl_clearance(const Mesh& a, const Eigen::Isometry3d& X_a, const Mesh& b, const Eigen::Isometry3d& X_b,
                     double clear, double cap) {
  const fcl::DistanceRequestd request(false);
  fcl::DistanceResultd result(clear + most_short * (cap - clear));
  ClearanceNode node(clear, cap);
  fcl::detail::initialize(node, a, X_a, b, X_b, request, result);
  constexpr int depth_first = 2;
  fcl::detail::distance<double>(&node, nullptr, depth_first);
  const double found = std::max(0.0, result.min_distance);
  return found < clear ? found : std::min({found, node.left_out(), cap});
}

/// Nearest points of two shapes that do not meet, as FCL finds them.
std::array<Eigen::Vector3d, 2> fcl_nearest_points(const Geometry& a, const Eigen::Isometry3d& X_a, const Geometry& b,
                                                  const Eigen::Isometry3d& X_b) {
  fcl::DistanceRequestd request(true);
  request.gjk_solver_type = fcl::GST_LIBCCD;
  request.distance_tolerance = 1e-9;
  fcl::DistanceResultd result;
  fcl::distance(&a, X_a, &b, X_b, request, result);
  return {result.nearest_points[0], result.nearest_points[1]};
}

std::shared_ptr<Mesh> surface_of(const std::vector<Eigen::Vector3d>& vertices,
                                 const std::vector<std::array<int, 3>>& triangles) {
  std::vector<fcl::Triangle> own;
  own.reserve(triangles.size());
  for (const auto& t : triangles) own.emplace_back(std::size_t(t[0]), std::size_t(t[1]), std::size_t(t[2]));
  auto model = std::make_shared<Mesh>();
  model->beginModel(int(own.size()), int(vertices.size()));
  model->addSubModel(vertices, own);
  model->endModel();
  model->computeLocalAABB();
  return model;
}

class FclSolid : public Solid {
 public:
  const Geometry& geometry() const { return *geometry_; }
  /// Representation of the solid besides a surface: triangles where all its faces are flat. The distance of two
  /// triangles has a closed form; that of a triangle and a shape needs an iteration, some twenty times as long.
  virtual const Geometry& beside_surface() const { return *geometry_; }
  /// Convex, with the solid in it: of a mesh its hull, else itself. Null for a mesh whose points lie in one plane.
  virtual const Geometry* hull() const { return geometry_.get(); }
  /// True if it is not convex, so its triangles' hull is larger.
  bool is_surface() const { return hull() != geometry_.get(); }
  const Eigen::Vector3d& middle() const { return middle_; }
  const Eigen::Vector3d& half_extent() const { return half_extent_; }
  double at_least(const Eigen::Vector3d& p) const override {
    return ((p - middle_).cwiseAbs() - half_extent_).cwiseMax(0.0).norm();
  }

 protected:
  void put_box_around() {
    Eigen::AlignedBox3d box;
    for (const auto& corner : corners_) box.extend(corner);
    middle_ = box.center();
    half_extent_ = box.sizes() / 2;
  }
  std::shared_ptr<Geometry> geometry_;

 private:
  Eigen::Vector3d middle_, half_extent_;
};

class BoxSolid : public FclSolid {
 public:
  explicit BoxSolid(const BoxShape& box) : half_(box.size / 2) {
    geometry_ = std::make_shared<fcl::Boxd>(box.size);
    radius_ = half_.norm();
    inner_radius_ = half_.minCoeff();
    for (int k = 0; k < 8; ++k)
      corners_.emplace_back((k & 1 ? 1 : -1) * half_.x(), (k & 2 ? 1 : -1) * half_.y(), (k & 4 ? 1 : -1) * half_.z());
    put_box_around();
    // Corners by the bits of their numbers: two triangles on either side of each axis.
    std::vector<std::array<int, 3>> faces;
    for (int axis = 0; axis < 3; ++axis)
      for (const int side : {0, 1 << axis}) {
        const int u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3;
        faces.push_back({side, side + u, side + u + v});
        faces.push_back({side, side + u + v, side + v});
      }
    faces_ = surface_of(corners_, faces);
  }
  const Geometry& beside_surface() const override { return *faces_; }
  bool holds(const Eigen::Vector3d& p) const override { return (p.cwiseAbs() - half_).maxCoeff() <= 0; }

 private:
  Eigen::Vector3d half_;
  std::shared_ptr<const Geometry> faces_;
};

class CylinderSolid : public FclSolid {
 public:
  explicit CylinderSolid(const CylinderShape& c) : r_(c.radius), half_(c.length / 2) {
    geometry_ = std::make_shared<fcl::Cylinderd>(c.radius, c.length);
    radius_ = std::hypot(r_, half_);
    inner_radius_ = std::min(r_, half_);
    for (int k = 0; k < 8; ++k)
      corners_.emplace_back((k & 1 ? 1 : -1) * r_, (k & 2 ? 1 : -1) * r_, (k & 4 ? 1 : -1) * half_);
    put_box_around();
  }
  bool holds(const Eigen::Vector3d& p) const override { return p.head<2>().norm() <= r_ && std::abs(p.z()) <= half_; }
  double support(const Eigen::Vector3d& d) const override { return r_ * d.head<2>().norm() + half_ * std::abs(d.z()); }
  Eigen::Vector3d farthest(const Eigen::Vector3d& d) const override {
    Eigen::Vector3d point(0, 0, d.z() < 0 ? -half_ : half_);
    if (const double across = d.head<2>().norm(); across > 1e-12 * std::abs(d.z()))
      point.head<2>() = r_ / across * d.head<2>();
    return point;
  }

 private:
  double r_, half_;
};

class SphereSolid : public FclSolid {
 public:
  explicit SphereSolid(const SphereShape& s) {
    geometry_ = std::make_shared<fcl::Sphered>(s.radius);
    radius_ = inner_radius_ = s.radius;
    for (int k = 0; k < 8; ++k)
      corners_.push_back(s.radius * Eigen::Vector3d(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1));
    put_box_around();
  }
  bool holds(const Eigen::Vector3d& p) const override { return p.norm() <= radius_; }
  double support(const Eigen::Vector3d& d) const override { return radius_ * d.norm(); }
  Eigen::Vector3d farthest(const Eigen::Vector3d& d) const override { return radius_ * d.normalized(); }
};

/// Half spaces have distances in closed form, and FCL none to meshes.
class HalfSpaceSolid : public Solid {
 public:
  explicit HalfSpaceSolid(const HalfSpaceShape& plane) : normal_(plane.normal) {
    radius_ = std::numeric_limits<double>::infinity();
  }
  bool holds(const Eigen::Vector3d& p) const override { return normal_.dot(p) <= 0; }
  double at_least(const Eigen::Vector3d& p) const override { return std::max(0.0, normal_.dot(p)); }
  std::optional<Eigen::Vector3d> plane() const override { return normal_; }
  const Eigen::Vector3d& normal() const { return normal_; }

 private:
  Eigen::Vector3d normal_;
};

class MeshSolid : public FclSolid {
 public:
  explicit MeshSolid(TriangleMesh mesh) : mesh_(std::move(mesh)) {
    std::erase_if(mesh_.triangles, [&](const auto& t) { return normal_of(t).norm() <= 1e-14; });
    if (mesh_.triangles.empty()) throw std::invalid_argument("no triangle has an area");
    surface_ = surface_of(mesh_.vertices, mesh_.triangles);
    geometry_ = surface_;
    put_hull_around();
    put_box_around();
    Eigen::AlignedBox3d box;
    for (const auto& v : mesh_.vertices) box.extend(v);
    centre_ = box.center();
    for (const auto& v : mesh_.vertices) radius_ = std::max(radius_, (v - centre_).norm());
    closed_ = is_closed();
    find_parts();
    if (closed_ && hull_ != nullptr && is_convex()) geometry_ = hull_;
    else planes_.clear();
  }

  const Geometry& beside_surface() const override { return *surface_; }
  const Geometry* hull() const override { return hull_.get(); }

  /// A point of each part whose triangles hang together: where surfaces do not meet, all of the part is where it is.
  const std::vector<Eigen::Vector3d>& parts() const { return parts_; }

  /// By the solid angle that the triangles span (van Oosterom & Strackee 1983): ±4π inside a closed surface, 0 outside.
  bool holds(const Eigen::Vector3d& p) const override {
    if (!closed_ || (p - centre_).norm() > radius_) return false;
    if (!planes_.empty())
      return std::all_of(planes_.begin(), planes_.end(),
                         [&](const auto& plane) { return plane.signedDistance(p) <= 0; });
    double angle = 0;
    for (const auto& t : mesh_.triangles) {
      const Eigen::Vector3d a = vertex(t[0]) - p, b = vertex(t[1]) - p, c = vertex(t[2]) - p;
      const double la = a.norm(), lb = b.norm(), lc = c.norm();
      angle += 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
    }
    return std::abs(angle) > 6.283185307179586;
  }

 private:
  /// Corners are those of the hull: where a mesh is lowest or farthest, it touches its hull.
  void put_hull_around() {
    TriangleMesh hull;
    try {
      hull = convex_hull(mesh_);
    } catch (const std::invalid_argument&) {
      corners_ = mesh_.vertices;
      inner_centre_ = mean_of_corners();
      return;
    }
    std::vector<int> number(hull.vertices.size(), -1);
    const auto faces = std::make_shared<std::vector<int>>();
    for (const auto& triangle : hull.triangles) {
      faces->push_back(3);
      for (const int v : triangle) {
        if (number[std::size_t(v)] < 0) {
          number[std::size_t(v)] = int(corners_.size());
          corners_.push_back(hull.vertices[std::size_t(v)]);
        }
        faces->push_back(number[std::size_t(v)]);
      }
    }
    hull_ = std::make_shared<fcl::Convexd>(std::make_shared<const std::vector<Eigen::Vector3d>>(corners_),
                                           int(hull.triangles.size()), faces);
    hull_->computeLocalAABB();
    inner_centre_ = mean_of_corners();
    inner_radius_ = std::numeric_limits<double>::infinity();
    for (const auto& t : hull.triangles) {
      const auto corner = [&](std::size_t k) { return hull.vertices[std::size_t(t[k])]; };
      const Eigen::Vector3d normal = (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
      inner_radius_ = std::min(inner_radius_, std::max(0.0, normal.dot(corner(0) - inner_centre_)));
    }
  }
  Eigen::Vector3d mean_of_corners() const {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const auto& corner : corners_) mean += corner / double(corners_.size());
    return mean;
  }
  void find_parts() {
    std::vector<int> parent(mesh_.vertices.size());
    std::iota(parent.begin(), parent.end(), 0);
    const auto root = [&](int v) {
      while (parent[std::size_t(v)] != v) v = parent[std::size_t(v)] = parent[std::size_t(parent[std::size_t(v)])];
      return v;
    };
    for (const auto& t : mesh_.triangles)
      for (const int other : {t[1], t[2]}) parent[std::size_t(root(other))] = root(t[0]);
    std::set<int> known;
    for (const auto& t : mesh_.triangles)
      if (known.insert(root(t[0])).second) parts_.push_back(vertex(t[0]));
  }
  const Eigen::Vector3d& vertex(int i) const { return mesh_.vertices[std::size_t(i)]; }
  Eigen::Vector3d normal_of(const std::array<int, 3>& t) const {
    return (vertex(t[1]) - vertex(t[0])).cross(vertex(t[2]) - vertex(t[0]));
  }
  /// Every edge is passed once in each direction: closed, and all triangles face the same side.
  bool is_closed() const {
    std::map<std::pair<int, int>, int> uses;
    for (const auto& t : mesh_.triangles)
      for (std::size_t k = 0; k < 3; ++k) ++uses[{t[k], t[(k + 1) % 3]}];
    return std::all_of(uses.begin(), uses.end(), [&](const auto& use) {
      const auto back = uses.find({use.first.second, use.first.first});
      return back != uses.end() && back->second == use.second;
    });
  }

  /// True if no corner is above a triangle: such a mesh is its hull, for which a few steps of an iteration do.
  bool is_convex() {
    for (const auto& t : mesh_.triangles) {
      const Eigen::Vector3d normal = normal_of(t).normalized();
      planes_.emplace_back(normal, vertex(t[0]));
      const auto above = [&](const Eigen::Vector3d& corner) { return normal.dot(corner - vertex(t[0])) > flat; };
      if (std::any_of(corners_.begin(), corners_.end(), above)) return false;
    }
    return true;
  }

  TriangleMesh mesh_;
  std::vector<Eigen::Vector3d> parts_;
  std::vector<Eigen::Hyperplane<double, 3>> planes_;  // of the triangles where the mesh is convex, outward
  std::shared_ptr<Geometry> surface_, hull_;
  bool closed_ = false;
};

/// Signed distance of the lowest point of a solid above the plane.
double above(const HalfSpaceSolid& plane, const Eigen::Isometry3d& X_plane, const Solid& solid,
             const Eigen::Isometry3d& X) {
  const Eigen::Vector3d n = X_plane.linear() * plane.normal();
  const double centre = n.dot(X * solid.centre() - X_plane.translation());
  const Eigen::Vector3d along = X.linear().transpose() * n;
  if (dynamic_cast<const SphereSolid*>(&solid) != nullptr) return centre - solid.radius();
  if (dynamic_cast<const CylinderSolid*>(&solid) != nullptr) {
    const Eigen::Vector3d& c = solid.corners().front();
    return centre - along.head<2>().norm() * std::abs(c.x()) - std::abs(along.z() * c.z());
  }
  double lowest = std::numeric_limits<double>::infinity();
  for (const auto& corner : solid.corners()) lowest = std::min(lowest, along.dot(corner - solid.centre()));
  return centre + lowest;
}

/// The point of a solid that is lowest above the plane.
Eigen::Vector3d lowest(const HalfSpaceSolid& plane, const Eigen::Isometry3d& X_plane, const Solid& solid,
                       const Eigen::Isometry3d& X) {
  return X * solid.farthest(-(X.linear().transpose() * (X_plane.linear() * plane.normal())));
}

/// Largest gap between two boxes on the 15 axes where boxes that do not meet can be told apart (Gottschalk, Lin &
/// Manocha 1996): a lower bound of the distance of what is in them.
/// @param g, h  half extents of both
/// @param t     middle of b from that of a, frame a
/// @param R     axes of b, frame a
double gap_between_boxes(const Eigen::Vector3d& g, const Eigen::Vector3d& h, const Eigen::Vector3d& t,
                         const Eigen::Matrix3d& R) {
  const Eigen::Matrix3d size = R.cwiseAbs();
  double gap = std::max((t.cwiseAbs() - g - size * h).maxCoeff(),
                        ((R.transpose() * t).cwiseAbs() - h - size.transpose() * g).maxCoeff());
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const double squared = 1 - R(i, j) * R(i, j);  // of e_i × b_j
      if (squared < 1e-6) continue;
      const int u = (i + 1) % 3, v = (i + 2) % 3, k = (j + 1) % 3, l = (j + 2) % 3;
      const double between = std::abs(t[v] * R(u, j) - t[u] * R(v, j));
      const double reach = g[u] * size(v, j) + g[v] * size(u, j) + h[k] * size(i, l) + h[l] * size(i, k);
      if (between > reach) gap = std::max(gap, (between - reach) / std::sqrt(squared));
    }
  return gap;
}

bool has_surface(const FclSolid& a, const FclSolid& b) { return a.is_surface() || b.is_surface(); }

/// Representations of two solids for their distance.
std::pair<const Geometry*, const Geometry*> geometries(const FclSolid& a, const FclSolid& b) {
  if (has_surface(a, b)) return {&a.beside_surface(), &b.beside_surface()};
  return {&a.geometry(), &b.geometry()};
}

bool within(const Solid& a, const Eigen::Isometry3d& X_a, const Solid& b, const Eigen::Isometry3d& X_b) {
  const Eigen::Isometry3d X_ab = X_a.inverse() * X_b;
  const auto* mesh = dynamic_cast<const MeshSolid*>(&b);
  if (mesh != nullptr && dynamic_cast<const MeshSolid*>(&a) == nullptr)
    return std::any_of(mesh->parts().begin(), mesh->parts().end(), [&](const auto& p) { return a.holds(X_ab * p); });
  const Eigen::Vector3d c = X_ab * b.centre();
  if ((c - a.centre()).norm() > a.radius()) return false;
  // A point that is certainly of b: the middle of a convex shape, a vertex of a mesh.
  return a.holds(mesh != nullptr ? Eigen::Vector3d(X_ab * b.corners().front()) : c);
}

/// Distance of the hulls of two solids. FCL 0.7 states up to half a metre too much for one in ten pairs of boxes with
/// an edge of the same direction, as links of parallel joints have. So its answer counts only where a slab as wide
/// parts the two.
double distance_of_convex(const FclSolid& a, const Eigen::Isometry3d& X_a, const FclSolid& b,
                          const Eigen::Isometry3d& X_b, double cap, Eigen::Vector3d* towards_b) {
  Eigen::Vector3d n = Eigen::Vector3d::Zero();
  const double found =
      std::min(cap, fcl_distance(*a.hull(), X_a, *b.hull(), X_b, std::numeric_limits<double>::max(), &n));
  if (!(found > 0)) return 0.0;
  for (const Eigen::Vector3d& across : {n, Eigen::Vector3d(-n)})
    if (n.norm() > 0 && width_between(a, X_a, b, X_b, across) >= found - hull_tolerance) {
      if (towards_b != nullptr) *towards_b = across;
      return found;
    }
  const ConvexDistance exact = convex_distance(a, X_a, b, X_b);
  if (towards_b != nullptr && exact.distance > 0) *towards_b = exact.of_b - exact.of_a;
  return std::min(cap, exact.distance);
}

/// Distance of two solids whose boxes and hulls have been asked already; see clearance_of_faces().
/// @param clear  none: the distance itself
double distance_of_faces(const Solid& a, const Eigen::Isometry3d& X_a, const Solid& b, const Eigen::Isometry3d& X_b,
                         std::optional<double> clear, double cap, Eigen::Vector3d* towards_b = nullptr) {
  const auto* plane_a = dynamic_cast<const HalfSpaceSolid*>(&a);
  const auto* plane_b = dynamic_cast<const HalfSpaceSolid*>(&b);
  if (plane_a != nullptr && plane_b != nullptr) throw std::invalid_argument("two half spaces have no distance");
  if (plane_a != nullptr && towards_b != nullptr) *towards_b = X_a.linear() * plane_a->normal();
  if (plane_a != nullptr) return std::clamp(above(*plane_a, X_a, b, X_b), 0.0, cap);
  if (plane_b != nullptr) return std::clamp(above(*plane_b, X_b, a, X_a), 0.0, cap);
  const auto &first = static_cast<const FclSolid&>(a), &second = static_cast<const FclSolid&>(b);
  if (!has_surface(first, second)) return distance_of_convex(first, X_a, second, X_b, cap, towards_b);
  const auto [one, other] = geometries(first, second);
  const bool surfaces = one->getObjectType() == fcl::OT_BVH && other->getObjectType() == fcl::OT_BVH;
  const double found = clear && surfaces ? fcl_clearance(static_cast<const Mesh&>(*one), X_a,
                                                         static_cast<const Mesh&>(*other), X_b, *clear, cap)
                                         : fcl_distance(*one, X_a, *other, X_b, cap);
  if (found <= 0) return 0.0;
  // Surfaces that do not meet: one may still be in the other.
  return within(a, X_a, b, X_b) || within(b, X_b, a, X_a) ? 0.0 : found;
}

}  // namespace

std::shared_ptr<const Solid> make_solid(const ShapeSpec& shape, const TriangleMesh* mesh) {
  if (const auto* box = std::get_if<BoxShape>(&shape)) return std::make_shared<BoxSolid>(*box);
  if (const auto* cylinder = std::get_if<CylinderShape>(&shape)) return std::make_shared<CylinderSolid>(*cylinder);
  if (const auto* sphere = std::get_if<SphereShape>(&shape)) return std::make_shared<SphereSolid>(*sphere);
  if (const auto* plane = std::get_if<HalfSpaceShape>(&shape)) return std::make_shared<HalfSpaceSolid>(*plane);
  if (mesh == nullptr) throw std::invalid_argument("a mesh shape needs its triangles");
  return std::make_shared<MeshSolid>(*mesh);
}

double Solid::support(const Eigen::Vector3d& direction) const {
  double most = -std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& corner : corners_) most = std::max(most, direction.dot(corner));
  return most;
}

Eigen::Vector3d Solid::farthest(const Eigen::Vector3d& direction) const {
  return *std::max_element(corners_.begin(), corners_.end(),
                           [&](const auto& p, const auto& q) { return direction.dot(p) < direction.dot(q); });
}

double distance_at_least(const Solid& a, const Eigen::Isometry3d& X_a, const Solid& b, const Eigen::Isometry3d& X_b) {
  const Eigen::Vector3d centre_a = X_a * a.centre(), centre_b = X_b * b.centre();
  const auto seen = [](const Eigen::Isometry3d& X, const Eigen::Vector3d& p) -> Eigen::Vector3d {
    return X.linear().transpose() * (p - X.translation());
  };
  double bound = (centre_a - centre_b).norm() - a.radius() - b.radius();
  if (std::isfinite(b.radius())) bound = std::max(bound, a.at_least(seen(X_a, centre_b)) - b.radius());
  if (std::isfinite(a.radius())) bound = std::max(bound, b.at_least(seen(X_b, centre_a)) - a.radius());
  if (!std::isfinite(a.radius()) || !std::isfinite(b.radius())) return bound;
  const auto &first = static_cast<const FclSolid&>(a), &second = static_cast<const FclSolid&>(b);
  return std::max(bound, gap_between_boxes(first.half_extent(), second.half_extent(),
                                           seen(X_a, X_b * second.middle()) - first.middle(),
                                           X_a.linear().transpose() * X_b.linear()));
}

double distance_of_hulls(const Solid& a, const Eigen::Isometry3d& X_a, const Solid& b, const Eigen::Isometry3d& X_b,
                         double cap, Eigen::Vector3d* towards_b) {
  if (!std::isfinite(a.radius()) || !std::isfinite(b.radius()))
    return distance_of_faces(a, X_a, b, X_b, std::nullopt, cap, towards_b);
  const auto &first = static_cast<const FclSolid&>(a), &second = static_cast<const FclSolid&>(b);
  if (first.hull() == nullptr || second.hull() == nullptr) return 0.0;
  return std::max(0.0, distance_of_convex(first, X_a, second, X_b, cap + hull_tolerance, towards_b) - hull_tolerance);
}

bool are_convex(const Solid& a, const Solid& b) {
  const auto convex = [](const Solid& solid) {
    return solid.plane() || !static_cast<const FclSolid&>(solid).is_surface();
  };
  return convex(a) && convex(b);
}

double distance(const Solid& a, const Eigen::Isometry3d& X_a, const Solid& b, const Eigen::Isometry3d& X_b,
                double cap) {
  if (distance_at_least(a, X_a, b, X_b) >= cap) return cap;
  if (!are_convex(a, b) && distance_of_hulls(a, X_a, b, X_b, cap) >= cap) return cap;
  return distance_of_faces(a, X_a, b, X_b, std::nullopt, cap);
}

double clearance_of_faces(const Solid& a, const Eigen::Isometry3d& X_a, const Solid& b, const Eigen::Isometry3d& X_b,
                          double clear, double cap, Eigen::Vector3d* towards_b) {
  return distance_of_faces(a, X_a, b, X_b, clear, cap, towards_b);
}

std::optional<std::array<Eigen::Vector3d, 2>> nearest_points(const Solid& a, const Eigen::Isometry3d& X_a,
                                                             const Solid& b, const Eigen::Isometry3d& X_b) {
  const double apart = distance(a, X_a, b, X_b, std::numeric_limits<double>::max());
  if (!(apart > 0)) return std::nullopt;
  if (dynamic_cast<const HalfSpaceSolid*>(&b) != nullptr) {
    const auto points = nearest_points(b, X_b, a, X_a);
    return points ? std::optional(std::array<Eigen::Vector3d, 2>{(*points)[1], (*points)[0]}) : std::nullopt;
  }
  std::array<Eigen::Vector3d, 2> points;
  if (const auto* plane = dynamic_cast<const HalfSpaceSolid*>(&a)) {
    points[1] = lowest(*plane, X_a, b, X_b);
    const Eigen::Vector3d n = X_a.linear() * plane->normal();
    points[0] = points[1] - n.dot(points[1] - X_a.translation()) * n;
  } else {
    const auto &first = static_cast<const FclSolid&>(a), &second = static_cast<const FclSolid&>(b);
    if (!has_surface(first, second)) {
      const ConvexDistance exact = convex_distance(a, X_a, b, X_b);
      points = {exact.of_a, exact.of_b};
    } else {
      const auto [one, other] = geometries(first, second);
      points = fcl_nearest_points(*one, X_a, *other, X_b);
    }
  }
  // Of some pairs of shapes FCL 0.7 states other points than those that its distance is between.
  constexpr double same = 1e-5;  // m
  const auto on = [&](const Solid& solid, const Eigen::Isometry3d& X, const Eigen::Vector3d& p) {
    return solid.at_least(X.inverse() * p) < same;
  };
  const auto fit = [&] { return on(a, X_a, points[0]) && on(b, X_b, points[1]); };
  if (!(std::abs((points[0] - points[1]).norm() - apart) < same)) return std::nullopt;
  // Asked for a shape and a mesh, FCL answers for the mesh and the shape.
  if (!fit()) std::swap(points[0], points[1]);
  return fit() ? std::optional(points) : std::nullopt;
}

bool blocks(const Solid& solid, const Eigen::Isometry3d& X, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
            double radius) {
  const Eigen::Vector3d way = to - from;
  const double length = way.norm();
  if (const auto* plane = dynamic_cast<const HalfSpaceSolid*>(&solid)) {
    const Eigen::Vector3d n = X.linear() * plane->normal();
    return std::min(n.dot(from - X.translation()), n.dot(to - X.translation())) < radius;
  }
  // Nearest point of the segment to the sphere around the solid.
  const Eigen::Vector3d c = X * solid.centre();
  const double t = length > 0 ? std::clamp((c - from).dot(way) / (length * length), 0.0, 1.0) : 0.0;
  if ((from + t * way - c).norm() > solid.radius() + radius) return false;
  const auto& body = static_cast<const FclSolid&>(solid);
  Eigen::Isometry3d X_beam = Eigen::Isometry3d::Identity();
  X_beam.translation() = 0.5 * (from + to);
  if (length > 0)
    X_beam.linear() = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), way).toRotationMatrix();
  // A box around the body and the segment, then the body's hull, before its triangles.
  const Eigen::Matrix3d R = X.linear().transpose() * X_beam.linear();
  const Eigen::Vector3d middle = X.linear().transpose() * (X_beam.translation() - X.translation());
  if (gap_between_boxes(body.half_extent(), {0, 0, length / 2}, middle - body.middle(), R) > radius + hull_tolerance)
    return false;
  if (solid.holds(X.inverse() * from)) return true;
  const fcl::Capsuled beam(std::max(radius, 1e-5), std::max(length, 1e-9));
  const Geometry* hull = body.hull();
  if (hull != nullptr && body.is_surface() && fcl_distance(*hull, X, beam, X_beam, 2 * hull_tolerance) > hull_tolerance)
    return false;
  return fcl_distance(body.geometry(), X, beam, X_beam, 1e-6) <= 0;
}

}  // namespace posewright
