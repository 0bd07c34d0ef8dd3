#include "posewright/cell/collision.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

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

class Travel : public testing::TestWithParam<NamedChain> {};

TEST_P(Travel, BoundsHowFarAPointOfAnyLinkMoves) {
  const TemporaryFolder folder;
  folder.write("arm.urdf", urdf_text(GetParam().joints));
  const Problem problem = read_problem(folder.write(
      "p.yaml",
      "posewright: 1\nrobot: {urdf: arm.urdf, base: base, tip: tip}\n"
      "measurement: {type: pose, device: {type: isotropic, noise: {position: 0.1 mm, rotation: 0.1 mrad}}}\n"
      "variants: {all: {parameters: auto}}\n"));
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
    const int b = 1 + random.index(frames->count() - 1), a = random.index(b);
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

INSTANTIATE_TEST_SUITE_P(Chains, Travel, testing::ValuesIn(named_chains()),
                         [](const auto& instance) { return std::string(instance.param.name); });

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
