// What a design block can ask for, through the whole pipeline.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "posewright/problem/read_problem.hpp"
#include "posewright/results/plan.hpp"
#include "posewright/study/study.hpp"
#include "posewright/support/error.hpp"
#include "posewright/tasks/evaluate_problem.hpp"
#include "posewright/tasks/plan_problem.hpp"
#include "tests/kit/design_edits.hpp"
#include "tests/kit/example_problems.hpp"
#include "tests/kit/message_of.hpp"
#include "tests/kit/pose_lists.hpp"
#include "tests/kit/recompute.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

using testing::HasSubstr;

/// A planar chain of n links, position measured with unit noise, lengths and offsets to identify.
std::string planar_urdf(int n) {
  std::string text = "<robot name=\"planar\"><link name=\"l0\"/>";
  for (int k = 1; k <= n; ++k)
    text += "<link name=\"l" + std::to_string(k) + "\"/><joint name=\"q" + std::to_string(k) +
            "\" type=\"continuous\"><parent link=\"l" + std::to_string(k - 1) + "\"/><child link=\"l" +
            std::to_string(k) + "\"/><origin xyz=\"" + (k == 1 ? "0" : "1.2") + " 0 0\"/><axis xyz=\"0 0 1\"/></joint>";
  return text + "<link name=\"tip\"/><joint name=\"end\" type=\"fixed\"><parent link=\"l" + std::to_string(n) +
         "\"/><child link=\"tip\"/><origin xyz=\"0.8 0 0\"/></joint></robot>";
}

std::string planar_problem(int n, const std::string& design) {
  std::string parameters;
  for (int k = 1; k <= n; ++k) {
    parameters += (k > 1 ? ", q" : "q") + std::to_string(k) + ".offset";
    if (k > 1) parameters += ", q" + std::to_string(k) + ".x";
  }
  return "posewright: 1\nrobot: {urdf: planar.urdf}\nmeasurement: {type: pose, components: [x, y], "
         "device: {type: isotropic, noise: {position: 1, rotation: 1}}}\n"
         "variants: {lengths_and_offsets: {parameters: [" +
         parameters + ", tool.x]}}\ndesign: " + design + "\n";
}

class PlanarChain : public testing::TestWithParam<int> {};

TEST_P(PlanarChain, ReachesTheAnalyticOptimumAndTheCertificateSaysSo) {
  const int n = GetParam(), poses = 6;
  const TemporaryFolder folder;
  folder.write("planar.urdf", planar_urdf(n));
  const Problem problem = read_problem(
      folder.write("p.yaml", planar_problem(n, "{criterion: o1, poses: 6, candidates: 4000, method: auto}")));
  DesignEdits options;
  options.proof.gap = 5e-5;
  const Plan plan = planned(problem, options);
  // log det M ≤ 2n ln N + 2 Σ ln l_i.
  const double optimum = 2 * n * std::log(poses) + 2 * ((n - 1) * std::log(1.2) + std::log(0.8));
  EXPECT_NEAR(plan.log_det, optimum, 1e-6);
  EXPECT_LE(plan.log_det, optimum + 1e-9);
  EXPECT_GE(plan.certificate.efficiency, 0.9999);
  ASSERT_TRUE(plan.certificate.workspace.has_value());
  EXPECT_GE(plan.certificate.workspace->efficiency, 0.9999);
}

INSTANTIATE_TEST_SUITE_P(Links, PlanarChain, testing::Values(2, 3));

DesignEdits quick(int candidates = 400) {
  DesignEdits options = DesignEdits().edit("candidates", candidates).edit("restarts", 2).edit("method", "exchange");
  return options;
}

TEST(Design, AutoBeatsExchangeOnTheTelescopeByTheCertificateOfTheWorkspace) {
  const Problem problem = example("telescope/problem.yaml");
  DesignEdits options = quick(500);
  const Plan exchange = planned(problem, options);
  options.edit("method", "auto");
  const Plan best = planned(problem, options);
  EXPECT_GT(best.certificate.workspace->efficiency, exchange.certificate.workspace->efficiency + 0.1);
  ASSERT_EQ(best.statistics.stages.size(), 4U);
  for (std::size_t i = 1; i < 4; ++i)
    EXPECT_GE(best.statistics.stages[i].value, best.statistics.stages[i - 1].value - 1e-9);
}

