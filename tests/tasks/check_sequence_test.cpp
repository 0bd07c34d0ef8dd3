#include "posewright/tasks/check_sequence.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "posewright/formats/pose_formats.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/model/variant_columns.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/results/plan.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/file.hpp"
#include "posewright/support/json.hpp"
#include "posewright/support/random.hpp"
#include "posewright/tasks/plan_problem.hpp"
#include "posewright/workspace/workspace.hpp"
#include "tests/kit/design_edits.hpp"
#include "tests/kit/message_of.hpp"
#include "tests/kit/temporary_folder.hpp"
#include "tests/kit/urdf_text.hpp"

namespace posewright {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr double degree = std::numbers::pi / 180;

/// A rail and six axes, as in a cell with a linear unit.
class OnARail : public testing::Test {
 protected:
  OnARail() {
    folder_.write("arm.urdf", urdf_text({{'P', "0 0 0", "0 0 0", "1 0 0"},
                                         {'R', "0 0 0.4", "0 0 0", "0 0 1"},
                                         {'R', "0.1 0 0.1", "0 0 0", "0 1 0"},
                                         {'R', "0 0 0.6", "0 0 0", "0 1 0"},
                                         {'R', "0.3 0 0.1", "0 0 0", "1 0 0"},
                                         {'R', "0.3 0 0", "0 0 0", "0 1 0"},
                                         {'R', "0.1 0 0", "0 0 0", "1 0 0"}}));
  }

  Problem problem(const std::string& joints = "") const {
    return read_problem(
        folder_.write("p.yaml",
                      "posewright: 1\nrobot: {urdf: arm.urdf, tip: tip}\n"
                      "measurement: {type: position, target: [0.1, 0, 0], device: {type: isotropic, noise: 0.1 mm}}\n"
                      "variants: {all: {parameters: auto}}\n" +
                          (joints.empty() ? "" : "workspace: {joints: {" + joints + "}}\n")));
  }

  /// Two poses and the motion between them, as a route's file has them.
  static json route() {
    const std::vector<double> first{0.1, 0.2, 0.3, -0.4, 0.5, 0.6, -0.7}, second{0.3, 0.1, 0.2, -0.2, 1.5, 0.4, 0.7};
    json file = {{"schema", "posewright/route/1"},
                 {"closed", false},
                 {"from_home", false},
                 {"names", {"j1", "j2", "j3", "j4", "j5", "j6", "j7"}},
                 {"units", {"m", "rad", "rad", "rad", "rad", "rad", "rad"}},
                 {"home", std::vector<double>(7, 0.0)},
                 {"seconds", {{"settle", 4.0}}}};
    file["poses"] = {{{"id", 1}, {"configuration", first}}, {{"id", 2}, {"configuration", second}}};
    file["motions"] = {{{"from", 1}, {"to", 2}, {"seconds", 2.0}, {"points", {first, second}}}};
    return file;
  }

  std::string verdict(const json& file, const Problem& problem) const {
    return message_of<InputError>([&] { checked_sequence(problem, parse_sequence(file.dump(), "r.json")); },
                                  "accepted");
  }

