#include "posewright/cell/collision.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "posewright/cell/cell.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/support/random.hpp"
#include "src/cell/body_frames.hpp"
#include "src/cell/scene.hpp"
#include "tests/kit/temporary_folder.hpp"
#include "tests/kit/urdf_text.hpp"

namespace posewright {
namespace {

using testing::HasSubstr;
using namespace std::string_literals;

/// Planar arm: two links of 1 m and 0.8 m in the x-y plane, 0.1 m thick, that turn about z; a hand at the end.
const char* const planar = R"(<robot name="planar">
  <link name="base"><collision><geometry><cylinder radius="0.05" length="0.1"/></geometry></collision></link>
  <link name="upper"><collision><origin xyz="0.5 0 0"/><geometry><box size="1 0.1 0.1"/></geometry></collision></link>
  <link name="lower"><collision><origin xyz="0.4 0 0"/><geometry><box size="0.8 0.1 0.1"/></geometry></collision></link>
  <link name="tip"/>
  <joint name="j1" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
  <joint name="j2" type="revolute"><parent link="upper"/><child link="lower"/><origin xyz="1 0 0"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
  <joint name="end" type="fixed"><parent link="lower"/><child link="tip"/><origin xyz="0.8 0 0"/></joint>
</robot>)";

struct CellFiles {
  TemporaryFolder folder;
  Problem problem;
  std::shared_ptr<const Cell> cell;
  const Collision& collision() const { return *cell->collision; }
};

std::string planar_problem(const std::string& workspace) {
  return "posewright: 1\nrobot: {urdf: arm.urdf, base: base, tip: tip}\n"
         "measurement: {type: position, target: [0.1, 0, 0], device: {type: isotropic, noise: 0.1 mm}}\n"
         "variants: {all: {parameters: auto}}\nworkspace:\n" +
         workspace;
}

std::unique_ptr<CellFiles> planar_setup(const std::string& workspace) {
  auto setup = std::make_unique<CellFiles>();
  setup->folder.write("arm.urdf", planar);
  setup->problem = read_problem(setup->folder.write("p.yaml", planar_problem(workspace)));
  setup->cell = make_cell(setup->problem);
  return setup;
}

TEST(Collision, OfAnArmWithABoxBeginsWhereTheClearanceEnds) {
  // Arm along x: its end is at x = 1.8, the box begins at 1.9; half a millimetre is kept for motions.
  const std::vector<double> stretched{0, 0};
  for (const double clearance : {0.0990, 0.1001}) {
    const auto s = planar_setup(fmt::format(
        "  collision: {{clearance: {}, obstacles: [{{name: block, box: [0.2, 1, 1], at: [2, 0, 0]}}]}}\n", clearance));
    EXPECT_EQ(s->collision().violation(stretched) >= 0, clearance > 0.0995) << clearance;
  }
  const auto s = planar_setup("  collision: {obstacles: [{name: block, box: [0.2, 1, 1], at: [2, 0, 0]}]}\n");
  EXPECT_NEAR(s->collision().slack(stretched, 5), 0.1 - motion_resolution, 1e-6);
  EXPECT_NEAR(s->collision().slack(stretched, 0.02), 0.02, 1e-12);
}

TEST(Collision, NamesWhatTouchesWhat) {
  const auto s = planar_setup(
      "  collision: {tool: [{name: hand, sphere: 0.1}], obstacles: [{name: post, cylinder: {radius: 0.1, length: 1}, "
      "at: [0, 1.8, 0]}]}\n");
  EXPECT_EQ(s->collision().reasons(), (std::vector<std::string>{"self-collision", "collision with post"}));
  EXPECT_EQ(s->collision().colliding(std::vector<double>{M_PI / 2, 0}), std::pair("lower"s, "post"s));
  EXPECT_EQ(s->collision().colliding(std::vector<double>{0, 0}), std::nullopt);
  // Folded back, the hand meets the upper arm: 0.8 − 0.1 m along it.
  EXPECT_EQ(s->collision().colliding(std::vector<double>{0, 3}), std::pair("hand"s, "upper"s));
}

TEST(Collision, AdjacentAndAlwaysTouchingLinksAreNotChecked) {
  const auto s = planar_setup("  collision: {tool: [{name: drum, sphere: 2.5}]}\n");
  EXPECT_EQ(s->collision().always_touching(), (std::vector<std::string>{"base and drum", "drum and upper"}));
  EXPECT_EQ(s->collision().violation(std::vector<double>{0.3, 1}), -1);
}

TEST(Collision, SrdfAndIgnoreTakePairsAway) {
  const std::vector<double> folded{0, 3};
  const std::string tool = "tool: [{name: hand, sphere: 0.1}]";
  EXPECT_GE(planar_setup("  collision: {" + tool + "}\n")->collision().violation(folded), 0);
  EXPECT_EQ(planar_setup("  collision: {ignore: [[upper, hand]], " + tool + "}\n")->collision().violation(folded), -1);
  CellFiles s;
  s.folder.write("arm.urdf", planar);
  s.folder.write("arm.srdf", "<robot name=\"planar\"><disable_collisions link1=\"hand\" link2=\"upper\"/></robot>");
  s.problem = read_problem(s.folder.write("p.yaml", planar_problem("  collision: {srdf: arm.srdf, " + tool + "}\n")));
  EXPECT_EQ(make_cell(s.problem)->collision->violation(folded), -1);
}

TEST(Collision, OfAPairThatOneJointMovesIsNotLookedAtOnlyWhereNoPositionComesNear) {
  // Folded back by 3 rad, the hand is 0.8 sin 3 beside the middle of the upper arm.
  const double nearest = 0.8 * std::sin(3.0) - 0.05 - 0.01;
  for (const double spare : {-3e-3, 3e-3}) {
    const auto s =
        planar_setup(fmt::format("  collision: {{self_clearance: {}, tool: [{{name: hand, sphere: 0.01}}]}}\n",
                                 nearest - motion_resolution - spare));
    const Scene& scene = s->collision().scene();
    for (const BodyPair& pair : scene.pairs)
      if (scene.bodies[std::size_t(pair.a)].name == "upper") EXPECT_EQ(pair.never_near, spare > 0);
      else EXPECT_FALSE(pair.never_near) << "two joints move it";
    EXPECT_EQ(s->collision().colliding(std::vector<double>{0, 3}).has_value(), !(spare > 0));
    EXPECT_EQ(s->collision().motion_is_free(std::vector<double>{0, 0}, std::vector<double>{0, -3}), spare > 0);
  }
}

// The definition: what moves and each obstacle, and any two of the robot's own bodies that are not joined.
TEST(Collision, IsAskedOfEveryPairThatMayMeet) {
  const auto s = planar_setup(
      "  collision: {tool: [{name: hand, sphere: 0.1}], obstacles: [{name: post, sphere: 0.1, at: [0, 1.8, 0]}, {name: "
      "floor, plane: [0, 0, 1], at: [0, 0, -1]}]}\n");
  std::set<std::set<std::string>> pairs;
  for (const BodyPair& pair : s->collision().scene().pairs)
    pairs.insert({s->collision().scene().bodies[std::size_t(pair.a)].name,
                  s->collision().scene().bodies[std::size_t(pair.b)].name});
  std::set<std::set<std::string>> expected{{"base", "lower"}, {"base", "hand"}, {"upper", "hand"}};
  for (const char* moving : {"upper", "lower", "hand"})
    for (const char* obstacle : {"post", "floor"}) expected.insert({moving, obstacle});
  EXPECT_EQ(pairs, expected);
}

TEST(Collision, OfTheFirstAndTheLastPairCounts) {
  for (const double x : {0.5, 1.4}) {
    const auto s = planar_setup(fmt::format(
        "  collision: {{self: false, obstacles: [{{name: block, box: [0.1, 0.1, 0.1], at: [{}, 0, 0]}}]}}\n", x));
    EXPECT_EQ(s->collision().colliding(std::vector<double>{0, 0}), std::pair(x < 1 ? "upper"s : "lower"s, "block"s));
  }
}

// Twelve of thirteen positions of the elbow bring the drum to the upper link: that is no contact by design.
TEST(Collision, OfLinksThatOftenTouchStillCounts) {
  const auto s = planar_setup("  collision: {tool: [{name: drum, sphere: 0.79}]}\n");
  EXPECT_THAT(s->collision().always_touching(), testing::Not(testing::Contains("drum and upper")));
  EXPECT_EQ(s->collision().colliding(std::vector<double>{0, 1.2}), std::pair("drum"s, "upper"s));
}

// The same robot elsewhere takes over what its own bodies were found to keep: the verdicts are those of a fresh look.
TEST(Collision, OfTheSameRobotAmongOtherObstaclesIsThatOfAFreshOne) {
  const auto among = [](double y) {
    return planar_setup(fmt::format(
        "  collision: {{clearance: 0.05, tool: [{{name: hand, sphere: 0.1}}], obstacles: [{{name: post, box: [0.2, "
        "0.2, 1], at: [0.6, {}, 0]}}]}}\n",
        y));
  };
  const auto here = among(1.0), there = among(-0.8);
  const Collision taken(there->problem, *there->cell->model, &here->collision());
  Random random(8, 0);
  int own = 0, post = 0;
  for (int i = 0; i < 2000; ++i) {
    const std::vector<double> q{random.uniform(-3, 3), random.uniform(-3, 3)};
    const int found = there->collision().violation(q);
    EXPECT_EQ(taken.violation(q), found);
    own += found == 0;
    post += found > 0;
  }
  EXPECT_GT(own, 50);
  EXPECT_GT(post, 50);
}

TEST(Collision, AMirroredCellCollidesInMirroredConfigurations) {
  const auto s = planar_setup(
      "  collision: {clearance: 0.02, obstacles: [{name: a, box: [0.3, 0.2, 1], at: [0.7, 0.9, 0], rpy: [0, 0, "
      "0.3]}]}\n");
  const auto mirrored = planar_setup(
      "  collision: {clearance: 0.02, obstacles: [{name: a, box: [0.3, 0.2, 1], at: [0.7, -0.9, 0], rpy: [0, 0, "
      "-0.3]}]}\n");
  Random random(5, 0);
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const std::vector<double> q{random.uniform(-3, 3), random.uniform(-3, 3)};
    const std::vector<double> p{-q[0], -q[1]};
    EXPECT_EQ(s->collision().violation(q), mirrored->collision().violation(p));
    hits += s->collision().violation(q) >= 0;
  }
  EXPECT_GT(hits, 100);
}

