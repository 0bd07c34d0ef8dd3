#include "posewright/cell/line_of_sight.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "posewright/cell/cell.hpp"
#include "posewright/model/whitening.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/study/variant.hpp"
#include "posewright/support/random.hpp"
#include "posewright/workspace/candidates.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

constexpr double degree = M_PI / 180;

/// A table that moves along x, y, z and turns about z: its tip is where the configuration says.
const char* const gantry = R"(<robot name="gantry">
  <link name="base"/><link name="a"/><link name="b"/><link name="c"/>
  <link name="tip"><collision><geometry><sphere radius="0.01"/></geometry></collision></link>
  <joint name="x" type="prismatic"><parent link="base"/><child link="a"/><axis xyz="1 0 0"/>
    <limit lower="-9" upper="9" effort="1" velocity="1"/></joint>
  <joint name="y" type="prismatic"><parent link="a"/><child link="b"/><axis xyz="0 1 0"/>
    <limit lower="-9" upper="9" effort="1" velocity="1"/></joint>
  <joint name="z" type="prismatic"><parent link="b"/><child link="c"/><axis xyz="0 0 1"/>
    <limit lower="-9" upper="9" effort="1" velocity="1"/></joint>
  <joint name="turn" type="revolute"><parent link="c"/><child link="tip"/><axis xyz="0 0 1"/>
    <limit lower="-3.2" upper="3.2" effort="1" velocity="1"/></joint>
</robot>)";

struct Scenery {
  TemporaryFolder folder;
  Problem problem;
  std::shared_ptr<const Cell> cell;
  Variant site;

  Scenery(const std::string& targets, const std::string& stations, const std::string& workspace) {
    folder.write("gantry.urdf", gantry);
    problem = read_problem(folder.write(
        "p.yaml",
        "posewright: 1\nrobot: {urdf: gantry.urdf, base: base, tip: tip}\nmeasurement: {type: points, targets: {" +
            targets + "}, device: {type: laser_tracker, stations: {" + stations +
            "}}}\nvariants: {all: {parameters: [\"x.offset\", \"target.*\"], nuisance: []}}\nworkspace:\n" +
            workspace));
    cell = make_cell(problem);
    site = place_variant({problem, problem.variants.front()}, cell);
  }
  const LineOfSight& sight() const { return *cell->sight(); }
  std::string reason(const std::vector<double>& q) const {
    const int reason = site.workspace->violation(q);
    return reason < 0 ? "" : site.workspace->reasons()[std::size_t(reason)];
  }
};

std::vector<double> pose(double x, double y, double z, double turn = 0) { return {x, y, z, turn, 0}; }

TEST(LineOfSight, RangeElevationAndAzimuthEndWhereTheyAreSaidTo) {
  const Scenery s(
      "T: [0, 0, 0]", "A: {position: [0, 0, 0], rpy: [0, 0, \"90 deg\"]}",
      "  line_of_sight: {range: [1, 5], elevation: [\"-45 deg\", \"30 deg\"], azimuth: [\"-60 deg\", \"60 deg\"]}\n");
  // The station looks along y.
  EXPECT_EQ(s.reason(pose(0, 4.99, 0)), "");
  EXPECT_EQ(s.reason(pose(0, 5.01, 0)), "out of range of station A");
  EXPECT_EQ(s.reason(pose(0, 0.99, 0)), "out of range of station A");
  const auto up = [](double angle) { return pose(0, 3 * std::cos(angle * degree), 3 * std::sin(angle * degree)); };
  EXPECT_EQ(s.reason(up(29.9)), "");
  EXPECT_EQ(s.reason(up(30.1)), "elevation at station A");
  EXPECT_EQ(s.reason(up(-44.9)), "");
  EXPECT_EQ(s.reason(up(-45.1)), "elevation at station A");
  const auto aside = [](double angle) { return pose(-3 * std::sin(angle * degree), 3 * std::cos(angle * degree), 0); };
  EXPECT_EQ(s.reason(aside(59.9)), "");
  EXPECT_EQ(s.reason(aside(60.1)), "azimuth at station A");
  const Sight seen = s.sight().sights(aside(30), 0).front();
  EXPECT_NEAR(seen.azimuth, 30 * degree, 1e-12);
  EXPECT_NEAR(seen.distance, 3, 1e-12);
  EXPECT_TRUE(
      seen.p_StationTarget.isApprox(Eigen::Vector3d(3 * std::cos(30 * degree), 3 * std::sin(30 * degree), 0), 1e-12));
}

