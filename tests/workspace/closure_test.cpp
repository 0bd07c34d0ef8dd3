// Configurations of joined tips. Second road: kinematics of two planar arms by their definition, and all their closed
// configurations on a grid.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "posewright/lists/measured_data.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/support/error.hpp"
#include "posewright/tasks/plan_problem.hpp"
#include "posewright/workspace/candidates.hpp"
#include "posewright/workspace/motion_space.hpp"
#include "tests/kit/design_edits.hpp"
#include "tests/kit/example_problems.hpp"
#include "tests/kit/pose_lists.hpp"
#include "tests/kit/temporary_folder.hpp"
#include "tests/kit/two_planar_arms.hpp"

namespace posewright {
namespace {

using testing::HasSubstr;

constexpr double proximal = 0.25, distal = 0.35, apart = 0.3;

class Closures : public testing::Test {
 protected:
  Problem arms(double distance = apart, const std::string& workspace = "", const std::string& loop = "joined: yes") {
    FiveBarSpec spec;
    for (int i = 0; i < 2; ++i) {
      const double side = i == 0 ? -1 : 1;
      spec.legs[std::size_t(i)] = {{side * distance / 2, 0.0}, proximal, distal, -side};
    }
    folder_.write("arms.urdf", two_planar_arms(spec));
    return read_problem(folder_.write(
        "p.yaml",
        "posewright: 1\nrobot: {urdf: arms.urdf, tips: {left: tip1, right: tip2}, encoder_noise: 0.1 mrad}\n"
        "measurement:\n  - {name: loop, type: pose, components: [x, y], of: right, in: left, " +
            loop +
            ", device: {type: isotropic, noise: {position: 0.1 mm, rotation: 1}}}\n"
            "  - {name: tracker, type: position, target: [0, 0, 0], of: right, device: {type: isotropic, "
            "noise: 0.1 mm}}\n"
            "variants: {v: {parameters: [\"rho?.offset\", \"elbow?.offset\", elbow1.x]}}\n"
            "workspace: {joints: {margin: 0, limits: {rho1: [-2, 2], rho2: [-2, 2], elbow1: [-2, 2], elbow2: [-2, "
            "2]}}" +
            workspace + "}\ndesign: {criterion: o1, poses: 8, candidates: 800}\n"));
  }
  /// How far the tips of these arms are apart, by trigonometry.
  static double gap(const std::vector<Coordinate>& coordinates, std::span<const double> q) {
    double at[2][2] = {};
    for (std::size_t k = 0; k < coordinates.size(); ++k)
      if (!coordinates[k].choice())
        at[coordinates[k].name.back() - '1'][coordinates[k].name.starts_with("elbow")] = q[k];
    Eigen::Vector2d tips[2];
    for (int i = 0; i < 2; ++i) {
      const double a = at[i][0], b = at[i][0] + at[i][1];
      tips[i] << (i == 0 ? -0.5 : 0.5) * apart + proximal * std::cos(a) + distal * std::cos(b),
          proximal * std::sin(a) + distal * std::sin(b);
    }
    return (tips[0] - tips[1]).norm();
  }
  /// Angles of the elbow and of the shoulder that bring an arm's tip to a place, by the law of cosines.
  static bool reach(const Eigen::Vector2d& from_shoulder, double bend, double& rho, double& elbow) {
    const double r = from_shoulder.norm();
    const double cosine = (r * r - proximal * proximal - distal * distal) / (2 * proximal * distal);
    if (std::abs(cosine) > 1) return false;
    elbow = bend * std::acos(cosine);
    rho = std::atan2(from_shoulder.y(), from_shoulder.x()) -
          std::atan2(distal * std::sin(elbow), proximal + distal * std::cos(elbow));
    rho = std::remainder(rho, 2 * std::numbers::pi);
    return std::abs(rho) <= 2 && std::abs(elbow) <= 2;
  }
  /// Closed configurations of a grid of places of the tip, both elbows both ways, the instrument 0.
  static std::vector<std::vector<double>> grid(const std::vector<Coordinate>& coordinates, double step) {
    std::vector<std::vector<double>> all;
    for (double x = -0.8; x <= 0.8; x += step)
      for (double y = -0.8; y <= 0.8; y += step)
        for (int bends = 0; bends < 4; ++bends) {
          double rho[2], elbow[2];
          if (!reach({x + apart / 2, y}, bends % 2 == 0 ? 1 : -1, rho[0], elbow[0]) ||
              !reach({x - apart / 2, y}, bends / 2 == 0 ? 1 : -1, rho[1], elbow[1]))
            continue;
          std::vector<double> q;
          for (const Coordinate& c : coordinates) {
            const auto arm = std::size_t(c.name.back() - '1');
            q.push_back(c.choice() ? 0.0 : c.name.starts_with("elbow") ? elbow[arm] : rho[arm]);
          }
          all.push_back(std::move(q));
        }
    return all;
  }
  static Configurations drawn(const Problem& problem, const IdentificationModel& model, std::size_t count) {
    SamplingOptions options;
    options.count = count;
    return sample_configurations(Workspace(model, problem), options, Monitor{});
  }
  TemporaryFolder folder_;
};

TEST_F(Closures, TipsMeetAtEveryDrawnConfigurationOfEveryInstrument) {
  const Problem problem = arms();
  const auto model = make_model(problem);
  const Configurations found = drawn(problem, *model, 600);
  ASSERT_EQ(found.count(), 600U);
  int of_tracker = 0, on_limits = 0;
  for (std::size_t i = 0; i < found.count(); ++i) {
    EXPECT_LT(gap(model->coordinates(), found[i]), 1e-9);
    of_tracker += int(found[i].back());
    int ends = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_LE(std::abs(found[i][k]), 2);
      ends += int(std::abs(found[i][k]) == 2);
    }
    on_limits += int(ends > 0);
  }
  EXPECT_EQ(of_tracker, 300);
  // Optimal poses are there: the boundary keeps its part of the candidates.
  EXPECT_GT(on_limits, 200);
}

TEST_F(Closures, NoClosedConfigurationIsFarFromAllThatAreDrawn) {
  const Problem problem = arms();
  const auto model = make_model(problem);
  const Configurations found = drawn(problem, *model, 4000);
  const auto all = grid(model->coordinates(), 0.03);
  ASSERT_GT(all.size(), 200U);
  int far = 0;
  for (const std::vector<double>& q : all) {
    ASSERT_LT(gap(model->coordinates(), q), 1e-9);
    double nearest = 10;
    for (std::size_t i = 0; i < found.count(); ++i)
      nearest = std::min(
          nearest,
          (Eigen::Map<const Eigen::Vector4d>(q.data()) - Eigen::Map<const Eigen::Vector4d>(found[i].data())).norm());
    far += int(nearest > 0.2);
  }
  EXPECT_LT(far, int(all.size()) / 50);
}

TEST_F(Closures, APlanOfDrawnConfigurationsIsAsGoodAsThatOfAGrid) {
  const Problem problem = arms();
  const Plan plan = plan_problem(problem, {}, Monitor{});
  const auto model = make_model(problem);
  for (const PlannedPose& pose : plan.poses) {
    std::vector<double> q;
    for (const Coordinate& c : model->coordinates()) {
      const auto at = std::ranges::find(pose.configuration, c.name, &NamedValue::name);
      q.push_back(at == pose.configuration.end() ? 0.0 : at->value);
    }
    EXPECT_LT(gap(model->coordinates(), q), 1e-9);
  }
  std::vector<std::vector<double>> candidates = grid(model->coordinates(), 0.04);
  const std::size_t half = candidates.size();
  for (std::size_t i = 0; i < half; ++i) {
    candidates.push_back(candidates[i]);
    candidates.back().back() = 1;
  }
  DesignEdits options;
  options.candidates_from = given_poses(problem, candidates);
  EXPECT_GT(plan.log_det, planned(problem, options).log_det - 0.1);
  EXPECT_FALSE(plan.certificate.workspace);
}

TEST_F(Closures, BoltedHandsStayTogetherInAllComponents) {
  const Problem problem = example("two_arms/joined.yaml");
  const auto model = make_model(problem);
  const Configurations found = drawn(problem, *model, 100);
  ASSERT_EQ(found.count(), 100U);
  for (std::size_t i = 0; i < found.count(); ++i) {
    Eigen::VectorXd reading;
    ASSERT_TRUE(model->predict(found[i], {}, reading));
    EXPECT_LT(reading.norm(), 1e-9);
  }
}

TEST_F(Closures, DataOfTheLoopNeedNoColumnsOfItsReadings) {
  const Problem problem = arms();
  const auto model = make_model(problem);
  const Configurations found = drawn(problem, *model, 40);
  std::string names = "instrument", encoders, zeros;
  for (std::size_t k = 0; k < 4; ++k) names += "," + model->coordinates()[k].name + " [rad]";
  for (std::size_t i = 0; i < found.count(); ++i) {
    const bool tracker = found[i].back() == 1;
    std::string line = tracker ? "tracker" : "loop";
    for (std::size_t k = 0; k < 4; ++k) line += fmt::format(",{:.17g}", found[i][k]);
    const std::string read = tracker ? fmt::format(",{},0.3,0", 0.01 * double(i)) : ",,,";
    encoders += line + read + "\n";
    zeros += line + read + (tracker ? ",," : ",0,0") + "\n";
  }
  names += ",tracker.target.x [m],tracker.target.y [m],tracker.target.z [m]";
  const auto read = [&](const std::string& text) { return parse_measured_data(text, "data.csv", problem, *model); };
  const MeasuredData without = read(names + "\n" + encoders),
                     with = read(names + ",loop.pose.x [m],loop.pose.y [m]\n" + zeros);
  ASSERT_EQ(without.poses.size(), with.poses.size());
  for (std::size_t i = 0; i < with.poses.size(); ++i)
    for (Eigen::Index r = 0; r < with.poses[i].y.size(); ++r)
      EXPECT_TRUE(without.poses[i].y[r] == with.poses[i].y[r] ||
                  (std::isnan(without.poses[i].y[r]) && std::isnan(with.poses[i].y[r])));
  // Nothing is said of targets that were lost, nor of readings that stayed.
  EXPECT_THAT(without.notes, testing::IsEmpty());
  EXPECT_THAT(with.notes, testing::IsEmpty());
}

TEST_F(Closures, ALoopThatCannotCloseIsNamed) {
  const Problem problem = arms(1.5);
  const auto model = make_model(problem);
  try {
    drawn(problem, *model, 100);
    FAIL();
  } catch (const CannotDo& error) {
    EXPECT_THAT(error.what(), HasSubstr("'the loop stays open' rejects 100 %"));
  }
}

TEST_F(Closures, WhatWouldOpenTheLoopIsRefused) {
  const Problem problem = arms(apart, ", samplers: {obstacle_based: 1}");
  const auto model = make_model(problem);
  EXPECT_THROW(Workspace(*model, problem), InputError);
  try {
    MotionSpace(arms(), nullptr);
    FAIL();
  } catch (const CannotDo& error) {
    EXPECT_THAT(error.what(), HasSubstr("they would open the loop"));
  }
}

}  // namespace
}  // namespace posewright