TEST(Motion, ThroughASheetThatNoStateOfItsEndsTouchesIsSeen) {
  // 1 mm thin, passed at full speed in the middle of a wide swing.
  const auto s = planar_setup("  collision: {obstacles: [{name: sheet, box: [0.1, 0.001, 0.1], at: [1.75, 0, 0]}]}\n");
  for (const double shift : {0.0, 0.01, 0.0371, 0.2}) {
    const std::vector<double> from{-1.5 + shift, 0}, to{1.3, 0}, before{-0.2, 0};
    EXPECT_EQ(s->collision().violation(from), -1);
    EXPECT_EQ(s->collision().violation(to), -1);
    EXPECT_FALSE(s->collision().motion_is_free(from, to)) << shift;
    EXPECT_TRUE(s->collision().motion_is_free(from, before));
  }
}

TEST(Motion, ThatIsFreeKeepsThePlainClearanceAtEveryState) {
  const double clearance = 0.03;
  const auto s = planar_setup(
      "  collision: {clearance: 0.03, tool: [{name: hand, box: [0.2, 0.1, 0.1]}], obstacles: [{name: post, cylinder: "
      "{radius: 0.2, length: 1}, at: [1.2, 0.6, 0]}, {name: wall, plane: [0, 1, 0], at: [0, -1.1, 0]}]}\n");
  const Scene& scene = s->collision().scene();
  Random random(6, 0);
  std::vector<Eigen::Isometry3d> X(std::size_t(scene.frames->count()));
  int free = 0, blocked = 0;
  for (int i = 0; i < 400; ++i) {
    const std::vector<double> a{random.uniform(-3, 3), random.uniform(-3, 3)},
        b{random.uniform(-3, 3), random.uniform(-3, 3)};
    if (!s->collision().motion_is_free(a, b)) {
      ++blocked;
      continue;
    }
    ++free;
    for (int k = 0; k <= 2000; ++k) {
      const std::vector<double> q{a[0] + k * (b[0] - a[0]) / 2000, a[1] + k * (b[1] - a[1]) / 2000};
      scene.frames->poses(q, 0, X);
      for (const BodyPair& pair : scene.pairs) {
        const Body &one = scene.bodies[std::size_t(pair.a)], &other = scene.bodies[std::size_t(pair.b)];
        const double needed = one.obstacle ? clearance : 1e-9;
        ASSERT_GE(distance(*one.solid, X[std::size_t(one.frame)] * one.X_FrameBody, *other.solid,
                           X[std::size_t(other.frame)] * other.X_FrameBody, needed),
                  needed - 1e-7);
      }
    }
  }
  EXPECT_GT(free, 20);
  EXPECT_GT(blocked, 100);
}