TEST(LineOfSight, FieldOfViewIsAConeAboutItsAxis) {
  const Scenery s("T: [0, 0, 0]", "A: [0, 0, 0]",
                  "  line_of_sight: {field_of_view: {axis: [0, 0, 2], half_angle: \"20 deg\"}}\n");
  for (const double azimuth : {0.0, 1.0, 2.5, -2.0})
    for (const double angle : {19.9, 20.1}) {
      const double r = 4 * std::sin(angle * degree);
      EXPECT_EQ(s.reason(pose(r * std::cos(azimuth), r * std::sin(azimuth), 4 * std::cos(angle * degree))) == "",
                angle < 20);
    }
}

TEST(LineOfSight, AcceptanceIsTheAngleBetweenNormalAndBeam) {
  const Scenery s("T: [0.1, 0, 0]", "A: [5, 0, 0]",
                  "  line_of_sight: {acceptance: \"30 deg\", normals: {T: [3, 0, 0]}}\n");
  EXPECT_EQ(s.reason(pose(-0.1, 0, 0)), "");
  // Turned about the target, so that the station stays straight ahead.
  const auto turned = [](double angle) {
    return pose(-0.1 * std::cos(angle * degree), -0.1 * std::sin(angle * degree), 0, angle * degree);
  };
  for (const double sign : {-1.0, 1.0}) {
    EXPECT_EQ(s.reason(turned(sign * 29.9)), "");
    EXPECT_EQ(s.reason(turned(sign * 30.1)), "facing away from station A");
    EXPECT_NEAR(*s.sight().sights(turned(sign * 42), 0).front().incidence, 42 * degree, 1e-9);
  }
}

TEST(LineOfSight, IsHiddenBehindAnObstacleAndByTheInstrumentsOwnBodyNot) {
  const std::string obstacles =
      "  collision: {obstacles: [{name: post, box: [0.2, 0.2, 2], at: [2, 0, 0]}, {name: body, sphere: 0.3, at: [0, 0, "
      "0], "
      "station: A}]}\n";
  const Scenery s("T: [0, 0, 0.1]", "A: [0, 0, 0.1]", obstacles + "  line_of_sight: {beam: \"1 mm\"}\n");
  EXPECT_EQ(s.reason(pose(4, 0, 0)), "occluded from station A");
  EXPECT_EQ(s.reason(pose(1.5, 0, 0)), "");
  // The shadow's edge: from the origin past the near corner at (1.9, 0.1), a beam's radius beside it.
  const double edge = 0.1 * 4 / 1.9 + 0.001 * std::hypot(4, 0.1 * 4 / 1.9) / 1.9;
  EXPECT_EQ(s.reason(pose(4, edge - 1e-3, 0)), "occluded from station A");
  EXPECT_EQ(s.reason(pose(4, edge + 1e-3, 0)), "");
  EXPECT_EQ(s.reason(pose(4, -edge + 1e-3, 0)), "occluded from station A");
  EXPECT_EQ(s.reason(pose(4, -edge - 1e-3, 0)), "");
}