  TemporaryFolder folder_;
};

TEST_F(OnARail, AProgramIsTakenAsTheRouteHasIt) { EXPECT_EQ(verdict(route(), problem()), "accepted"); }

TEST_F(OnARail, AnythingThatWasEditedIntoAnotherMotionIsRefused) {
  const auto edited = [&](const std::function<void(json&)>& edit) {
    json file = route();
    edit(file);
    return verdict(file, problem());
  };
  const auto pose = [](json& file, int joint, double value) {
    file["poses"][1]["configuration"][joint] = value;
    file["motions"][0]["points"][1][joint] = value;
  };
  EXPECT_THAT(edited([&](json& f) { pose(f, 0, 2529); }), HasSubstr("r.json: pose 2: 'j1' is at 2.529e+06 mm"));
  EXPECT_THAT(edited([&](json& f) { pose(f, 3, 100); }), HasSubstr("pose 2: 'j4' is at 5729.58 deg; -143.239 to"));
  EXPECT_THAT(edited([](json& f) { f["units"][0] = "rad"; }), HasSubstr("has the units rad, rad"));
  EXPECT_THAT(edited([](json& f) {
                f["names"].erase(6);
                f["units"].erase(6);
                f["home"].erase(6);
                for (json& p : f["poses"]) p["configuration"].erase(6);
                for (json& p : f["motions"][0]["points"]) p.erase(6);
              }),
              HasSubstr("has the coordinates j1, j2, j3, j4, j5, j6; "));
  for (const double seconds : {0.0, -3.0, 1e-9, 1e300})
    EXPECT_THAT(edited([&](json& f) { f["motions"][0]["seconds"] = seconds; }),
                HasSubstr("the motion from 1 to 2 takes"))
        << seconds;
  EXPECT_THAT(edited([](json& f) { f["seconds"]["settle"] = -1; }), HasSubstr("settles for"));
  EXPECT_THAT(edited([](json& f) {
                f["motions"][0]["points"].insert(f["motions"][0]["points"].begin() + 1,
                                                 json::array({0.1, 2.6, 0.3, 0, 0, 0, 0}));
              }),
              HasSubstr("the motion from 1 to 2: 'j2' is at 148.969 deg"));
}

TEST_F(OnARail, PosesOfAPlanWithoutUnitsAreNotGuessed) {
  json plan = {{"schema", "posewright/plan/1"}};
  plan["poses"] = {{{"id", 1},
                    {"names", {"j1", "j2", "j3", "j4", "j5", "j6", "j7"}},
                    {"configuration", {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7}}}};
  EXPECT_THAT(verdict(plan, problem()), HasSubstr("has poses without units; units: [m, rad"));
  plan["poses"].push_back(plan["poses"][0]);
  plan["poses"][1]["id"] = 2;
  plan["poses"][1]["units"] = {"rad", "rad", "rad", "rad", "rad", "rad", "rad"};
  EXPECT_THAT(verdict(plan, problem()), HasSubstr("pose 2 has other units than the first"));
}

// What a controller would show, from the definition: sign · (q, less f · q2 of axis 3) + zero, deg.
std::vector<double> shown(const std::vector<double>& q, double f, const std::vector<double>& sign,
                          const std::vector<double>& zero) {
  std::vector<double> result;
  for (std::size_t i = 0; i < q.size(); ++i)
    result.push_back(sign[i] * (q[i] - (i == 2 ? f * q[1] : 0)) / degree + zero[i]);
  return result;
}

TEST(ControllerRanges, AreKeptByEveryCandidateAsTheControllerCountsThem) {
  const TemporaryFolder folder;
  folder.write("arm.urdf", urdf_text({{'R', "0 0 0.4", "0 0 0", "0 0 1"},
                                      {'R', "0.1 0 0.1", "0 0 0", "0 1 0"},
                                      {'R', "0 0 0.6", "0 0 0", "0 1 0"},
                                      {'R', "0.3 0 0.1", "0 0 0", "1 0 0"},
                                      {'R', "0.3 0 0", "0 0 0", "0 1 0"},
                                      {'R', "0.1 0 0", "0 0 0", "1 0 0"}}));
  folder.write("c.yaml",
               "coupling: -1\nsign: [1, -1, 1, 1, -1, 1]\nzero_deg: [0, 90, 5, 0, 0, 10]\n"
               "range_deg: [[-170, 170], [20, 150], [-60, 65], [-100, 400], [-50, 40], [-130, 150]]\n");
  const auto text = [](const char* joints) {
    return std::string(
               "posewright: 1\nrobot: {urdf: arm.urdf, tip: tip}\n"
               "measurement: {type: position, target: [0.1, 0, 0], device: {type: isotropic, noise: 0.1 mm}}\n"
               "variants: {all: {parameters: [\"j2.offset\", \"j3.offset\"]}}\n"
               "design: {poses: 6, candidates: 400, method: greedy}\n") +
           joints;
  };
  const std::vector<double> sign{1, -1, 1, 1, -1, 1}, zero{0, 90, 5, 0, 0, 10};
  const std::vector<std::array<double, 2>> range{{-170, 170}, {20, 150}, {-60, 65},
                                                 {-100, 400}, {-50, 40}, {-130, 150}};
  const auto count_outside = [&](const std::string& joints) {
    const Problem problem = read_problem(folder.write("p.yaml", text(joints.c_str())));
    const Plan plan = planned(problem, DesignEdits{});
    int outside = 0;
    for (const PlannedPose& pose : plan.poses) {
      std::vector<double> q;
      for (const NamedValue& v : pose.configuration) q.push_back(v.value);
      const std::vector<double> there = shown(q, -1, sign, zero);
      for (std::size_t i = 0; i < q.size(); ++i)
        outside += there[i] < range[i][0] - 1e-6 || there[i] > range[i][1] + 1e-6;
    }
    // And the program's own check says the same.
    ExportOptions options;
    options.controller = parse_controller_settings(read_file(folder / "c.yaml"), "c.yaml");
    try {
      export_poses(find_pose_format("abb-rapid"), parse_sequence(plan_json(plan), "plan.json"), options);
      EXPECT_EQ(outside, 0);
    } catch (const CannotDo& error) {
      EXPECT_GT(outside, 0);
      EXPECT_THAT(error.what(), HasSubstr("of the controller would be at"));
      EXPECT_THAT(error.what(), HasSubstr("c.yaml allows"));
    }
    return outside;
  };
  EXPECT_GT(count_outside(""), 0);
  EXPECT_EQ(count_outside("workspace: {joints: {controller: c.yaml}}\n"), 0);
}

}  // namespace
}  // namespace posewright
