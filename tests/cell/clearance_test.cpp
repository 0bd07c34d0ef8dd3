#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "posewright/cell/cell.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/support/random.hpp"
#include "src/cell/body_frames.hpp"
#include "src/cell/scene.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

using testing::HasSubstr;

/// Three links in a row that turn about z, y, z; a hand in front of the last one.
const char* const bent = R"(<robot name="bent">
  <link name="base"><collision><geometry><cylinder radius="0.15" length="0.2"/></geometry></collision></link>
  <link name="upper"><collision><origin xyz="0.4 0 0.3"/><geometry><box size="0.6 0.1 0.1"/></geometry></collision></link>
  <link name="lower"><collision><origin xyz="0.4 0 0"/><geometry><box size="0.6 0.1 0.1"/></geometry></collision></link>
  <link name="wrist"><collision><geometry><cylinder radius="0.04" length="0.06"/></geometry></collision></link>
  <joint name="j1" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
  <joint name="j2" type="revolute"><parent link="upper"/><child link="lower"/><origin xyz="0.8 0 0.3"/><axis xyz="0 1 0"/>
    <limit lower="-2.9" upper="2.9" effort="1" velocity="1"/></joint>
  <joint name="j3" type="revolute"><parent link="lower"/><child link="wrist"/><origin xyz="0.75 0 0"/><axis xyz="0 0 1"/>
    <limit lower="-0.1" upper="0.1" effort="1" velocity="1"/></joint>
</robot>)";

std::shared_ptr<const Cell> cell_with(const std::string& collision) {
  const TemporaryFolder folder;
  folder.write("arm.urdf", bent);
  return make_cell(read_problem(
      folder.write("p.yaml",
                   "posewright: 1\nrobot: {urdf: arm.urdf, tip: wrist}\n"
                   "measurement: {type: position, target: [0.1, 0, 0], device: {type: isotropic, noise: 0.1 mm}}\n"
                   "variants: {all: {parameters: auto}}\nworkspace:\n  collision: {" +
                       collision + "}\n")));
}

// A hand 12 mm from the link before the wrist, whatever the wrist does; the link ends at 0.7, the hand begins at 0.712.
const char* const hand = "tool: [{name: hand, box: [0.2, 0.05, 0.05], at: [0.065, 0, 0]}]";

double asked(const Collision& collision, const std::string& a, const std::string& b) {
  for (const BodyPair& pair : collision.scene().pairs) {
    const std::string& x = collision.scene().bodies[std::size_t(pair.a)].name;
    const std::string& y = collision.scene().bodies[std::size_t(pair.b)].name;
    if ((x == a && y == b) || (x == b && y == a)) return pair.clearance - motion_resolution;
  }
  return -1;
}

TEST(Clearance, IsKeptByTheToolFromTheArmAsFromObstacles) {
  const auto cell = cell_with(std::string("clearance: 40 mm, ") + hand);
  EXPECT_NEAR(asked(*cell->collision, "hand", "base"), 0.04, 1e-12);
  EXPECT_NEAR(asked(*cell->collision, "hand", "upper"), 0.04, 1e-12);
  EXPECT_NEAR(asked(*cell->collision, "base", "lower"), 0, 1e-12) << "links among themselves only must not touch";
}

TEST(Clearance, IsHalfOfWhatThereIsForPairsThatAreNearByDesign) {
  const auto cell = cell_with(std::string("clearance: 40 mm, ") + hand);
  ASSERT_EQ(cell->collision->reduced().size(), 1U);
  const ReducedClearance& pair = cell->collision->reduced().front();
  EXPECT_EQ((std::vector<std::string>{pair.first, pair.second}), (std::vector<std::string>{"hand", "lower"}));
  // 0.75 + 0.065 − 0.1 − 0.7 = 15 mm straight ahead; turned, a corner comes nearer.
  EXPECT_NEAR(pair.clearance, 0.0075, 5e-4);
  EXPECT_NEAR(asked(*cell->collision, "hand", "lower"), pair.clearance, 1e-12);
  const auto near = cell_with("clearance: 40 mm, tool: [{name: hand, box: [0.2, 0.05, 0.05], at: [0.0515, 0, 0]}]");
  EXPECT_NEAR(near->collision->reduced().front().clearance, 0.001, 1e-9) << "1 mm at least";
  EXPECT_TRUE(cell_with(std::string("clearance: 5 mm, ") + hand)->collision->reduced().empty());
}

