#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "posewright/cell/cell.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/study/variant.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/random.hpp"
#include "posewright/workspace/candidates.hpp"
#include "src/workspace/view_sampler.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

using Eigen::Isometry3d, Eigen::Vector3d;

constexpr double one_degree = M_PI / 180;
const char* const board_on_floor = "position: [1.6, 0, 0.1], rpy: [0, 0, 0]";

/// KR 270 with all of its own limits, and something that looks.
struct Site {
  TemporaryFolder folder;
  Problem problem;
  std::shared_ptr<const Cell> cell;
  Variant variant;

  Site(const std::string& measurement, const std::string& workspace) {
    problem = read_problem(folder.write(
        "p.yaml", fmt::format("posewright: 1\nrobot: {{urdf: {}/examples/kr270/kr270.urdf}}\nmeasurement: {}\n"
                              "variants: {{all: {{parameters: auto}}}}\nworkspace:\n  {}\n",
                              POSEWRIGHT_SOURCE_DIR, measurement, workspace)));
    cell = make_cell(problem);
    variant = place_variant({problem, problem.variants.front()}, cell);
  }
  std::vector<double> anywhere(Random& random) const {
    std::vector<double> q;
    for (const Coordinate& c : variant.workspace->proposed())
      q.push_back(c.discrete() ? c.values.front() : random.uniform(c.lower, c.upper));
    return q;
  }
};

// Focal length 1000 px, picture of 1000 × 800 px: 21.8 deg to the nearer edge.
std::string camera(const std::string& mount, const std::string& camera_at, const std::string& board_at) {
  return fmt::format(
      "{{type: camera, mount: {}, camera: {{focal: [1000, 1000], centre: [500, 400], size: [1000, 800], {}}}, "
      "board: {{rows: 5, columns: 7, spacing: 30 mm, {}}}, device: {{type: isotropic, noise: 0.2}}}}",
      mount, camera_at, board_at);
}

double angle_between(const Vector3d& a, const Vector3d& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

TEST(Views, OfACameraInTheHandAreEvenOnTheDomeBeforeTheBoard) {
  const Site s(camera("hand", "position: [0.1, 0, 0.05], rpy: [0, 90 deg, 0]", board_on_floor),
               "line_of_sight: {range: [0.6, 1.2], acceptance: 45 deg, normals: {\"*\": [0, 0, 1]}}");
  Random random(1, 0);
  const Isometry3d X_TipCamera = Eigen::Translation3d(0.1, 0, 0.05) * Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitY());
  const Vector3d middle(1.6 + 0.09, 0.06, 0.1);
  const double radius = std::hypot(0.09, 0.06);
  double cosines = 0, distances = 0, off_axis = 0;
  constexpr int draws = 4000;
  for (int i = 0; i < draws; ++i) {
    const Isometry3d X = s.cell->sight()->propose_tip(s.anywhere(random), random) * X_TipCamera;
    const Vector3d way = middle - X.translation();
    EXPECT_GE(way.norm(), 0.6 - 1e-9);
    EXPECT_LE(way.norm(), 1.2 + 1e-9);
    EXPECT_LE(angle_between(-way, Vector3d::UnitZ()), 45 * one_degree + 1e-6);
    // The ball around the board is in the picture.
    const double aside = angle_between(way, X.linear().col(2)) + std::atan2(radius, way.norm());
    EXPECT_LE(aside, std::atan(0.4) + 1e-6);
    cosines += -way.normalized().z() / draws;
    distances += way.norm() / draws;
    off_axis = std::max(off_axis, aside);
  }
  EXPECT_NEAR(cosines, (1 + std::cos(45 * one_degree)) / 2, 0.01) << "even over the dome";
  EXPECT_NEAR(distances, 0.9, 0.02);
  EXPECT_GT(off_axis, 0.95 * std::atan(0.4)) << "also at the rim of the picture";
}

TEST(Views, OfATrackerTurnReflectorsTowardsItAndLeaveThemWhereTheyAre) {
  const Site s("{type: points, targets: {P: [0.2, 0.1, 0]}, device: {type: laser_tracker, stations: {A: [4, 1, 0.5]}}}",
               "line_of_sight: {range: [1, 20], acceptance: 30 deg, normals: {P: [0, 1, 0]}}");
  Random random(2, 0);
  for (int i = 0; i < 500; ++i) {
    const std::vector<double> q = s.anywhere(random);
    const Vector3d before = s.variant.model->tool_pose(q) * Vector3d(0.2, 0.1, 0);
    const Isometry3d X = s.cell->sight()->propose_tip(q, random);
    const Vector3d way = Vector3d(4, 1, 0.5) - X * Vector3d(0.2, 0.1, 0);
    EXPECT_LE(angle_between(X.linear().col(1), way), 30 * one_degree + 1e-6);
    if ((Vector3d(4, 1, 0.5) - before).norm() > 1) {
      EXPECT_LT((X * Vector3d(0.2, 0.1, 0) - before).norm(), 1e-9);
    }
  }
}

