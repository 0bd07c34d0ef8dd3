// What is known of whole boxes of configurations follows from the checks themselves: nowhere are they told apart.

#include "posewright/cell/necessary_limits.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "posewright/problem/read_problem.hpp"
#include "posewright/study/variant.hpp"
#include "posewright/support/random.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

const char* const arm = R"(<robot name="arm">
  <link name="base"/>
  <link name="column"><collision><origin xyz="0 0 0.2"/><geometry><cylinder radius="0.1" length="0.4"/></geometry></collision></link>
  <link name="upper"><collision><origin xyz="0.3 0 0"/><geometry><box size="0.6 0.1 0.14"/></geometry></collision></link>
  <link name="fore"><collision><origin xyz="0.2 0 0"/><geometry><sphere radius="0.15"/></geometry></collision></link>
  <link name="tip"/>
  <joint name="q1" type="revolute"><parent link="base"/><child link="column"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
  <joint name="q2" type="revolute"><parent link="column"/><child link="upper"/><origin xyz="0.1 0 0.4"/><axis xyz="0 1 0"/>
    <limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
  <joint name="q3" type="revolute"><parent link="upper"/><child link="fore"/><origin xyz="0.7 0 0"/><axis xyz="0 1 0"/>
    <limit lower="-2.5" upper="2.5" effort="1" velocity="1"/></joint>
  <joint name="q4" type="revolute"><parent link="fore"/><child link="tip"/><origin xyz="0.5 0 0"/><axis xyz="1 0 0"/>
    <limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
</robot>)";

struct Site {
  TemporaryFolder folder;
  Problem problem;
  Variant variant;

  explicit Site(const std::string& workspace) {
    folder.write("arm.urdf", arm);
    problem = read_problem(folder.write(
        "p.yaml",
        "posewright: 1\nrobot: {urdf: arm.urdf}\nmeasurement: {type: points, targets: {A: [0.1, 0.1, 0], B: [0.12, "
        "-0.1, "
        "0.02], C: [0.1, 0, 0.2]}, device: {type: laser_tracker, stations: {S: [2, 0.4, 0.6]}}}\nvariants: {all: "
        "{parameters: [q2.offset]}}\nworkspace:\n  joints: {margin: 0" +
            workspace));
    variant = place_variant({problem, problem.variants.front()}, make_cell(problem));
  }

  /// Each limit at q, by its definition.
  std::vector<double> at(std::span<const double> q) const {
    const NecessaryLimits& limits = variant.workspace->necessary_limits();
    std::vector<double> values(std::size_t(limits.values)), result;
    variant.workspace->necessary_values(q, values);
    for (const auto& limit : limits.of_points) {
      const double root = limit.square < 0 ? 0.0 : limit.root * std::sqrt(values[std::size_t(limit.square)]);
      result.push_back(limit.constant + limit.factor * values[std::size_t(limit.value)] + root);
    }
    for (const auto& limit : limits.of_coordinates) {
      result.push_back(limit.constant);
      for (std::size_t i = 0; i < q.size(); ++i) result.back() += limit.factors[i] * q[i];
    }
    return result;
  }

  struct Counts {
    int feasible = 0, forbidden_alone = 0;  ///< where no limit is below 0
    std::vector<int> below;                 ///< of each limit
  };
  /// No feasible configuration is below a limit.
  Counts look_around(int samples) const {
    Random random(5, 1);
    Counts counts;
    for (int i = 0; i < samples; ++i) {
      std::vector<double> q;
      for (const Coordinate& c : variant.workspace->coordinates())
        q.push_back(c.discrete() ? c.values.front() : random.uniform(c.lower, c.upper));
      const std::vector<double> limits = at(q);
      counts.below.resize(limits.size());
      const bool feasible = variant.workspace->violation(q) < 0;
      bool below = false;
      for (std::size_t k = 0; k < limits.size(); ++k) {
        below = below || limits[k] < 0;
        counts.below[k] += limits[k] < 0;
        if (feasible) {
          EXPECT_GE(limits[k], -1e-12) << "limit " << k;
        }
      }
      counts.feasible += feasible;
      counts.forbidden_alone += !feasible && !below;
    }
    return counts;
  }
};

TEST(NecessaryLimits, OfToolBoxCoupledJointsAndSightOfAllTargetsAreTheChecksThemselves) {
  const Site site(R"(, coupled: [{sum: {q2: 1, q3: 0.5}, range: [-80 deg, 100 deg]}]}
  tool: {point: [0.05, 0, 0], x: [-0.4, 1.2], z: [0.1, 1.0]}
  line_of_sight:
    range: [0.9 m, 2.6 m]
    elevation: [-20 deg, 35 deg]
    azimuth: [-178 deg, -140 deg]
    acceptance: 80 deg
    normals: {"*": [1, 0, 0]}
)");
  const auto counts = site.look_around(20000);
  EXPECT_GT(counts.feasible, 200);
  EXPECT_EQ(counts.forbidden_alone, 0);
  for (std::size_t k = 0; k < counts.below.size(); ++k) EXPECT_GT(counts.below[k], 20) << "limit " << k;
  EXPECT_THAT(site.variant.workspace->necessary_limits().names,
              testing::UnorderedElementsAre("coupled joints", "tool box", "sight"));
}

TEST(NecessaryLimits, FollowWhereSomeTargetsAreEnoughAndBodiesStayAboveAFloor) {
  const Site site(R"(}
  collision:
    clearance: 20 mm
    self: no
    obstacles: [{name: floor, plane: [0, 0.1, 1], at: [0, 0, -0.05]}]
  line_of_sight:
    visible: 2
    range: [0.9 m, 2.6 m]
    elevation: [-20 deg, 35 deg]
    field_of_view: {axis: [-1, 0, 0], half_angle: 40 deg}
    acceptance: 70 deg
    normals: {"*": [1, 0, 0]}
)");
  const auto counts = site.look_around(20000);
  EXPECT_GT(counts.feasible, 200);
  // A ball in a body, and the mean of the targets, know most.
  EXPECT_LT(counts.forbidden_alone, 20000 / 10);
  EXPECT_THAT(site.variant.workspace->necessary_limits().names, testing::UnorderedElementsAre("floor", "sight"));
  EXPECT_GT(*std::max_element(counts.below.begin(), counts.below.end()), 1000);
}

}  // namespace
}  // namespace posewright