/// The arm without bodies, its pose measured.
Problem problem_of_arm(const TemporaryFolder& folder, const std::string& urdf) {
  folder.write("arm.urdf", urdf);
  return read_problem(folder.write(
      "p.yaml",
      "posewright: 1\nrobot: {urdf: arm.urdf, base: base, tip: tip}\n"
      "measurement: {type: pose, device: {type: isotropic, noise: {position: 0.1 mm, rotation: 0.1 mrad}}}\n"
      "variants: {all: {parameters: auto}}\n"));
}

class Travel : public testing::TestWithParam<NamedChain> {};

TEST_P(Travel, BoundsHowFarAPointOfAnyLinkMoves) {
  const TemporaryFolder folder;
  const Problem problem = problem_of_arm(folder, urdf_text(GetParam().joints));
  const auto model = make_model(problem);
  const auto frames = make_body_frames(problem, *model);
  Random random(7, 0);
  const auto draw = [&] {
    std::vector<double> q;
    for (const Coordinate& c : model->coordinates()) q.push_back(random.uniform(c.lower, c.upper));
    return q;
  };
  std::vector<Eigen::Isometry3d> before(std::size_t(frames->count())), after = before;
  for (int i = 0; i < 300; ++i) {
    const int a = random.index(frames->count()), b = random.index(frames->count());
    if (a == b) continue;
    const Eigen::Vector3d p(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3));
    const Eigen::VectorXd bound = frames->travel(0, a, b, {&p, 1});
    std::vector<double> q = draw(), r = draw();
    const double share = random.uniform(0.01, 1);
    for (std::size_t k = 0; k < q.size(); ++k) r[k] = q[k] + share * (r[k] - q[k]);
    frames->poses(q, 0, before);
    frames->poses(r, 0, after);
    const auto relative = [&](const auto& X) {
      return Eigen::Vector3d(X[std::size_t(a)].inverse() * (X[std::size_t(b)] * p));
    };
    double allowed = 0;
    for (std::size_t k = 0; k < q.size(); ++k) allowed += bound[Eigen::Index(k)] * std::abs(r[k] - q[k]);
    EXPECT_LE((relative(after) - relative(before)).norm(), allowed + 1e-12) << a << " " << b;
  }
}