TEST(Views, AreReachedByTheJointsThatAreReturned) {
  const Site s(
      camera("fixed", "position: [3.2, 0, 1.2], rpy: [0, -90 deg, 0]", "position: [0.2, 0, 0], rpy: [0, 90 deg, 0]"),
      "line_of_sight: {range: [0.6, 2], acceptance: 50 deg, normals: {\"*\": [0, 0, 1]}}");
  const auto views = ViewSampler::make(*s.variant.model, *s.cell, s.variant.workspace->proposed());
  ASSERT_NE(views, nullptr);
  int reached = 0, seen = 0;
  for (std::uint64_t i = 0; i < 400; ++i) {
    Random first(3, i), again(3, i);
    std::vector<double> q = s.anywhere(first);
    s.anywhere(again);
    const Isometry3d wanted = s.cell->sight()->propose_tip(q, again);
    if (!views->move_to_view(q, first)) continue;
    ++reached;
    const Isometry3d X = s.variant.model->tool_pose(q);
    EXPECT_LT((X.translation() - wanted.translation()).norm(), 6e-3);
    EXPECT_LT(Eigen::AngleAxisd(X.linear().transpose() * wanted.linear()).angle(), 0.011);
    for (std::size_t k = 0; k < q.size(); ++k) {
      EXPECT_GE(q[k], s.variant.workspace->proposed()[k].lower);
      EXPECT_LE(q[k], s.variant.workspace->proposed()[k].upper);
    }
    seen += s.variant.workspace->violation(q) < 0;
  }
  EXPECT_GT(reached, 60);
  EXPECT_GT(seen, reached / 2);
}

TEST(Candidates, OfACameraThatSeldomSeesItsBoardComeFromViewsOnAnyNumberOfThreads) {
  const Site s(camera("hand", "position: [0.1, 0, 0.05], rpy: [0, 90 deg, 0]", board_on_floor),
               "line_of_sight: {range: [0.5, 1.2], acceptance: 45 deg, normals: {\"*\": [0, 0, 1]}}");
  SamplingOptions options;
  options.count = 300;
  options.threads = 1;
  const Configurations one = sample_configurations(*s.variant.workspace, options, Monitor{});
  ASSERT_EQ(one.count(), 300U);
  EXPECT_LT(one.drawn, 300 * 20) << "even draws find one in a thousand";
  long rejected = 0;
  for (const auto& [reason, count] : one.rejected) rejected += count;
  EXPECT_EQ(one.drawn, long(one.count()) + rejected);
  for (std::size_t i = 0; i < one.count(); ++i) {
    EXPECT_LT(s.variant.workspace->violation(one[i]), 0);
    // The instrument's own word, point by point.
    for (const Sight& sight : s.cell->sight()->sights(one[i], 0)) EXPECT_LT(sight.hidden_by, 0);
  }
  options.threads = 3;
  EXPECT_EQ(sample_configurations(*s.variant.workspace, options, Monitor{}).values, one.values);
}

std::string refusal(const Site& s) {
  SamplingOptions options;
  options.count = 50;
  try {
    sample_configurations(*s.variant.workspace, options, Monitor{});
    return "accepted";
  } catch (const CannotDo& error) {
    return error.what();
  }
}

TEST(Candidates, OfABoardOutOfReachAreRefusedWithTheCure) {
  const Site far(camera("hand", "position: [0.1, 0, 0.05], rpy: [0, 90 deg, 0]", "position: [9, 0, 0], rpy: [0, 0, 0]"),
                 "line_of_sight: {range: [0.5, 1.2], acceptance: 45 deg, normals: {\"*\": [0, 0, 1]}}");
  EXPECT_THAT(refusal(far), testing::HasSubstr("'no joint angles for a view of the targets' rejects 100 %"));
  EXPECT_THAT(refusal(far), testing::HasSubstr("move targets or instrument into reach"));
  const Site hidden(camera("hand", "position: [0.4, 0, 0.05], rpy: [0, 90 deg, 0]", board_on_floor),
                    "line_of_sight: {range: [0.5, 1.2]}\n"
                    "  collision: {obstacles: [{name: lid, box: [2, 2, 0.01], at: [1.6, 0, 0.2]}]}");
  EXPECT_THAT(refusal(hidden), testing::HasSubstr("'occluded from the camera' rejects"));
  EXPECT_THAT(refusal(hidden), testing::HasSubstr("a body hides the instrument"));
}

TEST(Samplers, LookAtIsRefusedWhereNothingSaysWhereToLook) {
  try {
    const Site s("{type: position, target: [0.1, 0, 0], device: {type: isotropic, noise: 0.1 mm}}",
                 "samplers: {look_at: 1}");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(),
                testing::ContainsRegex(":[0-9]+: look_at: this instrument has no viewing direction; cameras have one"));
  }
}

}  // namespace
}  // namespace posewright
