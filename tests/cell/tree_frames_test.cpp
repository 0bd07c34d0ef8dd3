// The cell of an arm with several tips: distances by transforms along the URDF's tree.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "posewright/cell/cell.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/support/random.hpp"
#include "src/cell/scene.hpp"
#include "tests/kit/three_tips.hpp"

namespace posewright {
namespace {

constexpr double clearance = 0.02;
const Eigen::Vector3d ball(0.6, 0.5, 0.7), tool_ball(0.15, 0, 0.1);

class TreeCell : public testing::Test {
 protected:
  static std::string text(const std::string& self) {
    std::string text = three_tips_problem;
    const std::string before = "workspace: {joints: {margin: 1 deg}}\n";
    return text.replace(text.find(before), before.size(),
                        "workspace:\n  collision:\n    self: " + self +
                            "\n    clearance: 20 mm\n    tool:\n    - {name: grip, tip: left, sphere: 0.05, at: [0.15, "
                            "0, 0.1]}\n    obstacles:\n    - {name: ball, sphere: 0.1, at: [0.6, 0.5, 0.7]}\n"
                            "    - {name: floor, plane: [0, 0, 1], at: [0, 0, 0.2]}\n");
  }

  static std::vector<double> drawn(const Cell& cell, Random& random) {
    return random_configuration(cell.model->coordinates(), random);
  }

  /// Balls of links that move and of the tool, in the root.
  static std::vector<std::pair<std::string, Eigen::Vector3d>> balls(const ThreeTips& three, const Cell& cell,
                                                                    const std::vector<double>& q) {
    const std::map<std::string, double> joints = joints_of(cell.model->coordinates(), q);
    std::vector<std::pair<std::string, Eigen::Vector3d>> result;
    for (const char* link : {"torso", "head", "la", "lh", "ra", "rh"})
      result.emplace_back(link, three.plain.pose(link, joints).translation());
    result.emplace_back("grip", three.plain.pose("left_hand", joints) * tool_ball);
    return result;
  }
  static double radius(const std::string& name) { return name == "torso" ? 0.1 : name == "grip" ? 0.05 : 0.08; }