/// Joints that follow another one and that reach further the more a slide is out.
const char* const following = R"(<robot name="following"><link name="base"/><link name="one"/><link name="two"/>
  <link name="three"/><link name="tip"/>
  <joint name="j1" type="revolute"><parent link="base"/><child link="one"/><origin xyz="0.1 0 0.3"/><axis xyz="0 1 0"/>
    <limit lower="-7" upper="7" effort="1" velocity="1"/></joint>
  <joint name="j2" type="prismatic"><parent link="one"/><child link="two"/><axis xyz="1 0 0"/>
    <limit lower="0.2" upper="0.9" effort="1" velocity="1"/></joint>
  <joint name="j3" type="revolute"><parent link="two"/><child link="three"/><origin xyz="0.2 0 0"/><axis xyz="0 1 0"/>
    <limit lower="-7" upper="7" effort="1" velocity="1"/><mimic joint="j1" multiplier="-2.5" offset="0.1"/></joint>
  <joint name="j4" type="continuous"><parent link="three"/><child link="tip"/><origin xyz="0.3 0 0"/>
    <axis xyz="0 0 1"/></joint>
</robot>)";

/// All there is to know of one pose's motions: how far a point goes, how much it bends, and when all is where it was.
void expect_bounds_of_motions(const BodyFrames& frames, const std::vector<Coordinate>& coordinates) {
  Random random(9, 0);
  const auto count = std::size_t(frames.count());
  std::vector<Eigen::Isometry3d> X(count), before(count), after(count);
  for (int i = 0; i < 3000; ++i) {
    const int a = random.index(frames.count()), b = random.index(frames.count());
    if (a == b) continue;
    constexpr double step = 1e-3;
    std::vector<double> q, change, earlier, later;
    for (const Coordinate& c : coordinates) {
      q.push_back(random.uniform(c.lower, c.upper));
      // Now and then one joint alone, where bounds are nearest to what they bound.
      change.push_back(random.index(2) == 0 ? 0.0 : (c.upper - c.lower) * random.uniform(-1, 1));
      earlier.push_back(q.back() - step * change.back());
      later.push_back(q.back() + step * change.back());
    }
    const Eigen::Vector3d p(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3));
    frames.poses(q, 0, X);
    frames.poses(earlier, 0, before);
    frames.poses(later, 0, after);
    const auto seen = [&](const auto& Y) {
      return Eigen::Vector3d(Y[std::size_t(a)].inverse() * (Y[std::size_t(b)] * p));
    };
    const Eigen::VectorXd bound = frames.travel(0, a, b, {&p, 1});
    double travel = 0;
    for (std::size_t k = 0; k < change.size(); ++k) travel += bound[Eigen::Index(k)] * std::abs(change[k]);
    EXPECT_LE((seen(after) - seen(before)).norm(), 2 * step * travel * (1 + 1e-3) + 1e-12) << a << " " << b;
    const auto rate = frames.rate(0, a, b, change, X);
    ASSERT_TRUE(rate);
    const double bend = (seen(after) - 2 * seen(X) + seen(before)).norm() / (step * step);
    EXPECT_LE(bend, travel * (2 * rate->turn - rate->least_turn) * (1 + 1e-3) + 1e-6) << a << " " << b;
  }
  for (std::size_t k = 0; k < coordinates.size(); ++k) {
    const double period = frames.period(k);
    if (period == 0) continue;
    std::vector<double> q;
    for (const Coordinate& c : coordinates) q.push_back(random.uniform(c.lower, c.upper));
    frames.poses(q, 0, before);
    q[k] += period;
    frames.poses(q, 0, after);
    for (std::size_t f = 0; f < count; ++f)
      EXPECT_LT((before[f].matrix() - after[f].matrix()).norm(), 1e-12) << coordinates[k].name;
  }
}

