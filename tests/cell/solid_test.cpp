#include "posewright/cell/solid.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "posewright/support/random.hpp"

namespace posewright {
namespace {

using Eigen::Isometry3d, Eigen::Vector3d;
using SolidPointer = std::shared_ptr<const Solid>;

Isometry3d at(double x, double y, double z) {
  Isometry3d X = Isometry3d::Identity();
  X.translation() = Vector3d(x, y, z);
  return X;
}

Isometry3d random_pose(Random& random, double spread) {
  Isometry3d X = at(random.uniform(-spread, spread), random.uniform(-spread, spread), random.uniform(-spread, spread));
  X.linear() = Eigen::Quaterniond(random.normal(), random.normal(), random.normal(), random.normal())
                   .normalized()
                   .toRotationMatrix();
  return X;
}

/// The box as triangles, outward normals.
TriangleMesh box_mesh(const Vector3d& size) {
  TriangleMesh mesh;
  for (int k = 0; k < 8; ++k)
    mesh.vertices.push_back(0.5 * size.cwiseProduct(Vector3d(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1)));
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

SolidPointer box(double x, double y, double z) { return make_solid(BoxShape{{x, y, z}}, nullptr); }
SolidPointer sphere(double r) { return make_solid(SphereShape{r}, nullptr); }
SolidPointer cylinder(double r, double length) { return make_solid(CylinderShape{r, length}, nullptr); }
SolidPointer plane(const Vector3d& normal) { return make_solid(HalfSpaceShape{normal.normalized()}, nullptr); }
SolidPointer mesh(const TriangleMesh& triangles) { return make_solid(MeshShape{}, &triangles); }

std::vector<SolidPointer> one_of_each() {
  return {box(0.4, 0.3, 0.2), sphere(0.2), cylinder(0.15, 0.5), mesh(box_mesh({0.3, 0.5, 0.2}))};
}

TEST(Distance, OfBoxesSpheresAndCylindersIsWhatTheRulerSays) {
  EXPECT_NEAR(distance(*box(1, 1, 1), at(0, 0, 0), *box(1, 1, 1), at(1.7, 0, 0), 5), 0.7, 1e-7);
  EXPECT_NEAR(distance(*box(1, 1, 1), at(0, 0, 0), *box(1, 1, 1), at(2, 2, 0), 5), std::sqrt(2.0), 1e-7);
  EXPECT_NEAR(distance(*sphere(0.5), at(0, 0, 0), *box(1, 1, 1), at(2, 2, 2), 5), 1.5 * std::sqrt(3.0) - 0.5, 1e-7);
  EXPECT_NEAR(distance(*cylinder(0.2, 1), at(0, 0, 0), *sphere(0.1), at(0, 0, 1), 5), 0.4, 1e-7);
  EXPECT_NEAR(distance(*cylinder(0.2, 1), at(0, 0, 0), *sphere(0.1), at(1, 0, 0), 5), 0.7, 1e-7);
  EXPECT_EQ(distance(*box(1, 1, 1), at(0, 0, 0), *box(1, 1, 1), at(0.9, 0, 0), 5), 0.0);
}

TEST(Distance, OfEverySolidFromAPlaneIsThatOfItsLowestPoint) {
  const SolidPointer floor = plane({0, 0, 1});
  Random random(1, 0);
  for (int i = 0; i < 200; ++i) {
    const Isometry3d X = random_pose(random, 1);
    const double z = X.translation().z();
    const Vector3d n = X.linear().transpose() * Vector3d::UnitZ();
    const double of_box = z - 0.5 * Vector3d(0.4, 0.3, 0.2).dot(n.cwiseAbs());
    const double of_cylinder = z - 0.15 * n.head<2>().norm() - 0.25 * std::abs(n.z());
    EXPECT_NEAR(distance(*floor, at(3, 2, 0), *box(0.4, 0.3, 0.2), X, 9), std::max(0.0, of_box), 1e-12);
    EXPECT_NEAR(distance(*mesh(box_mesh({0.4, 0.3, 0.2})), X, *floor, at(3, 2, 0), 9), std::max(0.0, of_box), 1e-12);
    EXPECT_NEAR(distance(*cylinder(0.15, 0.5), X, *floor, at(3, 2, 0), 9), std::max(0.0, of_cylinder), 1e-12);
    EXPECT_NEAR(distance(*sphere(0.2), X, *floor, at(3, 2, 0), 9), std::max(0.0, z - 0.2), 1e-12);
  }
}

TEST(Distance, OfAMeshOfABoxIsThatOfTheBox) {
  Random random(2, 0);
  const Vector3d size(0.3, 0.5, 0.2);
  const SolidPointer exact = box(0.3, 0.5, 0.2), triangles = mesh(box_mesh(size));
  int touching = 0;
  for (const SolidPointer& other : one_of_each())
    for (int i = 0; i < 250; ++i) {
      const Isometry3d X = random_pose(random, 0.5), Y = random_pose(random, 0.5);
      const double by_box = distance(*exact, X, *other, Y, 2), by_mesh = distance(*triangles, X, *other, Y, 2);
      EXPECT_NEAR(by_box, by_mesh, 2e-6);
      EXPECT_EQ(by_box > 0, by_mesh > 0);
      touching += by_box == 0;
    }
  EXPECT_GT(touching, 100);
}

/// Triangles anywhere: open, not convex, some through each other.
TriangleMesh scattered_triangles(Random& random, int count) {
  TriangleMesh scattered;
  for (int i = 0; i < count; ++i) {
    const Vector3d middle(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3));
    for (int k = 0; k < 3; ++k)
      scattered.vertices.push_back(
          middle + Vector3d(random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1)));
    scattered.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return scattered;
}

TEST(Distance, OfAMeshFromABoxIsThatOfItsNearestPoint) {
  constexpr int steps = 40;
  Random random(6, 0);
  int apart = 0;
  for (const Vector3d& size : {Vector3d(0.4, 0.3, 0.2), Vector3d(0.5, 0.3, 1e-4), Vector3d(0.6, 1e-3, 1e-3)})
    for (int i = 0; i < 60; ++i) {
      const TriangleMesh triangles = scattered_triangles(random, 6);
      const Isometry3d X = random_pose(random, 0.4), Y = random_pose(random, 0.4), X_box_mesh = X.inverse() * Y;
      double sampled = 9, spacing = 0;
      for (const auto& t : triangles.triangles) {
        const Vector3d a = triangles.vertices[std::size_t(t[0])], u = triangles.vertices[std::size_t(t[1])] - a,
                       v = triangles.vertices[std::size_t(t[2])] - a;
        spacing = std::max(spacing, (u.norm() + v.norm()) / steps);
        for (int k = 0; k <= steps; ++k)
          for (int l = 0; k + l <= steps; ++l) {
            const Vector3d p = X_box_mesh * Vector3d(a + u * k / steps + v * l / steps);
            sampled = std::min(sampled, (p.cwiseAbs() - size / 2).cwiseMax(0.0).norm());
          }
      }
      const double found = distance(*box(size.x(), size.y(), size.z()), X, *mesh(triangles), Y, 9);
      EXPECT_LE(found, sampled + 1e-9);
      EXPECT_GE(found, sampled - spacing);
      apart += found > 0.02;
    }
  EXPECT_GT(apart, 60);
}

TEST(Distance, IsTheSameFromBothSidesAndCappedAndAboveItsLowerBound) {
  Random random(3, 0);
  for (const SolidPointer& a : one_of_each())
    for (const SolidPointer& b : one_of_each())
      for (int i = 0; i < 50; ++i) {
        const Isometry3d X = random_pose(random, 0.6), Y = random_pose(random, 0.6);
        const double d = distance(*a, X, *b, Y, 5);
        EXPECT_NEAR(d, distance(*b, Y, *a, X, 5), 2e-6);
        EXPECT_NEAR(distance(*a, X, *b, Y, 0.1), std::min(d, 0.1), 2e-6);
        EXPECT_LE(distance_at_least(*a, X, *b, Y), d + 1e-9);
      }
}

TEST(NearestPoints, LieOnEitherSolidAndAreAsFarApartAsTheSolids) {
  Random random(5, 0);
  std::vector<SolidPointer> solids = one_of_each();
  solids.push_back(plane({0, 0, 1}));
  const SolidPointer speck = sphere(1e-6);
  int apart = 0, stated = 0;
  for (const SolidPointer& a : solids)
    for (const SolidPointer& b : solids)
      for (int i = 0; i < 40; ++i) {
        if (a == solids.back() && b == solids.back()) continue;
        const Isometry3d X = random_pose(random, 0.8), Y = random_pose(random, 0.8);
        const double d = distance(*a, X, *b, Y, 9);
        const auto points = nearest_points(*a, X, *b, Y);
        EXPECT_FALSE(d == 0 && points.has_value());
        apart += d > 0;
        if (!points) continue;
        ++stated;
        const Vector3d &p = (*points)[0], &q = (*points)[1];
        EXPECT_NEAR((p - q).norm(), d, 1e-5);
        EXPECT_LT(distance(*a, X, *speck, at(p.x(), p.y(), p.z()), 1), 1.1e-5);
        EXPECT_LT(distance(*b, Y, *speck, at(q.x(), q.y(), q.z()), 1), 1.1e-5);
      }
  EXPECT_GT(stated, 0.85 * apart) << apart << ", of a tenth FCL has no points that its distance is between";
}

TEST(Distance, IsZeroWhereOneSolidIsInAnother) {
  const SolidPointer room = mesh(box_mesh({4, 4, 4}));
  EXPECT_EQ(distance(*room, at(0, 0, 0), *sphere(0.1), at(0.5, 0.5, 0.5), 1), 0.0);
  EXPECT_EQ(distance(*mesh(box_mesh({0.1, 0.1, 0.1})), at(0.5, 0, 0), *room, at(0, 0, 0), 1), 0.0);
  // Of surfaces that are not convex, whichever is asked first.
  TriangleMesh twice = box_mesh({4, 4, 4}), inner = box_mesh({0.1, 0.1, 0.1});
  const TriangleMesh side = box_mesh({0.2, 0.2, 0.2}), grain = box_mesh({0.02, 0.02, 0.02});
  for (auto [whole, part] : {std::pair(&twice, &side), std::pair(&inner, &grain)}) {
    for (const auto& v : part->vertices) whole->vertices.push_back(v + 1.5 * whole->vertices[7]);
    for (const auto& t : part->triangles) whole->triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  }
  const SolidPointer large = mesh(twice), small = mesh(inner);
  ASSERT_FALSE(are_convex(*large, *large) || are_convex(*small, *small));
  for (const SolidPointer& held : {small, box(0.1, 0.2, 0.1), sphere(0.1), cylinder(0.1, 0.3)}) {
    EXPECT_EQ(distance(*large, at(0, 0, 0), *held, at(0.5, 0.3, 0), 1), 0.0);
    EXPECT_EQ(distance(*held, at(0.5, 0.3, 0), *large, at(0, 0, 0), 1), 0.0);
  }
  TriangleMesh open = box_mesh({4, 4, 4});
  open.triangles.pop_back();
  EXPECT_GT(distance(*mesh(open), at(0, 0, 0), *sphere(0.1), at(0.5, 0.5, 0.5), 1), 0.5)
      << "an open surface holds nothing";
}

TEST(Blocks, ABeamExactlyWhereItPassesNearerThanItsRadius) {
  const double r = 0.01;
  for (const double sign : {-1.0, 1.0}) {
    const auto beam = [&](const Solid& solid, double y) {
      return blocks(solid, at(2, 0, 0), {0, sign * y, 0}, {4, sign * y, 0}, r);
    };
    for (const SolidPointer& solid :
         {box(0.2, 0.2, 0.2), sphere(0.1), cylinder(0.1, 0.4), mesh(box_mesh({0.2, 0.2, 0.2}))}) {
      EXPECT_TRUE(beam(*solid, 0.11 - 1e-4));
      EXPECT_FALSE(beam(*solid, 0.11 + 1e-4));
    }
  }
  EXPECT_FALSE(blocks(*box(1, 1, 1), at(3, 0, 0), {0, 0, 0}, {2.4, 0, 0}, r)) << "it ends before";
  EXPECT_TRUE(blocks(*box(1, 1, 1), at(0, 0, 0), {0, 0, 0}, {0.1, 0, 0}, r)) << "it begins inside";
  EXPECT_TRUE(blocks(*plane({0, 0, 1}), at(0, 0, 0), {0, 0, 1}, {5, 0, -0.1}, r));
  EXPECT_FALSE(blocks(*plane({0, 0, 1}), at(0, 0, 0), {0, 0, 1}, {5, 0, 0.1}, r));
}

TEST(Blocks, AndHoldsAreMirrorSymmetric) {
  Random random(4, 0);
  const Eigen::DiagonalMatrix<double, 3> mirror(1, -1, 1);
  for (const SolidPointer& solid : one_of_each())
    for (int i = 0; i < 200; ++i) {
      // All four shapes are their own mirror images, so a mirrored pose is M X M.
      const Isometry3d X = random_pose(random, 0.3);
      Isometry3d Y;
      Y.matrix().setIdentity();
      Y.linear() = mirror * X.linear() * mirror;
      Y.translation() = mirror * X.translation();
      const Vector3d from(-1, random.uniform(-1, 1), random.uniform(-1, 1)),
          to(1, random.uniform(-1, 1), random.uniform(-1, 1));
      EXPECT_EQ(blocks(*solid, X, from, to, 0.005), blocks(*solid, Y, mirror * from, mirror * to, 0.005));
      EXPECT_EQ(solid->holds(X.inverse() * from), solid->holds(Y.inverse() * (mirror * from)));
    }
}

TEST(Mesh, WithoutAreaIsRefusedAndSomeDegenerateTrianglesAreLeftOut) {
  TriangleMesh line;
  line.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  line.triangles = {{0, 1, 2}};
  EXPECT_THROW(mesh(line), std::invalid_argument);
  TriangleMesh good = box_mesh({1, 1, 1});
  good.triangles.push_back({0, 0, 1});
  EXPECT_NEAR(distance(*mesh(good), at(0, 0, 0), *sphere(0.1), at(1, 0, 0), 5), 0.4, 1e-9);
}

/// Two boxes that touch in an L: the inner corner is free of the mesh and inside the hull.
TriangleMesh bracket() {
  TriangleMesh l = box_mesh({2, 0.2, 0.2});
  const TriangleMesh upright = box_mesh({0.2, 2, 0.2});
  for (const auto& v : upright.vertices) l.vertices.push_back(v + Vector3d(-0.9, 0.9, 0));
  for (auto t : upright.triangles) {
    for (int& i : t) i += 8;
    l.triangles.push_back(t);
  }
  return l;
}

TEST(Distance, OfABracketIsThatOfTheNearerOfItsTwoBoxesAndItsHullIsNoFarther) {
  const SolidPointer l = mesh(bracket()), flat = box(2, 0.2, 0.2), upright = box(0.2, 2, 0.2);
  Random random(5, 0);
  int in_the_corner = 0;
  for (const SolidPointer& other : one_of_each())
    for (int i = 0; i < 150; ++i) {
      const Isometry3d X = random_pose(random, 1), Y = random_pose(random, 1);
      const double by_boxes =
          std::min(distance(*flat, X, *other, Y, 3), distance(*upright, X * at(-0.9, 0.9, 0), *other, Y, 3));
      const double d = distance(*l, X, *other, Y, 3), hull = distance_of_hulls(*l, X, *other, Y, 3);
      EXPECT_NEAR(d, by_boxes, 2e-6);
      EXPECT_NEAR(distance(*l, X, *other, Y, 0.1), std::min(0.1, by_boxes), 2e-6);
      EXPECT_LE(hull, d);
      EXPECT_LE(distance_at_least(*l, X, *other, Y), hull + 3e-5);
      in_the_corner += hull == 0 && d > 0.05;
    }
  EXPECT_GT(in_the_corner, 20);
}

TEST(Clearance, OfMeshesHasTheVerdictOfTheirDistanceAndIsALowerBoundNotFarBelowIt) {
  const SolidPointer l = mesh(bracket());
  Random random(12, 0);
  int near = 0, apart = 0;
  for (const SolidPointer& other : {l, box(0.4, 0.3, 0.2), mesh(box_mesh({0.3, 0.5, 0.2}))})
    for (int i = 0; i < 150; ++i) {
      const Isometry3d X = random_pose(random, 1), Y = random_pose(random, 1);
      const double d = distance(*l, X, *other, Y, 3);
      for (const double clear : {0.02, 0.5 * d, d - 1e-6, d + 1e-6, 2 * d + 1e-6})
        for (const double more : {0.0, 0.1, 1.0}) {
          if (clear <= 0) continue;
          const double told = clearance_of_faces(*l, X, *other, Y, clear, clear + more);
          if (d < clear) {
            EXPECT_LT(told, clear);
            EXPECT_GE(told, d - 1e-9);
            ++near;
            continue;
          }
          const double most = std::min(d, clear + more);
          EXPECT_LE(told, most + 1e-9);
          EXPECT_GE(told, clear + (most - clear) / 2 - 1e-9);
          ++apart;
        }
    }
  EXPECT_GT(near, 500);
  EXPECT_GT(apart, 500);
}

TEST(Distance, OfAConvexMeshIsThatOfItsTriangles) {
  Random random(9, 0);
  TriangleMesh points;
  for (int i = 0; i < 300; ++i)
    points.vertices.emplace_back(0.3 * random.normal(), 0.2 * random.normal(), 0.1 * random.normal());
  const TriangleMesh convex = convex_hull(points);
  // A speck in its middle: no longer convex, as far from everything as before.
  TriangleMesh surface = convex;
  const TriangleMesh speck = box_mesh({0.001, 0.001, 0.001});
  surface.vertices.insert(surface.vertices.end(), speck.vertices.begin(), speck.vertices.end());
  for (const auto& t : speck.triangles) surface.triangles.push_back({t[0] + 300, t[1] + 300, t[2] + 300});
  const SolidPointer hull = mesh(convex), triangles = mesh(surface);
  EXPECT_TRUE(are_convex(*hull, *box(1, 1, 1)));
  EXPECT_FALSE(are_convex(*hull, *triangles));
  int touching = 0;
  for (const SolidPointer& other : {hull, box(0.4, 0.3, 0.2), mesh(box_mesh({0.3, 0.5, 0.2}))})
    for (int i = 0; i < 200; ++i) {
      const Isometry3d X = random_pose(random, 0.5), Y = random_pose(random, 0.5);
      const double d = distance(*hull, X, *other, Y, 3);
      EXPECT_NEAR(d, distance(*triangles, X, *other, Y, 3), 1e-6);
      touching += d <= 0;
    }
  EXPECT_GT(touching, 100);
  EXPECT_LT(touching, 500);
  for (int i = 0; i < 300; ++i) {
    const Vector3d p(random.uniform(-1, 1), random.uniform(-0.7, 0.7), random.uniform(-0.4, 0.4));
    EXPECT_EQ(hull->holds(p), triangles->holds(p)) << p.transpose();
  }
}

TEST(ConvexHull, FillsWhatTheMeshLeavesOpen) {
  const TriangleMesh l = bracket();
  EXPECT_GT(distance(*mesh(l), at(0, 0, 0), *sphere(0.01), at(-0.3, 0.4, 0), 1), 0.2);
  EXPECT_EQ(distance(*mesh(convex_hull(l)), at(0, 0, 0), *sphere(0.01), at(-0.3, 0.4, 0), 1), 0.0);
  TriangleMesh flat;
  flat.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  flat.triangles = {{0, 1, 2}, {1, 2, 3}};
  EXPECT_THROW(convex_hull(flat), std::invalid_argument);
}

}  // namespace
}  // namespace posewright