  static double room(const ThreeTips& three, const Cell& cell, const std::vector<double>& q) {
    double least = 1e9;
    for (const auto& [name, p] : balls(three, cell, q))
      least = std::min({least, (p - ball).norm() - 0.1 - radius(name), p.z() - 0.2 - radius(name)});
    return least;
  }
};

TEST_F(TreeCell, HasObstaclesInTheRootAndToolsOnTheirTips) {
  const ThreeTips three(text("no"));
  const auto cell = make_cell(three.problem);
  Random random(1, 0);
  int hit = 0, free = 0;
  for (int i = 0; i < 3000; ++i) {
    const std::vector<double> q = drawn(*cell, random);
    const double spare = room(three, *cell, q) - clearance - motion_resolution;
    if (std::abs(spare) < 1e-6) continue;
    EXPECT_EQ(cell->collision->violation(q) >= 0, spare < 0);
    (spare < 0 ? hit : free) += 1;
  }
  EXPECT_GT(hit, 300);
  EXPECT_GT(free, 300);
}

TEST_F(TreeCell, BodiesHideATargetWhereverTipsCarryStationAndTarget) {
  constexpr double beam = 0.01, target_radius = 0.02;
  const Eigen::Vector3d station(0.02, -0.03, 0.06), target(0.15, 0.1, 0.0);
  std::string words = text("no");
  const std::string before = words.substr(words.find("  - {name: to_right"),
                                          words.find("  - {name: tracker") - words.find("  - {name: to_right"));
  words.replace(words.find(before), before.size(),
                "  - {name: to_right, type: points, of: right, in: eye, targets: {P: [0.15, 0.1, 0]}, device: {type: "
                "isotropic, noise: 0.2 mm, stations: {E: [0.02, -0.03, 0.06]}}, line_of_sight: {range: [0.1, 5], beam: "
                "10 mm, target_radius: 20 mm}}\n");
  const ThreeTips three(words);
  const auto cell = make_cell(three.problem);
  Random random(5, 0);
  int hidden = 0, seen = 0;
  for (int i = 0; i < 3000; ++i) {
    std::vector<double> q = drawn(*cell, random);
    q.back() = 1;
    const std::map<std::string, double> joints = joints_of(cell->model->coordinates(), q);
    const Eigen::Vector3d from = three.plain.pose("eye", joints) * station,
                          at = three.plain.pose("rh", joints) * target;
    const Eigen::Vector3d to = at + (from - at).normalized() * (target_radius + beam);
    // Room of the beam beside balls, and the floor.
    double spare = std::min(from.z(), to.z()) - 0.2 - beam;
    auto bodies = balls(three, *cell, q);
    bodies.emplace_back("root", Eigen::Vector3d::Zero());
    bodies.emplace_back("ball", ball);
    for (const auto& [name, p] : bodies) {
      const Eigen::Vector3d way = to - from;
      const double share = std::clamp(way.dot(p - from) / way.squaredNorm(), 0.0, 1.0);
      spare = std::min(
          spare, (from + share * way - p).norm() - beam - (name == "root" || name == "ball" ? 0.1 : radius(name)));
    }
    if (std::abs(spare) < 1e-4 || (from - at).norm() < 0.1) continue;
    const auto& sights = cell->sights_at(q);
    ASSERT_EQ(sights.size(), 1U);
    EXPECT_EQ(sights.front()->violation(q) >= 0, spare < 0) << i << ": " << spare;
    (spare < 0 ? hidden : seen) += 1;
  }
  EXPECT_GT(hidden, 200);
  EXPECT_GT(seen, 300);
}

TEST_F(TreeCell, KeepsOffOnTheWholeWay) {
  const ThreeTips three(text("yes")), without(text("no"));
  const auto cell = make_cell(three.problem), obstacles_alone = make_cell(without.problem);
  Random random(2, 0);
  int moved = 0, stopped = 0, apart = 0;
  for (int i = 0; i < 400; ++i) {
    std::vector<double> from = drawn(*cell, random), to = drawn(*cell, random);
    to.back() = from.back();
    double least = 1e9, arms = 1e9;
    std::vector<double> q = from;
    for (int step = 0; step <= 1000; ++step) {
      for (std::size_t k = 0; k < q.size(); ++k) q[k] = from[k] + step / 1000.0 * (to[k] - from[k]);
      least = std::min(least, room(three, *cell, q));
      const auto all = balls(three, *cell, q);
      for (const auto& [a, pa] : all)
        for (const auto& [b, pb] : all) {
          const bool left = a == "la" || a == "lh" || a == "grip", right = b == "ra" || b == "rh" || b == "head";
          if (left && right) arms = std::min(arms, (pa - pb).norm() - radius(a) - radius(b));
        }
    }
    // Between two of our states a link moves by a few millimetres.
    if (obstacles_alone->collision->motion_is_free(from, to)) EXPECT_GT(least, clearance - 1e-6);
    else EXPECT_LT(least, clearance + 2 * motion_resolution + 0.01);
    if (cell->collision->motion_is_free(from, to)) {
      EXPECT_GT(std::min(least, arms), clearance - 1e-6);
      ++moved;
    } else {
      ++stopped;
    }
    apart += arms > clearance ? 1 : 0;
  }
  EXPECT_GT(moved, 20);
  EXPECT_GT(stopped, 100);
  EXPECT_LT(apart, 400) << "arms that never meet show nothing";
}

/// A frame's points relative to another frame never move further than stated.
TEST_F(TreeCell, BoundsMotionsBetweenBranches) {
  const ThreeTips three;
  const auto model = make_model(three.problem);
  const auto frames = make_body_frames(three.problem, *model);
  ASSERT_EQ(frames->count(), 8);
  Random random(4, 0);
  std::vector<Eigen::Isometry3d> X(8), Y(8);
  for (int i = 0; i < 3000; ++i) {
    const std::vector<double> q = random_configuration(model->coordinates(), random);
    const int a = random.index(8), b = 1 + random.index(7);
    if (a == b) continue;
    const auto k = std::size_t(random.index(int(q.size()) - 1));
    std::vector<double> near = q;
    near[k] += 1e-5;
    const Eigen::Vector3d p(random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2));
    frames->poses(q, 0, X);
    frames->poses(near, 0, Y);
    const double moved =
        (Y[std::size_t(a)].inverse() * Y[std::size_t(b)] * p - X[std::size_t(a)].inverse() * X[std::size_t(b)] * p)
            .norm();
    const Eigen::VectorXd bound = frames->travel(0, a, b, {&p, 1});
    EXPECT_LE(moved, 1e-5 * bound[Eigen::Index(k)] + 1e-9) << a << " " << b << " " << k;
  }
}

/// What a parameter does to a link, by differences of kinematics along the URDF's tree.
TEST_F(TreeCell, MovesLinksByParametersAsTheTreeDoes) {
  const ThreeTips three;
  const auto model = make_model(three.problem);
  const auto frames = make_body_frames(three.problem, *model);
  const std::map<std::string, int> links = {{"lh", frames->tip("left").frame}, {"rh", frames->tip("right").frame}};
  Random random(6, 0);
  std::vector<Eigen::Isometry3d> X(8);
  for (int i = 0; i < 50; ++i) {
    const std::vector<double> q = random_configuration(model->coordinates(), random);
    const std::map<std::string, double> joints = joints_of(model->coordinates(), q);
    frames->poses(q, 0, X);
    for (const char* joint : {"waist", "tilt", "l1", "l2", "r1", "r2"})
      for (const char* part : {".x", ".y", ".z", ".rx", ".ry", ".rz", ".offset", ".gear"}) {
        const std::string name = std::string(joint) + part;
        const int from = frames->acts_from(name);
        const Eigen::Matrix<double, 6, 1> twist = *frames->twist(name, q, X);
        for (const auto& [link, frame] : links) {
          const auto at = [&](double change) {
            return link_in_root<double>(three.plain, link, joints, {{name, change}}).p;
          };
          const Eigen::Vector3d p = at(0), moved = (at(1e-6) - at(-1e-6)) / 2e-6;
          const Eigen::Vector3d stated = twist.head<3>() + twist.tail<3>().cross(p);
          const bool acts = frames->acts_between(from, 0, frame, false);
          EXPECT_LT((moved - (acts ? stated : Eigen::Vector3d::Zero())).norm(), 1e-8) << name << " " << link;
        }
        EXPECT_EQ(frames->acts_between(from, links.at("lh"), links.at("rh"), false), name[0] == 'l' || name[0] == 'r');
      }
  }
}

}  // namespace
}  // namespace posewright