TEST(Design, AugmentCountsWhatIsMeasuredAlready) {
  const TemporaryFolder folder;
  const Problem problem = example("telescope/problem.yaml");
  DesignEdits options = quick();
  options.edit("poses", 20);
  const Plan first = planned(problem, options);
  options.measured = poses_in(problem, folder.write("measured.csv", poses_csv(first)));
  options.edit("poses", 6);
  const Plan more = planned(problem, options);
  ASSERT_EQ(more.poses.size(), 26U);
  EXPECT_EQ(std::count_if(more.poses.begin(), more.poses.end(), [](const auto& p) { return p.measured; }), 20);
  EXPECT_NEAR(recomputed_log_det(problem, "", configurations_of(problem, more)), more.log_det, 1e-7);
  EXPECT_GT(more.log_det, first.log_det);
  EXPECT_LE(more.log_det, more.certificate.bound);
  EXPECT_GT(more.certificate.efficiency, 0.95);
  // The pose list holds what is still to be measured.
  const std::string csv = poses_csv(more);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 7);
}

TEST(Design, ReservePlanLosesLessWithItsWorstPose) {
  const Problem problem = example("delta/problem.yaml");
  DesignEdits options = quick(200);
  options.edit("poses", 12);
  const auto least = [](const Plan& plan) {
    double value = 1.0;
    for (const PlannedPose& pose : plan.poses) value = std::min(value, pose.without);
    return plan.log_det + double(plan.parameters.size()) * std::log(value);
  };
  const Plan plain = planned(problem, options);
  options.edit("reserve", "yes");
  const Plan reserve = planned(problem, options);
  EXPECT_TRUE(reserve.reserve);
  EXPECT_GE(least(reserve), least(plain) - 1e-9);
  EXPECT_LE(reserve.log_det, reserve.certificate.bound);
}

TEST(Design, MinimumDistanceAndLimitedRepeatsHold) {
  Problem problem = example("kr270/problem.yaml");
  problem.design.minimum_distance = DesignSpec::MinimumDistance{40 * std::numbers::pi / 180, 0.0};
  for (const char* method : {"exchange", "auto"}) {
    DesignEdits options = quick(60);
    options.edit("restarts", 1);
    options.edit("poses", 8);
    options.edit("method", method);
    const auto poses = configurations_of(problem, planned(problem, options));
    for (std::size_t i = 0; i < poses.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        double most = 0;
        for (std::size_t k = 0; k < poses[i].size(); ++k) most = std::max(most, std::abs(poses[i][k] - poses[j][k]));
        EXPECT_GE(most, 40 * std::numbers::pi / 180 - 1e-9) << method;
      }
  }
  problem.design.minimum_distance = DesignSpec::MinimumDistance{100.0, 0.0};
  EXPECT_THROW(planned(problem, quick()), CannotDo);

  const TemporaryFolder folder;
  folder.write("planar.urdf", planar_urdf(2));
  const Problem planar = read_problem(folder.write(
      "p.yaml", planar_problem(2, "{criterion: o1, poses: 9, candidates: 4, repeats: 3, method: exchange}")));
  const Plan plan = plan_problem(planar, {}, Monitor{});
  std::map<int, int> used;
  for (const PlannedPose& pose : plan.poses) ++used[*pose.candidate];
  for (const auto& [candidate, times] : used) EXPECT_LE(times, 3) << candidate;
  EXPECT_LE(plan.log_det, plan.certificate.bound);
  EXPECT_EQ(plan.certificate.repeats, "3");
}