TEST(LineOfSight, AMirroredCellSeesTheMirroredPoses) {
  const auto cell = [](double side) {
    return Scenery(fmt::format("T: [0.1, {}, 0], U: [-0.1, {}, 0.1]", 0.1 * side, 0.05 * side),
                   fmt::format("A: [4, {}, 0.3]", 1.5 * side),
                   fmt::format("  collision: {{obstacles: [{{box: [0.5, 0.3, 1], at: [2, {}, 0], rpy: [0, 0, {}]}}]}}\n"
                               "  line_of_sight: {{acceptance: \"50 deg\", normals: {{\"*\": [1, {}, 0]}}}}\n",
                               0.7 * side, 0.4 * side, 0.3 * side));
  };
  const Scenery left = cell(1), right = cell(-1);
  Random random(8, 0);
  int hidden = 0;
  for (int i = 0; i < 1000; ++i) {
    const auto q = pose(random.uniform(-1, 1), random.uniform(-2, 2), random.uniform(-1, 1), random.uniform(-1, 1));
    const auto p = pose(q[0], -q[1], q[2], -q[3]);
    EXPECT_EQ(left.reason(q), right.reason(p));
    const std::vector<Sight> a = left.sight().sights(q, 0), b = right.sight().sights(p, 0);
    for (std::size_t t = 0; t < a.size(); ++t) {
      EXPECT_EQ(a[t].hidden_by, b[t].hidden_by);
      hidden += a[t].hidden_by >= 0;
    }
  }
  EXPECT_GT(hidden, 300);
}

TEST(LineOfSight, VisibleSaysHowManyTargetsMustBeSeen) {
  const std::string targets = "T: [1, 0, 0], U: [0, 0, 0], V: [-1, 0, 0]";
  for (const int needed : {1, 2, 3}) {
    const Scenery s(targets, "A: [0, 0, 0]", fmt::format("  line_of_sight: {{visible: {}, range: [0, 5]}}\n", needed));
    // At x the targets are x + 1, x and x − 1 away.
    EXPECT_EQ(s.reason(pose(3.9, 0, 0)), "");
    EXPECT_EQ(s.reason(pose(4.9, 0, 0)) == "", needed <= 2);
    EXPECT_EQ(s.reason(pose(5.9, 0, 0)) == "", needed <= 1);
    EXPECT_EQ(s.reason(pose(6.1, 0, 0)), "out of range of station A");
  }
}

TEST(Blocks, CountWhatIsVisibleOnly) {
  const std::string both = "T: [0.5, 0, 0], U: [-0.5, 0.2, 0]";
  const Scenery masked(both, "A: [0, 0, 0]", "  line_of_sight: {visible: 1, range: [0, 5]}\n");
  const Scenery open(both, "A: [0, 0, 0]", "  line_of_sight: {visible: 1}\n");
  const Scenery single("U: [-0.5, 0.2, 0]", "A: [0, 0, 0]", "  line_of_sight: {visible: 1}\n");
  const auto information = [](const Scenery& s, const std::vector<double>& q, const std::vector<std::string>& names) {
    std::vector<int> selected;
    for (const std::string& name : names)
      for (std::size_t i = 0; i < s.site.model->parameters().size(); ++i)
        if (s.site.model->parameters()[i].name == name) selected.push_back(int(i));
    const Eigen::Index rows = s.site.model->block_rows(selected), columns = Eigen::Index(selected.size());
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> block(rows, columns);
    Linearisation scratch;
    EXPECT_TRUE(whitened_block(*s.site.model, q, {}, selected, scratch, block.data(), int(columns)));
    return Eigen::MatrixXd(block.transpose() * block);
  };
  const std::vector<std::string> names{"x.offset", "y.offset", "target.U.x", "target.U.y"};
  // T is 5.3 m away and hidden there, U 4.3 m.
  const auto far = pose(4.8, 0, 0), near = pose(2, 0.3, 0.1);
  EXPECT_TRUE(information(masked, far, names).isApprox(information(single, far, names), 1e-12));
  EXPECT_FALSE(information(masked, far, names).isApprox(information(open, far, names), 1e-3));
  EXPECT_TRUE(information(masked, near, names).isApprox(information(open, near, names), 1e-15));
}