TEST(Clearance, IsSetForAnyPair) {
  const auto all = cell_with(std::string("clearance: 40 mm, self_clearance: 3 mm, ") + hand);
  for (const char* other : {"base", "upper", "lower"})
    EXPECT_NEAR(asked(*all->collision, "hand", other), 0.003, 1e-12) << other;
  EXPECT_NEAR(asked(*all->collision, "base", "lower"), 0.003, 1e-12);
  const auto one = cell_with(
      std::string("clearance: 40 mm, self_clearance: {pairs: [{between: [base, hand], clearance: 90 mm}]}, ") + hand);
  EXPECT_NEAR(asked(*one->collision, "hand", "base"), 0.09, 1e-12);
  EXPECT_NEAR(asked(*one->collision, "hand", "upper"), 0.04, 1e-12);
  try {
    cell_with(std::string("self_clearance: {pairs: [{between: [base, gun], clearance: 90 mm}]}, ") + hand);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("p.yaml:6: 'gun' is not a link, tool part or obstacle with a shape"));
  }
}

/// The smallest distance of all pairs, by asking for each.
double by_asking(const Collision& collision, const std::vector<double>& q) {
  const Scene& scene = collision.scene();
  std::vector<Eigen::Isometry3d> X(std::size_t(scene.frames->count()));
  scene.frames->poses(q, 0, X);
  double smallest = 1e9;
  for (const BodyPair& pair : scene.pairs) {
    const Body &a = scene.bodies[std::size_t(pair.a)], &b = scene.bodies[std::size_t(pair.b)];
    // Links of the arm only must not touch each other here.
    if (!a.obstacle && !b.obstacle && a.name != "hand" && b.name != "hand") continue;
    smallest = std::min(smallest, distance(*a.solid, X[std::size_t(a.frame)] * a.X_FrameBody, *b.solid,
                                           X[std::size_t(b.frame)] * b.X_FrameBody, 100));
  }
  return smallest;
}

TEST(Clearance, ThatIsStatedIsTheSmallestDistanceOfAnyPair) {
  const auto cell =
      cell_with(std::string("clearance: 5 mm, obstacles: [{name: wall, plane: [-1, 0, 0], at: [1.7, 0, 0]}, "
                            "{name: ball, sphere: 0.1, at: [0, 1, 0.5]}], ") +
                hand);
  Random random(3, 0);
  std::set<std::string> met;
  for (int i = 0; i < 200; ++i) {
    const std::vector<double> q{random.uniform(-3, 3), random.uniform(-2.9, 2.9), random.uniform(-0.1, 0.1)};
    const auto nearest = cell->collision->nearest(q);
    ASSERT_TRUE(nearest.has_value());
    EXPECT_NEAR(nearest->distance, by_asking(*cell->collision, q), 1e-7);
    met.insert(nearest->first + " and " + nearest->second);
  }
  EXPECT_GT(met.size(), 2U);
}

TEST(Clearance, ThatIsStatedOfAMotionIsTheSmallestOnIt) {
  const auto cell =
      cell_with(std::string("clearance: 5 mm, obstacles: [{name: ball, sphere: 0.1, at: [0, 1, 0.5]}], ") + hand);
  Random random(4, 0);
  for (int i = 0; i < 12; ++i) {
    std::vector<double> from, to, q(3);
    for (const double limit : {3.0, 2.9, 0.1}) {
      from.push_back(random.uniform(-limit, limit));
      to.push_back(random.uniform(-limit, limit));
    }
    double scanned = 1e9;
    constexpr int steps = 3000;
    for (int k = 0; k <= steps; ++k) {
      for (std::size_t j = 0; j < 3; ++j) q[j] = from[j] + k * (to[j] - from[j]) / steps;
      scanned = std::min(scanned, by_asking(*cell->collision, q));
    }
    const double stated = cell->collision->nearest(from, to)->distance;
    // Between two of so many states nothing moves by more than a millimetre.
    EXPECT_LE(stated, scanned + motion_resolution + 1e-9);
    EXPECT_GE(stated, scanned - 2e-3);
  }
}

}  // namespace
}  // namespace posewright