TEST(Design, PosesOfDrawnCandidatesStayApartUnlessTheyMayRepeatOrSomebodySaysOtherwise) {
  const TemporaryFolder folder;
  folder.write("planar.urdf", planar_urdf(2));
  // Few places carry all information: a platform that slides (shares of its ranges) and an arm that turns (rad).
  for (const bool arm : {false, true}) {
    Problem problem =
        arm ? read_problem(folder.write("p.yaml", planar_problem(2, "{criterion: o1, poses: 20, candidates: 3000}")))
            : example("delta/problem.yaml");
    const auto coordinates = pose_coordinates(problem);
    // In the coordinate that tells them apart best, of the two poses that are most alike.
    const auto nearest = [&](const Plan& plan) {
      const auto poses = configurations_of(problem, plan);
      double least = 1e9;
      for (std::size_t i = 0; i < poses.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
          double most = 0;
          for (std::size_t k = 0; k < poses[i].size(); ++k)
            most = std::max(
                most, std::abs(poses[i][k] - poses[j][k]) / (arm ? 1.0 : coordinates[k].upper - coordinates[k].lower));
          least = std::min(least, most);
        }
      return least;
    };
    const auto told = [](const Plan& plan) {
      const auto& notes = plan.statistics.notes;
      return std::any_of(notes.begin(), notes.end(),
                         [](const auto& note) { return note.starts_with("Poses are kept apart"); });
    };
    const Plan plan = plan_problem(problem, {}, Monitor{});
    const double apart = arm ? 5 * std::numbers::pi / 180 : 0.02;
    EXPECT_TRUE(told(plan)) << arm;
    EXPECT_EQ(plan.minimum_distance, arm ? "5 deg" : "5 to 12 mm");
    EXPECT_GE(nearest(plan), apart - 1e-9) << arm;
    EXPECT_LE(plan.log_det, plan.certificate.bound) << arm;

    problem.design.minimum_distance = DesignSpec::MinimumDistance{1e-4, 1e-5};
    const Plan stated = plan_problem(problem, {}, Monitor{});
    EXPECT_FALSE(told(stated)) << arm;
    EXPECT_LT(nearest(stated), apart) << arm << ": nothing kept them apart";
    problem.design.minimum_distance.reset();
    problem.design.repeats = Repeats{Repeats::any_number};
    const Plan repeated = plan_problem(problem, {}, Monitor{});
    EXPECT_FALSE(told(repeated)) << arm;
    EXPECT_EQ(repeated.minimum_distance, "") << arm;
  }
}

TEST(Design, AProvedOptimumIsOneOfThePlansThatKeepTheirPosesApart) {
  const TemporaryFolder folder;
  folder.write("planar.urdf", planar_urdf(2));
  const auto summary = [&](const std::string& more) {
    const Problem problem = read_problem(folder.write(
        "p.yaml",
        planar_problem(2, "{criterion: o1, poses: 4, candidates: 40, method: branch_and_bound" + more + "}")));
    const Plan plan = plan_problem(problem, {}, Monitor{});
    EXPECT_TRUE(plan.proved_optimal);
    return plan_summary(plan);
  };
  EXPECT_THAT(summary(""),
              HasSubstr(" without repeats, with poses as far apart.\nNo plan of these candidates that keeps "
                        "its poses apart is better: every other"));
  EXPECT_THAT(summary(", repeats: allow"),
              HasSubstr(", repeats allowed.\nNo plan of these candidates is better: every other one"));
}

TEST(Design, KeepingPosesApartNeverMakesAPlanFail) {
  // Nearly all candidates are taken: the default distance yields, a stated one does not.
  Problem problem = example("five_bar/problem.yaml");
  DesignEdits options = quick(45);
  options.edit("poses", 44);
  EXPECT_EQ(planned(problem, options).poses.size(), 44U);
  // What is measured already fills the workspace: the default yields, candidates stay.
  const TemporaryFolder folder;
  options = quick(300);
  options.edit("poses", 200);
  options.edit("method", "greedy");
  const auto measured = folder.write("measured.json", plan_json(planned(problem, options)));
  options = quick(400);
  options.seed = 3;
  options.edit("poses", 40);
  options.measured = poses_in(problem, measured);
  EXPECT_EQ(planned(problem, options).poses.size(), 240U);
  // The promising candidates lie in a few places that cannot hold twelve at a distance; others can.
  options = quick(3000);
  options.edit("poses", 12);
  options.edit("method", "auto");
  problem.design.minimum_distance = DesignSpec::MinimumDistance{0.0, 0.02};
  EXPECT_EQ(planned(problem, options).poses.size(), 12U);
}