TEST(Travel, RateAndPeriodBoundJointsThatFollowAndSlide) {
  const TemporaryFolder folder;
  const Problem problem = problem_of_arm(folder, following);
  const auto model = make_model(problem);
  const auto frames = make_body_frames(problem, *model);
  ASSERT_EQ(model->coordinates().size(), 3U);
  EXPECT_EQ(frames->period(0), 0.0);
  EXPECT_GT(frames->period(2), 6);
  expect_bounds_of_motions(*frames, model->coordinates());
}

INSTANTIATE_TEST_SUITE_P(Chains, Travel, testing::ValuesIn(named_chains()),
                         [](const auto& instance) { return std::string(instance.param.name); });

TEST(Travel, BoundsHowFarPointsOfAPlatformMove) {
  const Problem problem = read_problem(POSEWRIGHT_SOURCE_DIR "/examples/gough/problem.yaml");
  const auto model = make_model(problem);
  const auto frames = make_body_frames(problem, *model);
  Random random(10, 0);
  std::vector<Eigen::Isometry3d> before(2), after(2);
  double nearest = 0;
  for (int i = 0; i < 3000; ++i) {
    std::vector<double> q, r;
    for (const Coordinate& c : model->coordinates())
      q.push_back(c.discrete() ? c.values.front() : random.uniform(c.lower, c.upper));
    r = q;
    const int one = i % 4 == 0 ? -1 : random.index(int(q.size()));
    for (std::size_t k = 0; k < q.size(); ++k)
      if (const Coordinate& c = model->coordinates()[k]; !c.discrete() && (one < 0 || one == int(k)))
        r[k] += 0.01 * (random.uniform(c.lower, c.upper) - q[k]);
    const Eigen::Vector3d p(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3));
    const Eigen::VectorXd bound = frames->travel(0, 0, 1, {&p, 1});
    double allowed = 0;
    for (std::size_t k = 0; k < q.size(); ++k) allowed += bound[Eigen::Index(k)] * std::abs(r[k] - q[k]);
    frames->poses(q, 0, before);
    frames->poses(r, 0, after);
    const double moved = (after[1] * p - before[1] * p).norm();
    EXPECT_LE(moved, allowed + 1e-12) << one;
    if (allowed > 0) nearest = std::max(nearest, moved / allowed);
  }
  EXPECT_GT(nearest, 0.9);
}

