// Distances by what any two points of two solids prove: no solids are farther apart than two of their points.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "posewright/cell/solid.hpp"
#include "posewright/support/random.hpp"

namespace posewright {
namespace {

using Eigen::Isometry3d, Eigen::Vector3d;

/// A box or a cylinder along z, and its nearest point to any other in closed form.
struct Simple {
  bool round;
  Vector3d half;  // of a cylinder: radius, radius, half length
  std::shared_ptr<const Solid> solid() const {
    if (round) return make_solid(CylinderShape{half.x(), 2 * half.z()}, nullptr);
    return make_solid(BoxShape{2 * half}, nullptr);
  }
  Vector3d nearest(const Isometry3d& X, const Vector3d& p) const {
    Vector3d own = X.inverse() * p;
    const double across = own.head<2>().norm();
    if (round && across > half.x()) own.head<2>() *= half.x() / across;
    return X * own.cwiseMax(-half).cwiseMin(half);
  }
  double support(const Isometry3d& X, const Vector3d& n) const {
    const Vector3d own = X.linear().transpose() * n;
    const double round_part = round ? half.x() * own.head<2>().norm() : half.head<2>().dot(own.head<2>().cwiseAbs());
    return n.dot(X.translation()) + round_part + half.z() * std::abs(own.z());
  }
};

/// Distance of two points of both, and of two planes that keep both apart: what is between them is the distance.
struct Interval {
  double least, most;
};
Interval enclosed(const Simple& a, const Isometry3d& X_a, const Simple& b, const Isometry3d& X_b) {
  Vector3d p = X_a.translation(), q = X_b.translation();
  Interval result{0, 0};
  for (int i = 0; i < 200000; ++i) {
    p = a.nearest(X_a, q);
    q = b.nearest(X_b, p);
    if (i % 50 != 49) continue;
    result.most = (q - p).norm();
    if (result.most < 1e-9) break;
    const Vector3d n = (q - p) / result.most;
    result.least = std::max(result.least, -b.support(X_b, -n) - a.support(X_a, n));
    if (result.most - result.least < 1e-7) break;
  }
  return result;
}

Isometry3d anywhere(Random& random, double spread) {
  Isometry3d X = Isometry3d::Identity();
  X.translation() =
      Vector3d(random.uniform(-spread, spread), random.uniform(-spread, spread), random.uniform(-spread, spread));
  X.linear() = Eigen::Quaterniond(random.normal(), random.normal(), random.normal(), random.normal())
                   .normalized()
                   .toRotationMatrix();
  return X;
}

/// The second body as links of joints with one direction stand to each other: turned about an axis of the first one,
/// every other time in the same plane, and a little out of line.
Isometry3d turned_about_one_axis(Random& random, const Isometry3d& X_a, int i) {
  Isometry3d X = anywhere(random, 1);
  const Vector3d axis = X_a.linear().col(i % 3);
  const Vector3d tilt = Vector3d(random.normal(), random.normal(), random.normal()).normalized();
  X.linear() = Eigen::AngleAxisd(i % 5 < 3 ? 0.0 : std::exp(random.uniform(-25, -5)), tilt) *
               Eigen::AngleAxisd(i % 7 == 0 ? 0.0 : random.uniform(-3.1, 3.1), axis) * X_a.linear();
  if (i % 2 == 1) X.translation() -= axis * axis.dot(X.translation() - X_a.translation());
  return X;
}

void expect_within_bounds(bool a_round, bool b_round, int draws) {
  Random random(5 + int(a_round) + 2 * int(b_round), 0);
  const auto drawn = [&](bool round) {
    const auto size = [&] { return std::exp(random.uniform(std::log(0.02), std::log(0.8))); };
    Simple body{round, {size(), size(), size()}};
    if (round) body.half.y() = body.half.x();
    return body;
  };
  int near = 0, apart = 0;
  for (int i = 0; i < draws; ++i) {
    const Simple a = drawn(a_round), b = drawn(b_round);
    const Isometry3d X_a = i % 4 == 0 ? Isometry3d::Identity() : anywhere(random, 1);
    const Isometry3d X_b = i % 8 == 7 ? anywhere(random, 1) : turned_about_one_axis(random, X_a, i);
    const Interval exact = enclosed(a, X_a, b, X_b);
    const double found = distance(*a.solid(), X_a, *b.solid(), X_b, 10);
    if (exact.most < 1e-6) {
      EXPECT_LT(found, 1e-6) << i;
      continue;
    }
    if (exact.most < 1e-4) continue;
    ++apart;
    near += exact.most < 0.1;
    EXPECT_LE(found, exact.most + 1.1e-5) << i;
    EXPECT_GE(found, exact.least - 1.1e-5) << i;
    EXPECT_LE(distance_of_hulls(*a.solid(), X_a, *b.solid(), X_b, 10), exact.most + 1e-7) << i;
    // A motion asks for little more than its clearance.
    Vector3d towards_b = Vector3d::Zero();
    EXPECT_LE(clearance_of_faces(*a.solid(), X_a, *b.solid(), X_b, 0.03, 0.11, &towards_b), exact.most + 1.1e-5) << i;
    EXPECT_GE(-b.support(X_b, -towards_b) - a.support(X_a, towards_b),
              (std::min(exact.least, 0.11) - 2e-5) * towards_b.norm())
        << i;
    EXPECT_GT(towards_b.norm(), 0) << i;
    const auto points = nearest_points(*a.solid(), X_a, *b.solid(), X_b);
    ASSERT_TRUE(points) << i;
    EXPECT_NEAR(((*points)[0] - (*points)[1]).norm(), found, 2e-5) << i;
  }
  EXPECT_GT(near, draws / 100);
  EXPECT_GT(apart, draws / 2);
}

TEST(ExactDistance, OfBoxesWithEdgesOfOneDirectionIsWhatPointsAndPlanesProve) {
  expect_within_bounds(false, false, 3000);
}

TEST(ExactDistance, OfCylindersAndBoxesIsWhatPointsAndPlanesProve) {
  expect_within_bounds(true, false, 1500);
  expect_within_bounds(false, true, 1500);
  expect_within_bounds(true, true, 1500);
}

/// Boxes given by their triangles: the library iterates for these hulls as it does for boxes.
TEST(ExactDistance, OfBoxesOfTrianglesIsThatOfTheBoxes) {
  Random random(8, 0);
  const auto triangles = [](const Vector3d& half) {
    TriangleMesh corners;
    for (int k = 0; k < 8; ++k)
      corners.vertices.push_back(half.cwiseProduct(Vector3d(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1)));
    corners.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                         {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return make_solid(MeshShape{}, &corners);
  };
  for (int i = 0; i < 1000; ++i) {
    const Simple a{false, {0.7, 0.12, 0.15}}, b{false, {0.45, 0.15, random.uniform(0.02, 0.3)}};
    const Isometry3d X_a = anywhere(random, 1), X_b = turned_about_one_axis(random, X_a, i);
    const Interval exact = enclosed(a, X_a, b, X_b);
    EXPECT_LE(distance(*triangles(a.half), X_a, *triangles(b.half), X_b, 10), exact.most + 1.1e-5) << i;
    EXPECT_GE(distance(*triangles(a.half), X_a, *triangles(b.half), X_b, 10), exact.least - 1.1e-5) << i;
  }
}

/// Two boxes as one mesh, which is not convex: a round body beside it is asked for the distance of each triangle.
TEST(ExactDistance, OfAMeshOfTwoBoxesIsThatOfTheNearerOne) {
  Random random(9, 0);
  TriangleMesh both;
  const Simple one{false, {0.5, 0.1, 0.15}}, other{false, {0.1, 0.1, 0.4}};
  const Vector3d there(0.4, 0.05, 0.5);
  for (const auto& [half, centre] : {std::pair(one.half, Vector3d(0, 0, 0)), std::pair(other.half, there)}) {
    const int first = int(both.vertices.size());
    for (int k = 0; k < 8; ++k)
      both.vertices.push_back(centre + half.cwiseProduct(Vector3d(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1)));
    for (const std::array<int, 3>& t : {std::array{0, 2, 1},
                                        {1, 2, 3},
                                        {4, 5, 6},
                                        {5, 7, 6},
                                        {0, 1, 4},
                                        {1, 5, 4},
                                        {2, 6, 3},
                                        {3, 6, 7},
                                        {0, 4, 2},
                                        {2, 4, 6},
                                        {1, 3, 5},
                                        {3, 7, 5}})
      both.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  const auto solid = make_solid(MeshShape{}, &both);
  int apart = 0;
  for (int i = 0; i < 1500; ++i) {
    const double r = random.uniform(0.02, 0.2);
    const Simple body{i % 3 > 0, {r, r, random.uniform(0.02, 0.5)}};
    const Isometry3d X = i % 4 == 0 ? Isometry3d::Identity() : anywhere(random, 1);
    const Isometry3d Y = i % 8 == 7 ? anywhere(random, 1) : turned_about_one_axis(random, X, i);
    const Interval a = enclosed(one, X, body, Y), b = enclosed(other, X * Eigen::Translation3d(there), body, Y);
    if (std::min(a.most, b.most) < 1e-4) continue;
    ++apart;
    for (const double found : {distance(*solid, X, *body.solid(), Y, 10), distance(*body.solid(), Y, *solid, X, 10)}) {
      EXPECT_LE(found, std::min(a.most, b.most) + 1.1e-5) << i;
      EXPECT_GE(found, std::min(a.least, b.least) - 1.1e-5) << i;
    }
  }
  EXPECT_GT(apart, 800);
}

}  // namespace
}  // namespace posewright
