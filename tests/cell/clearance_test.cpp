#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "posewright/cell/cell.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/support/random.hpp"
#include "src/cell/body_frames.hpp"
#include "src/cell/scene.hpp"
#include "tests/kit/sliding_arm.hpp"
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

std::shared_ptr<const Cell> cell_with(const std::string& collision, const std::string& variant = "parameters: auto",
                                      const std::string& urdf = bent) {
  const TemporaryFolder folder;
  folder.write("arm.urdf", urdf);
  return make_cell(read_problem(
      folder.write("p.yaml",
                   "posewright: 1\nrobot: {urdf: arm.urdf, tip: wrist}\n"
                   "measurement: {type: position, target: [0.1, 0, 0], device: {type: isotropic, noise: 0.1 mm}}\n"
                   "variants: {all: {" +
                       variant + "}}\nworkspace:\n  collision: {" + collision + "}\n")));
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

/// Where p, fixed in frame b at one state, is at another one for whoever moves with frame a.
Eigen::Vector3d seen_from(const BodyFrames& frames, int a, int b, const Eigen::Vector3d& p,
                          const std::vector<double>& q, const std::vector<double>& later) {
  std::vector<Eigen::Isometry3d> X(std::size_t(frames.count())), Y(X.size());
  frames.poses(q, 0, X);
  frames.poses(later, 0, Y);
  const auto i = std::size_t(a), j = std::size_t(b);
  return X[i] * Y[i].inverse() * Y[j] * X[j].inverse() * p;
}

TEST(BodyFrames, RateIsThatOfDifferencesBetweenStates) {
  const auto cell = cell_with("clearance: 10 mm");
  const BodyFrames& frames = *cell->collision->scene().frames;
  std::vector<Eigen::Isometry3d> X(std::size_t(frames.count()));
  Random random(11, 0);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<double> q, change, before, after;
    constexpr double step = 1e-5;
    for (int k = 0; k < 3; ++k) {
      q.push_back(random.uniform(-2, 2));
      change.push_back(random.uniform(-1, 1));
      before.push_back(q.back() - step * change.back());
      after.push_back(q.back() + step * change.back());
    }
    frames.poses(q, 0, X);
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < 4; ++b) {
        const auto rate = frames.rate(0, a, b, change, X);
        ASSERT_TRUE(rate);
        const Eigen::Vector3d p(random.normal(), random.normal(), random.normal());
        const Eigen::Vector3d found =
            (seen_from(frames, a, b, p, q, after) - seen_from(frames, a, b, p, q, before)) / (2 * step);
        EXPECT_LT((rate->v + rate->omega.cross(p) - found).norm(), 1e-8) << a << " " << b;
        double turn = 0;
        for (int k = std::min(a, b); k < std::max(a, b); ++k) turn += std::abs(change[std::size_t(k)]);
        EXPECT_NEAR(rate->turn, turn, 1e-12);
      }
  }
}

// A turn about the base with a ball beyond a wall: in the middle it passes along the wall, and later it bends into it.
TEST(Motion, ThatBendsIntoABodyIsSeenThoughItBeginsAlongIt) {
  const auto cell = cell_with(
      "clearance: 10 mm, tool: [{name: probe, sphere: 0.02, at: [0, 0, 0.3]}], obstacles: [{name: wall, box: [0.1, "
      "0.8, "
      "0.1], at: [1.45, 0, 0.6]}]");
  const auto at = [](double angle) { return std::vector<double>{angle, 0, 0}; };
  for (const double angle : {-0.6, 0.0, 0.6}) EXPECT_LT(cell->collision->violation(at(angle)), 0) << angle;
  for (const double angle : {-0.26, 0.26}) EXPECT_GE(cell->collision->violation(at(angle)), 0) << angle;
  EXPECT_FALSE(cell->collision->motion_is_free(at(-0.6), at(0.6)));
  EXPECT_TRUE(cell->collision->motion_is_free(at(-0.05), at(0.05)));
}

TEST(Motion, OfThreeJointsThatIsFreeKeepsTheClearanceAtEveryState) {
  const auto cell = cell_with(
      "clearance: 30 mm, tool: [{name: hand, box: [0.2, 0.1, 0.1]}], obstacles: [{name: post, cylinder: {radius: 0.2, "
      "length: 1}, at: [1.2, 0.6, 0]}, {name: ball, sphere: 0.1, at: [0.6, -0.8, 0.9]}]");
  const Scene& scene = cell->collision->scene();
  std::vector<Eigen::Isometry3d> X(std::size_t(scene.frames->count()));
  Random random(12, 0);
  int free = 0, blocked = 0;
  for (int i = 0; i < 50; ++i) {
    std::vector<double> from, to, q(3);
    for (const double most : {3.0, 2.9, 0.1}) {
      from.push_back(random.uniform(-most, most));
      to.push_back(random.uniform(-most, most));
    }
    const bool is_free = cell->collision->motion_is_free(from, to);
    (is_free ? free : blocked)++;
    double least = 1;
    for (int k = 0; k <= 1000; ++k) {
      for (std::size_t j = 0; j < 3; ++j) q[j] = from[j] + k * (to[j] - from[j]) / 1000;
      scene.frames->poses(q, 0, X);
      for (const BodyPair& pair : scene.pairs) {
        const Body &one = scene.bodies[std::size_t(pair.a)], &other = scene.bodies[std::size_t(pair.b)];
        const double apart = distance(*one.solid, X[std::size_t(one.frame)] * one.X_FrameBody, *other.solid,
                                      X[std::size_t(other.frame)] * other.X_FrameBody, pair.clearance + 0.01);
        least = std::min(least, apart - pair.clearance);
      }
    }
    // A motion that passes by less than what motions are resolved to may be either.
    if (is_free) ASSERT_GE(least, -2 * motion_resolution) << i;
    else ASSERT_LT(least, 2e-3) << i;
  }
  EXPECT_GT(free, 5);
  EXPECT_GT(blocked, 5);
}