TEST(Design, SmallestNumberOfPosesReachesWhatIsRequiredAndOneLessDoesNot) {
  const TemporaryFolder folder;
  folder.write("planar.urdf", planar_urdf(2));
  // ρ0² = 2nσ²/N at the optimum of an nR chain: 4/N for n = 2; 0.5 m needs N = 16.
  const Problem problem = read_problem(folder.write(
      "p.yaml", planar_problem(2,
                               "{poses: auto, candidates: 3000, restarts: 2, require: {accuracy: 0.5001 m}, "
                               "test_poses: {at: [[0.1, 0.5], [2, -1.5]]}}")));
  const Plan plan = plan_problem(problem, {}, Monitor{});
  EXPECT_EQ(plan.poses.size(), 16U);
  EXPECT_LE(*plan.rho0, 0.5001);
  ASSERT_GE(plan.curve.size(), 4U);
  for (const CurvePoint& point : plan.curve) EXPECT_EQ(point.enough, point.poses >= 16) << point.poses;

  // The same axis by axis: in its plane the point's error is that along x and y, across it nothing moves.
  ASSERT_EQ(plan.test_axes.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(std::hypot(plan.test_axes[k][0], plan.test_axes[k][1]), plan.test_errors[k], 1e-9);
    EXPECT_LT(plan.test_axes[k][2], 1e-9);
  }
  Problem axes = problem;
  axes.design.require = {};
  axes.design.require.axes[1] = 1.0;
  const Plan along_y = plan_problem(axes, {}, Monitor{});
  for (const auto& sigmas : along_y.test_axes) EXPECT_LE(1.96 * sigmas[1], 1.0);
  for (const CurvePoint& point : along_y.curve)
    EXPECT_EQ(point.enough, point.poses >= int(along_y.poses.size())) << point.poses;

  Problem sigma = problem;
  sigma.design.require = {};
  sigma.design.require.sigma.push_back({{"q2.x", 1}, 0.2, Quantity::length});
  const Plan precise = plan_problem(sigma, {}, Monitor{});
  for (const PlannedParameter& p : precise.parameters) {
    if (p.label.name == "q2.x") {
      EXPECT_LE(*p.sigma, 0.2);
    }
  }
  sigma.design.require.sigma.front().pattern.value = "nothing";
  EXPECT_THROW(plan_problem(sigma, {}, Monitor{}), InputError);
  sigma.design.require.sigma.clear();
  EXPECT_THROW(plan_problem(sigma, {}, Monitor{}), InputError) << "nothing is required";
}

TEST(Design, PlansForSeveralVariantsServeEachAndMaximinTheWorstBest) {
  Problem problem = example("telescope/problem.yaml");
  problem.design.variants = {{{"rigid", 0}, 1.0}, {{"linear", 0}, 1.0}};
  DesignEdits options = quick(60);
  options.edit("poses", 16);
  std::map<std::string, Plan> plans;
  for (const char* criterion : {"compound", "maximin"}) {
    options.edit("criterion", criterion);
    plans[criterion] = planned(problem, options);
    const Plan& plan = plans[criterion];
    ASSERT_EQ(plan.variants.size(), 2U);
    for (const VariantResult& v : plan.variants) {
      EXPECT_LE(v.log_det, v.bound);
      EXPECT_GT(v.efficiency, 0.5);
      EXPECT_NEAR(recomputed_log_det(problem, v.name,
                                     [&] {
                                       Plan one = plan;
                                       one.variant = v.name;
                                       return configurations_of(problem, one);
                                     }()),
                  v.log_det, 1e-6 * std::abs(v.log_det));
    }
    EXPECT_TRUE(plan.certificate.proved);
    EXPECT_GT(plan.certificate.efficiency, 0.8);
  }
  const auto worst = [](const Plan& plan) {
    return std::min(plan.variants[0].efficiency, plan.variants[1].efficiency);
  };
  EXPECT_GE(worst(plans["maximin"]), worst(plans["compound"]) - 0.01);
}

TEST(Design, ValuesOfTargetsStandBesideTestPosesAndDoNotMoveTheRobotThere) {
  Problem problem = example("kr270/problem.yaml");
  problem.design.test_poses = TestPosesSpec{};
  problem.design.test_poses->random = 5;
  DesignEdits options = quick(60);
  options.edit("poses", 12);
  const Plan plain = planned(problem, options);
  // A variant that is linearised at another place of a target, and a user's name for one.
  problem.variants.front().nominal = {{{"target.P1.x", 1}, 0.2773, Quantity::length}};
  std::get<SerialArmSpec>(problem.robot)
      .parameter_names.emplace_back("reflector", Located<std::string>{"target.P2.y", 1});
  const Plan moved = planned(problem, options);
  ASSERT_TRUE(moved.rho0 && moved.turn);
  EXPECT_NEAR(*moved.rho0 / *plain.rho0, 1, 0.02);
  EXPECT_NEAR(*moved.turn / *plain.turn, 1, 0.02);
}

