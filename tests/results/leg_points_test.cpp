// Points of legs in the result of a calibration: where they are nominal, where the estimate has them.

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "posewright/results/calibration.hpp"
#include "posewright/support/json.hpp"
#include "posewright/tasks/calibrate_problem.hpp"
#include "tests/kit/virtual_file.hpp"

namespace posewright {
namespace {

nlohmann::json leg_points(const std::string& file, int poses, Calibration* found = nullptr) {
  VirtualFile readings{file, poses};
  readings.write();
  CalibrateOptions options = readings.options();
  options.prior = Prior::none;
  options.profile = {ProfileChoice::none};
  const Calibration calibration = calibrate_problem(readings.problem, options, Monitor{});
  if (found) *found = calibration;
  return parse_json(calibration_json(readings.problem, options, calibration)["leg_points"].dump());
}

TEST(LegPoints, AreNominalAsTheProblemFileHasThemAndMovedByTheEstimatedParametersAlone) {
  Calibration found;
  const nlohmann::json points = leg_points("telescope/problem.yaml", 20, &found);
  std::map<std::string, const CalibratedParameter*> estimated;
  for (const CalibratedParameter& p : found.parameters)
    if (p.estimated) estimated[p.label.name] = &p;
  ASSERT_EQ(points.size(), 12u);
  int moved = 0;
  for (const nlohmann::json& point : points) {
    const std::string name = point["name"];
    // Radii of base and platform (examples/telescope/problem.yaml).
    const double x = point["nominal"][0], y = point["nominal"][1];
    EXPECT_NEAR(std::hypot(x, y), name.back() == 'a' ? 0.150 : 0.1826, 1e-4) << name;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto parameter = estimated.find(name + "xyz"[axis]);
      const double change = double(point["calibrated"][axis]) - double(point["nominal"][axis]);
      if (parameter == estimated.end()) {
        EXPECT_EQ(change, 0.0) << name << axis;
        EXPECT_TRUE(point["sigma"][axis].is_null()) << name << axis;
        continue;
      }
      ++moved;
      EXPECT_NEAR(change, parameter->second->value - parameter->second->label.nominal, 1e-15) << name << axis;
      EXPECT_DOUBLE_EQ(point["sigma"][axis], parameter->second->sigma) << name << axis;
    }
  }
  EXPECT_EQ(moved, 24) << "ax, ay, bx, by of six legs";
}

TEST(LegPoints, OfAPlanarRobotLieInItsPlane) {
  const nlohmann::json points = leg_points("five_bar/problem.yaml", 20);
  ASSERT_EQ(points.size(), 2u);
  for (const nlohmann::json& point : points) {
    EXPECT_EQ(std::string(point["name"]).back(), 'a');
    EXPECT_EQ(point["nominal"][2], 0.0);
    EXPECT_EQ(point["calibrated"][2], 0.0);
  }
  EXPECT_NE(points[0]["nominal"][0], points[1]["nominal"][0]);
}

TEST(LegPoints, AreNoneOfAnArm) { EXPECT_TRUE(leg_points("kr270/problem.yaml", 16).empty()); }

}  // namespace
}  // namespace posewright
