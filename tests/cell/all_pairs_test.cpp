#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "posewright/cell/cell.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/support/random.hpp"
#include "src/cell/scene.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

/// The definition: no two bodies of a pair nearer than its clearance, every pair asked for its whole distance.
bool collides(const Scene& scene, const std::vector<double>& q, double beside) {
  std::vector<Eigen::Isometry3d> X(std::size_t(scene.frames->count()));
  scene.frames->poses(q, 0, X);
  for (const BodyPair& pair : scene.pairs) {
    const Body &a = scene.bodies[std::size_t(pair.a)], &b = scene.bodies[std::size_t(pair.b)];
    const double d = distance(*a.solid, X[std::size_t(a.frame)] * a.X_FrameBody, *b.solid,
                              X[std::size_t(b.frame)] * b.X_FrameBody, 100);
    if (d < pair.clearance + beside) return true;
  }
  return false;
}

/// What tables say of a pair is less than what it has, and they do say something.
void expect_less_than_pairs_have(const Problem& problem) {
  const auto cell = make_cell(problem);
  const Scene& scene = cell->collision->scene();
  Random random(11, 0);
  std::vector<Eigen::Isometry3d> X(std::size_t(scene.frames->count()));
  std::vector<double> q;
  int told = 0, tables = 0;
  for (int i = 0; i < 200; ++i) {
    q.clear();
    for (const Coordinate& c : cell->model->coordinates()) q.push_back(random.uniform(c.lower, c.upper));
    scene.frames->poses(q, 0, X);
    for (const BodyPair& pair : scene.pairs) {
      if (pair.table == nullptr) continue;
      ++tables;
      const double least = pair.table->spare_at_least(scene, pair, q, 0.0);
      if (least < 0) continue;
      ++told;
      const Body &a = scene.bodies[std::size_t(pair.a)], &b = scene.bodies[std::size_t(pair.b)];
      const double d = distance(*a.solid, X[std::size_t(a.frame)] * a.X_FrameBody, *b.solid,
                                X[std::size_t(b.frame)] * b.X_FrameBody, pair.clearance + least + 0.01);
      EXPECT_GT(d - pair.clearance, least - 1e-5) << a.name << " and " << b.name;
    }
  }
  EXPECT_GT(told, tables / 4);
}

/// @param steps  states looked at after each draw, nearer and nearer to each other as those of a search are
void expect_the_definition(const Problem& problem, int draws, int steps = 0) {
  const auto cell = make_cell(problem);
  const Collision& collision = *cell->collision;
  Random random(7, 0);
  int free = 0, hit = 0;
  std::vector<double> q;
  for (int i = 0; i < draws * (1 + steps); ++i) {
    const bool fresh = i % (1 + steps) == 0;
    const double step = std::pow(0.5, i % (1 + steps));
    if (fresh) q.clear();
    for (std::size_t k = 0; k < cell->model->coordinates().size(); ++k) {
      const Coordinate& c = cell->model->coordinates()[k];
      if (fresh) q.push_back(c.discrete() ? c.values.front() : random.uniform(c.lower, c.upper));
      else if (!c.discrete()) q[k] = std::clamp(q[k] + random.uniform(-step, step), c.lower, c.upper);
    }
    const bool found = collision.violation(q) >= 0;
    // Where the distance is within the accuracy of its iteration from the clearance, either answer holds.
    if (found) EXPECT_TRUE(collides(collision.scene(), q, 1e-5)) << i;
    else EXPECT_FALSE(collides(collision.scene(), q, -1e-5)) << i;
    (found ? hit : free) += 1;
  }
  EXPECT_GT(free, draws * (1 + steps) / 20);
  EXPECT_GT(hit, draws * (1 + steps) / 20);
}