TEST(Design, TestPosesFromAFileAreThoseWrittenInTheProblem) {
  const TemporaryFolder folder;
  folder.write("planar.urdf", planar_urdf(2));
  folder.write("joints.csv", "pose,q1 [deg],q2 [deg],weight\n1,10,40,1\n2,-60,80,3\n");
  // The same two places as points of a tool path.
  const auto place = [](double a, double b) {
    return std::to_string(1.2 * std::cos(a) + 0.8 * std::cos(a + b)) + "," +
           std::to_string(1.2 * std::sin(a) + 0.8 * std::sin(a + b)) + ",0";
  };
  const double deg = std::numbers::pi / 180;
  folder.write("path.csv", "x,y,z,weight\n" + place(10 * deg, 40 * deg) + ",1\n" + place(-60 * deg, 80 * deg) + ",3\n");
  std::map<std::string, double> rho0;
  for (const std::string how :
       {"at: [[10 deg, 40 deg], [-60 deg, 80 deg]], weights: [1, 3]", "file: joints.csv", "file: path.csv"}) {
    const Problem problem = read_problem(folder.write(
        "p.yaml",
        planar_problem(2, "{criterion: o1, poses: 6, candidates: 300, restarts: 1, test_poses: {" + how + "}}")));
    rho0[how] = *plan_problem(problem, {}, Monitor{}).rho0;
  }
  EXPECT_NEAR(rho0["file: joints.csv"], rho0.begin()->second, 1e-12);
  // A point can be reached with the elbow on either side; an optimal plan (M = N·I) knows all places equally well.
  EXPECT_NEAR(rho0["file: path.csv"], rho0.begin()->second, 1e-3);
  const Problem grid = read_problem(folder.write(
      "p.yaml", planar_problem(2,
                               "{criterion: o1, poses: 6, candidates: 300, restarts: 1, test_poses: {grid: "
                               "{lower: [0.5, -0.5, 0], upper: [1.5, 0.5, 0], counts: [3, 3, 1]}}}")));
  EXPECT_EQ(plan_problem(grid, {}, Monitor{}).test_errors.size(), 9U);
  const Problem far = read_problem(folder.write(
      "p.yaml", planar_problem(2,
                               "{criterion: o1, poses: 6, candidates: 300, restarts: 1, test_poses: {grid: "
                               "{lower: [5, 0, 0], upper: [5, 0, 0], counts: [1, 1, 1]}}}")));
  EXPECT_THROW(plan_problem(far, {}, Monitor{}), CannotDo);
}

TEST(Evaluate, APlanReadBackIsWorthWhatThePlanSaid) {
  const TemporaryFolder folder;
  const Problem problem = example("telescope/problem.yaml");
  const Plan plan = planned(problem, quick(80));
  EvaluateOptions options;
  options.drop = 2;
  options.add = 3;
  for (const auto& file : {folder.write("p.csv", poses_csv(plan)), folder.write("p.json", plan_json(plan))}) {
    const PoseListEvaluation e = evaluate_problem(quick(80).of(problem), poses_in(problem, file), options, Monitor{});
    EXPECT_NEAR(e.plan.log_det, plan.log_det, 1e-9);
    EXPECT_NEAR(e.plan.certificate.efficiency, plan.certificate.efficiency, 1e-6);
    for (std::size_t i = 0; i < plan.poses.size(); ++i) {
      EXPECT_NEAR(e.plan.poses[i].contribution, plan.poses[i].contribution, 1e-9);
      EXPECT_NEAR(e.plan.poses[i].without, plan.poses[i].without, 1e-6);
    }
    EXPECT_GE(e.scores.size(), 6U);
    ASSERT_TRUE(e.drop && e.add);
    EXPECT_EQ(e.drop->poses.size(), 2U);
    EXPECT_LT(e.drop->efficiency, 1);
    EXPECT_EQ(e.add->added.size(), 3U);
    EXPECT_GT(e.add->efficiency, 1);
    // What is dropped first loses no more than any other two.
    for (std::size_t i = 1; i < 10; ++i) {
      std::vector<std::vector<double>> left = configurations_of(problem, plan);
      left.erase(left.begin() + std::ptrdiff_t(i));
      left.erase(left.begin());
      EXPECT_LE(recomputed_log_det(problem, "", left), e.drop->log_det + 1e-9);
    }
  }
}