TEST(Clearance, IsKeptByLinksAndToolFromEachOtherAsFromObstacles) {
  const auto cell = cell_with(std::string("clearance: 40 mm, ") + hand);
  EXPECT_NEAR(asked(*cell->collision, "hand", "base"), 0.04, 1e-12);
  EXPECT_NEAR(asked(*cell->collision, "hand", "upper"), 0.04, 1e-12);
  EXPECT_NEAR(asked(*cell->collision, "base", "lower"), 0.04, 1e-12);
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
  EXPECT_NEAR(near->collision->reduced().front().clearance, 0.0012, 1e-4)
      << "what tolerances move, as far as four fifths of 1.5 mm go";
  EXPECT_TRUE(cell_with(std::string("clearance: 5 mm, ") + hand)->collision->reduced().empty());
}

TEST(Clearance, IsSetForAnyPair) {
  const auto all = cell_with(std::string("clearance: 40 mm, self_clearance: 15 mm, ") + hand);
  for (const char* other : {"base", "upper"}) EXPECT_NEAR(asked(*all->collision, "hand", other), 0.015, 1e-12) << other;
  EXPECT_NEAR(asked(*all->collision, "base", "lower"), 0.015, 1e-12);
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

// Tolerances of the elbow, one standard deviation: m along each axis, rad of its zero position.
constexpr double elbow_shift = 4e-3, elbow_turn = 10e-3;

std::string elbow_within(double metres, double radians) {
  return fmt::format(
      "parameters: [j2.x, j2.y, j2.z, j2.offset], tolerance: {{j2.x: {0}, j2.y: {0}, j2.z: {0}, j2.offset: {1}}}",
      metres, radians);
}

/// The arm with its elbow elsewhere, written as its maker would.
std::string drawn_arm(Random& random) {
  std::string urdf = bent;
  const std::string elbow = "xyz=\"0.8 0 0.3\"";
  return urdf.replace(
      urdf.find(elbow), elbow.size(),
      fmt::format("xyz=\"{} {} {}\" rpy=\"0 {} 0\"", 0.8 + elbow_shift * random.normal(), elbow_shift * random.normal(),
                  0.3 + elbow_shift * random.normal(), elbow_turn * random.normal()));
}

/// Free states whose nearest pair has little beyond its clearance.
std::vector<std::vector<double>> tight_states(const Collision& collision) {
  Random random(5, 0);
  std::vector<std::vector<double>> states;
  while (states.size() < 40) {
    const std::vector<double> q{random.uniform(-3, 3), random.uniform(-2.9, 2.9), random.uniform(-0.1, 0.1)};
    if (collision.violation(q) < 0 && collision.slack(q, 0.01) < 0.003) states.push_back(q);
  }
  return states;
}

/// Of arms drawn from the tolerances at these states, those whose links touch.
int collisions_of_drawn_arms(const std::vector<std::vector<double>>& states) {
  Random random(6, 0);
  int count = 0;
  for (int robot = 0; robot < 50; ++robot) {
    const auto cell = cell_with("clearance: 0", elbow_within(1e-6, 1e-6), drawn_arm(random));
    for (const std::vector<double>& q : states) count += cell->collision->nearest(q)->distance <= 0;
  }
  return count;
}

TEST(Clearance, LetsNoArmWithinTheTolerancesTouchItself) {
  const auto exact = cell_with("clearance: 0", elbow_within(1e-6, 1e-6));
  EXPECT_GT(collisions_of_drawn_arms(tight_states(*exact->collision)), 200) << "of 2000: nominal states tell nothing";
  const auto cell = cell_with("clearance: 0", elbow_within(elbow_shift, elbow_turn));
  EXPECT_GT(asked(*cell->collision, "base", "lower"), 3 * elbow_shift);
  EXPECT_LE(collisions_of_drawn_arms(tight_states(*cell->collision)), 5) << "of 2000, beyond three sigma";
}

/// The smallest distance of all pairs, by asking for each.
double by_asking(const Collision& collision, const std::vector<double>& q) {
  const Scene& scene = collision.scene();
  std::vector<Eigen::Isometry3d> X(std::size_t(scene.frames->count()));
  scene.frames->poses(q, 0, X);
  double smallest = 1e9;
  for (const BodyPair& pair : scene.pairs) {
    const Body &a = scene.bodies[std::size_t(pair.a)], &b = scene.bodies[std::size_t(pair.b)];
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

// A thin sheet between two states that are far from it, where no point of the arm is faster.
TEST(Clearance, OfAMotionThroughASheetAtFullSpeedIsNone) {
  Random random(14, 0);
  for (int i = 0; i < 100; ++i) {
    const double angle = random.uniform(-1.5, 1.5);
    const Workshop shop({{{0.05, 0.0001, 0.05}, ball(angle, 0, 0.6), angle}}, false);
    const Collision collision(shop.problem, *shop.model);
    const std::vector<double> from{angle - random.uniform(0.05, 0.6), 0, 0.6},
        to{angle + random.uniform(0.05, 0.6), 0, 0.6};
    EXPECT_LE(collision.nearest(from, to)->distance, motion_resolution + 1e-6) << i;
  }
}

}  // namespace
}  // namespace posewright