/// Distances of all pairs from one configuration to another change by no more than BodyPair::approach says.
void expect_slow_distances(const Problem& problem, int draws) {
  const auto cell = make_cell(problem);
  const Scene& scene = cell->collision->scene();
  const std::vector<Coordinate>& coordinates = cell->model->coordinates();
  Random random(13, 0);
  std::vector<Eigen::Isometry3d> X(std::size_t(scene.frames->count())), Y = X;
  int shorter = 0;
  double most = 0;
  for (int i = 0; i < draws; ++i) {
    // One coordinate by as little as a bound for it can be told from, or all of them.
    std::vector<double> q, r;
    for (const Coordinate& c : coordinates)
      q.push_back(c.discrete() ? c.values.front() : random.uniform(c.lower, c.upper));
    r = q;
    const int one = i % 4 == 0 ? -1 : random.index(int(q.size()));
    const double share = one < 0 ? random.uniform(0.01, 1) : 0.02;
    for (std::size_t k = 0; k < q.size(); ++k)
      if (const Coordinate& c = coordinates[k]; !c.discrete() && (one < 0 || one == int(k)))
        r[k] += share * (random.uniform(c.lower, c.upper) - q[k]);
    scene.frames->poses(q, 0, X);
    scene.frames->poses(r, 0, Y);
    for (const BodyPair& pair : scene.pairs) {
      const Body &a = scene.bodies[std::size_t(pair.a)], &b = scene.bodies[std::size_t(pair.b)];
      const auto apart = [&](const auto& Z) {
        return distance(*a.solid, Z[std::size_t(a.frame)] * a.X_FrameBody, *b.solid,
                        Z[std::size_t(b.frame)] * b.X_FrameBody, 10);
      };
      double allowed = 0, by_points = 0;
      for (std::size_t k = 0; k < q.size(); ++k) {
        const double change = std::abs(r[k] - q[k]);
        allowed += change > 0 ? pair.approach.front()[Eigen::Index(k)] * change : 0.0;
        by_points += change > 0 ? pair.travel.front()[Eigen::Index(k)] * change : 0.0;
      }
      const double changed = std::abs(apart(X) - apart(Y));
      EXPECT_LE(changed, allowed + 2e-5) << a.name << " and " << b.name << ", coordinate " << one;
      shorter += allowed < 0.5 * by_points;
      if (one >= 0 && allowed > 1e-3) most = std::max(most, changed / allowed);
    }
  }
  EXPECT_GT(shorter, draws / 10);
  EXPECT_GT(most, 0.5);
}

/// What links have at most between them, and which of them always touch, by distances at all of a thousand states.
void expect_room_by_definition(const Problem& problem) {
  const auto cell = make_cell(problem);
  const Scene& scene = cell->collision->scene();
  Random random(271828, 0);
  std::vector<Eigen::Isometry3d> X(std::size_t(scene.frames->count()));
  std::vector<double> largest(scene.pairs.size(), 0.0), q;
  for (int i = 0; i < 1000; ++i) {
    q.clear();
    for (const Coordinate& c : cell->model->coordinates())
      q.push_back(c.discrete() ? c.values.front() : c.lower + random.uniform() * (c.upper - c.lower));
    scene.frames->poses(q, 0, X);
    for (std::size_t p = 0; p < scene.pairs.size(); ++p) {
      const Body &a = scene.bodies[std::size_t(scene.pairs[p].a)], &b = scene.bodies[std::size_t(scene.pairs[p].b)];
      if (std::isfinite(scene.pairs[p].room))
        largest[p] = std::max(largest[p], distance(*a.solid, X[std::size_t(a.frame)] * a.X_FrameBody, *b.solid,
                                                   X[std::size_t(b.frame)] * b.X_FrameBody, 1));
    }
  }
  int close = 0;
  for (std::size_t p = 0; p < scene.pairs.size(); ++p) {
    const BodyPair& pair = scene.pairs[p];
    if (!std::isfinite(pair.room)) continue;
    ++close;
    EXPECT_NEAR(pair.room, std::max(0.0, largest[p] - pair.clearance), 1e-9);
  }
  EXPECT_GT(close, 0);
  EXPECT_EQ(scene.reduced.empty(), false);
}