TEST(Evaluate, APoseToAddIsWorthMoreThanAnyThatIsDrawn) {
  const TemporaryFolder folder;
  const Problem problem = example("kr270/problem.yaml");
  DesignEdits edits = quick(200);
  const Plan plan = planned(problem, edits);
  const auto file = folder.write("p.csv", poses_csv(plan));
  edits.edit("method", "auto");
  EvaluateOptions options;
  options.add = 1;
  const PoseListEvaluation e = evaluate_problem(edits.of(problem), poses_in(problem, file), options, Monitor{});
  ASSERT_TRUE(e.add);
  edits.edit("candidates", 300);
  edits.seed = 7;
  const Problem drawn = edits.of(problem);
  const Study study = make_study(resolve(drawn, edits, Monitor{}), Monitor{});
  for (std::size_t i = 0; i < study.configurations.count(); ++i) {
    std::vector<std::vector<double>> longer = configurations_of(problem, plan);
    const auto q = study.configurations[i];
    longer.emplace_back(q.begin(), q.end());
    EXPECT_LT(recomputed_log_det(problem, "", longer), e.add->log_det) << i;
  }
}

TEST(Evaluate, ListsThatCannotBeShortenedAndCriteriaWithoutTestPosesAreToldAtOnce) {
  const TemporaryFolder folder;
  const Problem problem = example("five_bar/problem.yaml");
  DesignEdits edits = quick(200);
  const auto file = folder.write("four.csv", "x [mm],y [mm]\n0,300\n100,300\n-100,300\n0,400\n");
  edits.edit("criterion", "test_pose");
  EXPECT_THROW(evaluate_problem(edits.of(problem), poses_in(problem, file), {}, Monitor{}), CannotDo);
  edits.edit("criterion", "o1");
  EvaluateOptions options;
  options.drop = 1;  // three poses of two rows leave eight parameters open
  EXPECT_THROW(evaluate_problem(edits.of(problem), poses_in(problem, file), options, Monitor{}), CannotDo);
}

TEST(Design, NewPosesNeverRepeatMeasuredOnesAndALimitedRepeatIsKeptByAuto) {
  const TemporaryFolder folder;
  const Problem problem = example("five_bar/problem.yaml");
  DesignEdits options = quick(200);
  options.edit("poses", 10);
  const Plan first = planned(problem, options);
  options.measured = poses_in(problem, folder.write("measured.csv", poses_csv(first)));
  for (const char* method : {"exchange", "auto"}) {
    options.edit("method", method);
    const auto poses = configurations_of(problem, planned(problem, options));
    for (std::size_t i = 0; i < poses.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) EXPECT_NE(poses[i], poses[j]) << method;
  }
  options = quick(200);
  options.edit("method", "auto");
  options.edit("poses", 16);
  options.edit("repeats", 2);
  std::map<std::vector<double>, int> used;
  for (const auto& q : configurations_of(problem, planned(problem, options))) ++used[q];
  for (const auto& [q, times] : used) EXPECT_LE(times, 2);
}

TEST(Evaluate, BadListsNameFileLineAndWhatIsAllowed) {
  const TemporaryFolder folder;
  folder.write("planar.urdf", planar_urdf(2));
  const Problem problem = read_problem(folder.write("p.yaml", planar_problem(2, "{candidates: 50}")));
  struct Bad {
    std::string text, message;
  };
  for (const Bad& bad : {
           Bad{"q1,q3\n1,2\n", "bad.csv:1: has no column 'q2'"},
           Bad{"q1,q2\n1,x\n", "bad.csv:2: 'x' of 'q2' is not a value"},
           Bad{"# mine\nq1 [deg],q2 [mm]\n10,20\n", "bad.csv:3: '20' of 'q2' is not a value"},
           Bad{"q1,q2\n1,2,3\n", "bad.csv:2: has 3 cells; the header has 2"},
           Bad{"q1,q2,weight\n1,2,-1\n", "bad.csv:2: weight '-1'"},
           Bad{"q1,q2\n", "bad.csv: has no poses"},
           Bad{"", "bad.csv: has no poses"},
           Bad{"{\"poses\": 3}", "bad.csv: is not a plan"},
           Bad{"{\"poses\": []}", "bad.csv: has no poses"},
       }) {
    EXPECT_THAT(message_of<InputError>([&] {
                  evaluate_problem(problem, poses_in(problem, folder.write("bad.csv", bad.text)), {}, Monitor{});
                }),
                HasSubstr(bad.message));
  }
  EXPECT_THROW(evaluate_problem(problem, poses_in(problem, folder.write("few.csv", "q1,q2\n1,2\n")), {}, Monitor{}),
               CannotDo);
}

}  // namespace
}  // namespace posewright