TEST(Uncalibrated, MarginIsWhatTheTolerancesMoveTheLinks) {
  // Only the first offset is uncertain: 3 · 0.01 rad at the far end of the arm, 1.8 m and its half width away.
  auto text = planar_problem(
      "  uncalibrated: 3\n  joints: {margin: 0.1}\n  collision: {obstacles: [{name: far, sphere: 0.1, at: [9, 9, "
      "0]}]}\n");
  text.replace(text.find("parameters: auto"), 16, "parameters: [j1.offset], tolerance: {\"j1.offset\": 0.01}");
  const TemporaryFolder folder;
  folder.write("arm.urdf", planar);
  const auto cell = make_cell(read_problem(folder.write("p.yaml", text)));
  // The lower link lies within a sphere about its middle: it may reach 1.4 + 0.406 m from the axis when stretched.
  EXPECT_GT(cell->collision->margin(), 0.03 * 1.7);
  EXPECT_LT(cell->collision->margin(), 0.03 * 1.82);
  double most = 0;
  for (const BodyPair& pair : cell->collision->scene().pairs)
    if (cell->collision->scene().bodies[std::size_t(pair.a)].obstacle)
      most = std::max(most, pair.clearance - motion_resolution);
  EXPECT_NEAR(most, cell->collision->margin(), 1e-12) << "kept from the obstacle, where no clearance is asked for";
  EXPECT_NEAR(cell->joint_margin.at("j1"), 0.03, 1e-12);
  EXPECT_EQ(cell->joint_margin.count("j2"), 0U);
}

/// Problems of the cell and what is said of them.
struct BadCell {
  const char* name;
  const char* workspace;
  const char* message;
};
class BadCells : public testing::TestWithParam<BadCell> {};