TEST(Candidates, InACellAreFeasibleAndTheirRejectionsAddUp) {
  const Scenery s("T: [0.1, 0, 0]", "A: [4, 0, 0.3], B: [-4, 1, 0.3]",
                  "  joints: {coupled: [{sum: {x: 1, y: 1}, range: [-3, 3]}]}\n  tool: {z: [-2, 2]}\n"
                  "  collision: {obstacles: [{name: post, box: [0.5, 0.5, 3], at: [2, 0, 0]}]}\n"
                  "  samplers: {even: 2, boundary: 1, obstacle_based: 1, gaussian: 1, clearance: 1}\n"
                  "  line_of_sight: {range: [0.2, 4], acceptance: \"60 deg\", normals: {T: [1, 0, 0]}}\n");
  SamplingOptions options;
  options.count = 600;
  const Configurations one = sample_configurations(*s.site.workspace, options, Monitor{});
  EXPECT_EQ(one.count(), 600U);
  long rejected = 0;
  std::vector<std::string> reasons;
  for (const auto& [reason, count] : one.rejected) {
    EXPECT_GT(count, 0) << reason;
    rejected += count;
    reasons.push_back(reason);
  }
  EXPECT_EQ(one.drawn, long(one.count()) + rejected);
  using testing::Contains;
  for (const char* expected :
       {"coupled limits of x y", "tool outside its box", "collision with post", "out of range of station A",
        "facing away from station B", "occluded from station A", "passed over by the sampler"})
    EXPECT_THAT(reasons, Contains(expected));
  for (std::size_t i = 0; i < one.count(); ++i) EXPECT_EQ(s.site.workspace->violation(one[i]), -1);
  options.threads = 3;
  const Configurations other = sample_configurations(*s.site.workspace, options, Monitor{});
  EXPECT_EQ(one.values, other.values);
  EXPECT_EQ(one.rejected, other.rejected);
}

TEST(Candidates, WhereNothingIsFeasibleTheReasonThatRejectsMostIsNamed) {
  const Scenery s("T: [0.1, 0, 0]", "A: [4, 0, 0]", "  line_of_sight: {range: [50, 60]}\n");
  SamplingOptions options;
  options.count = 20;
  try {
    sample_configurations(*s.site.workspace, options, Monitor{});
    FAIL();
  } catch (const CannotDo& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("'out of range of station A' rejects 100 %"));
  }
}

TEST(Station, InsideAnObstacleOrTheRobotIsRefused) {
  const auto make = [](const char* station) {
    Scenery("T: [0.1, 0, 0]", station,
            "  collision: {obstacles: [{name: post, box: [0.5, 0.5, 3], at: [2, 0, 0]}]}\n  line_of_sight: {visible: "
            "all}\n");
  };
  EXPECT_NO_THROW(make("A: [4, 0, 0]"));
  for (const auto& [station, body] :
       {std::pair{"A: [2.1, 0, 0]", "inside post"}, std::pair{"A: [0, 0, 0]", "inside tip"}}) {
    try {
      make(station);
      FAIL();
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr(body));
    }
  }
}

TEST(Workspace, NearASingularityIsLeftOut) {
  // x, y, z, turn: the tip's Jacobian has the constant singular values 1, 1, 1 (per metre) and 1.
  const Scenery free("T: [0.1, 0, 0]", "A: [4, 0, 0]", "  singularity: 0.99\n");
  EXPECT_EQ(free.reason(pose(0, 0, 0)), "");
  const Scenery never("T: [0.1, 0, 0]", "A: [4, 0, 0]", "  singularity: {smallest: 0.51, length: 2}\n");
  EXPECT_EQ(never.reason(pose(0, 0, 0)), "near a singularity");
}

}  // namespace
}  // namespace posewright