TEST(Collision, RoomOfAVendorsLinksIsTheLargestOfAllStates) {
  const std::filesystem::path robots = std::filesystem::path(POSEWRIGHT_SHARED_DIR) / "robots";
  if (!std::filesystem::exists(robots)) GTEST_SKIP() << "the folder of shared robots is absent";
  const TemporaryFolder folder;
  expect_room_by_definition(read_problem(folder.write(
      "p.yaml",
      "posewright: 1\nrobot: {urdf: " +
          (robots / "ur10/example-robot-data/robots/ur_description/urdf/ur10_robot.urdf").string() +
          ", tip: tool0}\nmeasurement: {type: position, target: [0.1, 0, 0], device: {type: isotropic, noise: "
          "0.1 mm}}\nvariants: {all: {parameters: auto}}\nworkspace: {collision: {clearance: 30 mm}}\n")));
}

TEST(Collision, DistancesChangeNoFasterThanEitherBodySeesTheOther) {
  expect_slow_distances(read_problem(POSEWRIGHT_SOURCE_DIR "/examples/cell/problem.yaml"), 1500);
  expect_slow_distances(read_problem(POSEWRIGHT_SOURCE_DIR "/examples/humanoid/both_hands.yaml"), 400);
}

TEST(Collision, OfTheExampleCellIsThatOfAllItsPairs) {
  expect_the_definition(read_problem(POSEWRIGHT_SOURCE_DIR "/examples/cell/problem.yaml"), 4000);
}

TEST(Collision, OfAWalkThatSlowsDownIsThatOfAllPairsAtEveryStep) {
  expect_the_definition(read_problem(POSEWRIGHT_SOURCE_DIR "/examples/cell/problem.yaml"), 300, 14);
}

TEST(Collision, OfAVendorsMeshesIsThatOfAllTheirPairs) {
  const std::filesystem::path robots = std::filesystem::path(POSEWRIGHT_SHARED_DIR) / "robots";
  if (!std::filesystem::exists(robots)) GTEST_SKIP() << "the folder of shared robots is absent";
  const TemporaryFolder folder;
  const auto problem = [&](const std::string& urdf, const std::string& tool) {
    return read_problem(folder.write(
        "p.yaml",
        "posewright: 1\nrobot: {urdf: " + (robots / urdf).string() +
            ", tip: tool0}\nmeasurement: {type: position, target: [0.1, 0, 0], device: {type: isotropic, noise: "
            "0.1 mm}}\nvariants: {all: {parameters: auto}}\nworkspace:\n  collision: {clearance: 30 mm, tool: "
            "[{name: plate, box: " +
            tool + "}], obstacles: [{name: floor, plane: [0, 0, 1], at: [0, 0, -0.01]}, {name: table, box: " +
            "[1.2, 0.8, 0.7], at: [1.9, 0.3, 0.35]}, {name: post, cylinder: {radius: 0.08, length: 2.5}, at: " +
            "[0.6, 0.6, 1.25]}]}\n"));
  };
  expect_less_than_pairs_have(problem("ur10/example-robot-data/robots/ur_description/urdf/ur10_robot.urdf",
                                      "[0.1, 0.05, 0.04], at: [0, 0.06, 0]"));
  expect_the_definition(
      problem("kuka_kr300_r2700_2/kuka_quantec_support/urdf/kr300_r2700_2.urdf", "[0.3, 0.3, 0.03], at: [0, 0, 0.03]"),
      30, 9);
  expect_the_definition(problem("ur10/example-robot-data/robots/ur_description/urdf/ur10_robot.urdf",
                                "[0.1, 0.05, 0.04], at: [0, 0.06, 0]"),
                        150);
}

}  // namespace
}  // namespace posewright