TEST_P(BadCells, AreNamedWithTheirReason) {
  CellFiles s;
  s.folder.write("arm.urdf", planar);
  s.folder.write("line.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
  s.folder.write("text.stl", "this is not a mesh");
  s.folder.write("empty.obj", "v 0 0 0\n");
  s.folder.write("bad.srdf", "<robot><disable_collisions link1=\"upper\"/></robot>");
  try {
    make_cell(read_problem(s.folder.write("p.yaml", planar_problem(GetParam().workspace))));
    FAIL() << "was accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr(GetParam().message));
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, BadCells,
    testing::Values(
        BadCell{"missing_mesh", "  collision: {obstacles: [{mesh: no.stl}]}\n", "is not there"},
        BadCell{"degenerate_mesh", "  collision: {obstacles: [{mesh: line.obj}]}\n", "degenerate"},
        BadCell{"no_mesh", "  collision: {obstacles: [{mesh: text.stl}]}\n", "text.stl"},
        BadCell{"empty_mesh", "  collision: {obstacles: [{mesh: empty.obj}]}\n", "empty.obj"},
        BadCell{"missing_package", "  collision: {obstacles: [{mesh: \"package://parts/a.stl\"}]}\n",
                "--package parts="},
        BadCell{"package_without_path", "  collision: {obstacles: [{mesh: \"package://parts\"}]}\n", "names no file"},
        BadCell{"missing_srdf", "  collision: {srdf: no.srdf}\n", "is not there"},
        BadCell{"half_srdf", "  collision: {srdf: bad.srdf}\n", "lacks link1 or link2"},
        BadCell{"unknown_link", "  collision: {ignore: [[upper, elbow]]}\n", "'elbow' is not a link"},
        BadCell{"two_shapes", "  collision: {obstacles: [{sphere: 1, box: [1, 1, 1]}]}\n", "2 shapes"},
        BadCell{"no_shape", "  collision: {obstacles: [{at: [1, 1, 1]}]}\n", "0 shapes"},
        BadCell{"plane_as_tool", "  collision: {tool: [{plane: [0, 0, 1]}]}\n", "a tool has an end"},
        BadCell{"same_name", "  collision: {obstacles: [{name: a, sphere: 1}, {name: a, sphere: 1}]}\n", "once"},
        BadCell{"flat_box", "  collision: {obstacles: [{box: [1, 0, 1]}]}\n", "> 0"},
        BadCell{"unknown_station", "  collision: {obstacles: [{sphere: 1, station: B}]}\n", "'B' is not a station"},
        BadCell{"no_sight", "  line_of_sight: {visible: all}\n", "has no position"}),
    [](const auto& instance) { return std::string(instance.param.name); });

TEST(BadCells, AUrdfShapeWithABadNumberIsNamedWithItsLine) {
  CellFiles s;
  std::string urdf = planar;
  urdf.replace(urdf.find("1 0.1 0.1"), 9, "1 0,1 0.1");
  s.folder.write("arm.urdf", urdf);
  try {
    make_cell(read_problem(s.folder.write("p.yaml", planar_problem("  collision: {self: true}\n"))));
    FAIL() << "was accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("malformed"));
    EXPECT_EQ(error.place().line, 3);
  }
}

TEST(BadCells, ShapesThatFollowTheChainFromABranchAreRefusedAndFingersStandAtZero) {
  const auto refusal = [](const std::string& mimic) {
    CellFiles s;
    std::string urdf = planar;
    urdf.insert(urdf.find("</robot>"),
                "<link name=\"rod\"><collision><geometry><sphere radius=\"0.01\"/></geometry></collision></link>"
                "<joint name=\"rod_joint\" type=\"revolute\"><parent link=\"upper\"/><child link=\"rod\"/>"
                "<axis xyz=\"0 0 1\"/><limit lower=\"-9\" upper=\"9\" effort=\"1\" velocity=\"9\"/>" +
                    mimic + "</joint>\n");
    s.folder.write("arm.urdf", urdf);
    try {
      make_cell(read_problem(s.folder.write("p.yaml", planar_problem("  collision: {self: true}\n"))));
      return std::string("accepted");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
  };
  EXPECT_THAT(refusal("<mimic joint=\"j2\"/>"), HasSubstr("'rod' is moved by joint 'rod_joint'"));
  EXPECT_EQ(refusal(""), "accepted");
}

}  // namespace
}  // namespace posewright
