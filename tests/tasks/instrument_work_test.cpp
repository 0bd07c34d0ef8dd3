// What follows the choice of instruments: limits, times, routes, next poses and lines of sight of each. The second
// roads: counts and sums by hand, and the arm's own geometry.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "posewright/lists/measured_data.hpp"
#include "posewright/lists/read_poses.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/tasks/evaluate_problem.hpp"
#include "posewright/tasks/next_poses.hpp"
#include "posewright/tasks/plan_problem.hpp"
#include "posewright/tasks/route_problem.hpp"
#include "posewright/tasks/simulate_problem.hpp"
#include "tests/kit/message_of.hpp"
#include "tests/kit/planar_instruments.hpp"
#include "tests/kit/pose_lists.hpp"
#include "tests/kit/two_planar_arms.hpp"

namespace posewright {
namespace {

using testing::HasSubstr;

/// With further keys for the tracker and the gauge.
std::string with_keys(const std::string& tracker, const std::string& gauge) {
  const std::string text =
      replaced_once(planar_problem, "repeatability: 30 um}", "repeatability: 30 um, " + tracker + "}");
  return replaced_once(text, "noise: 10 um}}", "noise: 10 um}, " + gauge + "}");
}

long read_by(const Plan& plan, const std::string& instrument) {
  return std::ranges::count_if(plan.poses, [&](const PlannedPose& pose) {
    return !pose.measured && label_of(pose.choices, "instrument") == instrument;
  });
}

TEST(InstrumentLimits, EveryMethodKeepsThemAndTheCertificateCountsThem) {
  for (const char* method : {"exchange", "auto", "greedy", "tabu", "continuous"}) {
    Planar limited(with_keys("most: 7", "most: 1"));  // as many as there are: every swap keeps the numbers
    limited.problem.design.method.value = method;
    const Plan plan = plan_problem(limited.problem, {}, Monitor{});
    EXPECT_EQ(plan.poses.size(), 8U) << method;
    EXPECT_LE(read_by(plan, "gauge"), 1) << method;
    ASSERT_TRUE(plan.certificate.proved);
    EXPECT_LE(plan.certificate.efficiency, 1.0) << method;
    EXPECT_GT(plan.certificate.efficiency, 0.85) << method;
  }
  // Without the limit the gauge reads most of the poses.
  const Planar free;
  EXPECT_GT(read_by(plan_problem(free.problem, {}, Monitor{}), "gauge"), 1);
}

TEST(InstrumentLimits, APlanIsJudgedByTheSameLimit) {
  const Planar limited(with_keys("most: 8", "most: 1"));
  const Plan plan = plan_problem(limited.problem, {}, Monitor{});
  const PoseList list = planned_poses(limited.problem, plan);
  EXPECT_NEAR(evaluate_problem(limited.problem, list, {}, Monitor{}).plan.certificate.efficiency,
              plan.certificate.efficiency, 1e-3);
  // Plans with more poses of the gauge exceed that bound, so it is not said of them.
  EXPECT_TRUE(plan.certificate.limited);
  EXPECT_THAT(plan_summary(plan), HasSubstr(", with no more poses of an instrument than its `most`.\n"));
  const Planar free;
  EXPECT_GT(plan_problem(free.problem, {}, Monitor{}).log_det, plan.certificate.bound);
  EXPECT_FALSE(plan_problem(free.problem, {}, Monitor{}).certificate.limited);
}

TEST(InstrumentLimits, MeasuredPosesCount) {
  const Planar limited(with_keys("most: 8", "most: 1"));
  RunOptions more;
  more.measured = planned_poses(limited.problem, plan_problem(limited.problem, {}, Monitor{}));
  const auto already =
      std::ranges::count_if(more.measured->configurations, [](const auto& q) { return q.back() == 1; });
  ASSERT_EQ(already, 1);
  Problem problem = limited.problem;
  problem.design.poses->value = 1;
  EXPECT_EQ(read_by(plan_problem(problem, more, Monitor{}), "gauge"), 0);
  problem.design.poses->value = 2;
  EXPECT_THAT(message_of<std::runtime_error>([&] { plan_problem(problem, more, Monitor{}); }),
              HasSubstr("by their `most`, the instruments may read 1 further pose of 2 wanted"));
}

TEST(InstrumentLimits, AnInstrumentAloneHasItsKeysElsewhere) {
  for (const char* key : {"most: 3", "reading: 2 s", "setup: 1 min", "line_of_sight: {range: [1, 2]}"})
    EXPECT_THAT(message_of<std::runtime_error>([&] {
                  Planar(replaced_once(R"(posewright: 1
robot: {urdf: arm.urdf}
measurement: {type: position, target: [0, 0, 0], KEY, device: {type: isotropic, noise: 20 um}}
variants:
  arm: {parameters: [q1.offset]}
)",
                                       "KEY", key));
                }),
                HasSubstr("is for an instrument of a list"));
}

TEST(InstrumentRoute, CountsSetUpAndReadingsOfEachInstrument) {
  const Planar timed(with_keys("reading: 20 s, setup: 10 min", "reading: 3 s, repeats: 4, setup: 5 min, most: 5"));
  const Plan plan = plan_problem(timed.problem, {}, Monitor{});
  const double tracker = double(read_by(plan, "tracker")), gauge = double(read_by(plan, "gauge"));
  ASSERT_GT(tracker * gauge, 0);
  EXPECT_EQ(plan.instruments[0].setup, 600);
  EXPECT_EQ(plan.instruments[1].setup, 300);
  EXPECT_EQ(plan.instruments[0].reading, 20 * tracker);
  EXPECT_EQ(plan.instruments[1].reading, 12 * gauge);
  const Route route = route_problem(timed.problem, planned_poses(timed.problem, plan), {}, Monitor{});
  ASSERT_EQ(route.poses.size(), plan.poses.size());
  EXPECT_DOUBLE_EQ(route.reading_seconds(), 20 * tracker + 12 * gauge);
  // One change, to the instrument that reads second.
  int changes = 0;
  for (std::size_t i = 1; i < route.poses.size(); ++i)
    changes += label_of(route.poses[i].choices, "instrument") != label_of(route.poses[i - 1].choices, "instrument");
  EXPECT_EQ(changes, 1);
  EXPECT_DOUBLE_EQ(route.change_seconds(), label_of(route.poses.back().choices, "instrument") == "gauge" ? 300 : 600);
}

TEST(InstrumentsThatReadTogether, TakeTheTimeOfTheSlowest) {
  const std::string text =
      with_keys("reading: 20 s, setup: 10 min", "repeatability: 30 um, reading: 3 s, setup: 5 min");
  const Planar both(
      replaced_once(text, "setup: 5 min}\n", "setup: 5 min}\n  - {name: both, together: [tracker, gauge]}\n"));
  const Plan plan = plan_problem(both.problem, {}, Monitor{});
  // A visit that both read is worth more than that of either.
  ASSERT_EQ(read_by(plan, "both"), 8);
  EXPECT_EQ(plan.instruments.at(2).name, "both");
  EXPECT_EQ(plan.instruments[2].setup, 900);
  EXPECT_EQ(plan.instruments[2].reading, 160);
  EXPECT_NEAR(plan.instruments[2].share + plan.prior_share, 1.0, 1e-9);
  const Route route = route_problem(both.problem, planned_poses(both.problem, plan), {}, Monitor{});
  EXPECT_DOUBLE_EQ(route.reading_seconds(), 160);
}

TEST(InstrumentsThatReadTogether, AreCalibratedFromOneRowAPose) {
  const std::string text = with_keys("most: 3", "repeatability: 30 um");
  const Planar both(replaced_once(text, "repeatability: 30 um}\nvariants",
                                  "repeatability: 30 um}\n  - {name: both, together: [tracker, gauge]}\nvariants"));
  const Plan plan = plan_problem(both.problem, {}, Monitor{});
  SimulateOptions options;
  options.experiment.draws = 300;
  const Simulation simulation = simulate_problem(both.problem, planned_poses(both.problem, plan), options, Monitor{});
  for (const SimulatedParameter& p : simulation.parameters) {
    ASSERT_TRUE(p.errors.has_value());
    EXPECT_NEAR(p.errors->observed / p.predicted, 1.0, 0.15) << p.label.name;
    EXPECT_NEAR(p.errors->coverage, 0.95, 0.04) << p.label.name;
  }
  const auto model = make_model(both.problem);
  const auto file = both.folder.write("data.csv", simulation.first_readings);
  for (const MeasuredPose& pose : read_measured_data(file, both.problem, *model).poses)
    EXPECT_EQ(pose.y.array().isFinite().count(), std::vector<int>({2, 1, 3})[std::size_t(pose.q.back())]);
}

TEST(InstrumentNext, AnInstrumentThatShowsMoreNoiseIsAskedLess) {
  const auto next_reads = [](double gauge_noise) {
    const Planar planar;
    NextOptions options;
    options.data = planar.folder.path() / "data.csv";
    options.text = PlanarReadings(5, gauge_noise).csv;
    options.poses = 3;
    const NextPoses next = next_poses(planar.problem, options, Monitor{});
    EXPECT_TRUE(next.fitted);
    EXPECT_EQ(next.measured, 60);
    EXPECT_EQ(next.poses.size(), 3U);
    return std::ranges::count_if(
        next.poses, [](const PlannedPose& pose) { return label_of(pose.choices, "instrument") == "gauge"; });
  };
  EXPECT_EQ(next_reads(1), 3);
  EXPECT_EQ(next_reads(40), 0);
}

TEST(InstrumentsOfALoop, AreFoundByO1WhereTheChosenCriterionFindsNone) {
  FiveBarSpec spec;
  spec.legs = {{{{-0.15, 0.02}, 0.25, 0.35, 1.0}, {{0.15, -0.01}, 0.24, 0.36, -1.0}}};
  spec.x_lower = -0.1, spec.x_upper = 0.1, spec.y_lower = 0.3, spec.y_upper = 0.45;
  const TemporaryFolder folder;
  folder.write("arms.urdf", two_planar_arms(spec));
  const Problem problem = read_problem(folder.write("p.yaml", R"(posewright: 1
robot: {urdf: arms.urdf, tips: {left: tip1, right: tip2}, encoder_noise: 0.1 mrad}
measurement:
  - {name: loop, type: pose, components: [x, y], of: right, in: left, device: {type: isotropic, noise: {position: 5 um, rotation: 1}}}
  - {name: tracker, type: position, target: [0, 0, 0], of: right, device: {type: isotropic, noise: 20 um}}
variants: {v: {parameters: auto, nuisance: ["base.*"], fixed: ["base@left.r?", "base@left.z"]}}
design: {poses: 24}
)"));
  const auto arms = make_model(problem), chain = five_bar_with_elbow_sensors(spec, 1e-4);
  Random random(2, 0);
  RunOptions run;
  run.candidates_from = PoseList{};
  for (int i = 0; i < 800; ++i) {
    std::vector<double> q = closed_configuration(
        *arms, *chain, {random.uniform(spec.x_lower, spec.x_upper), random.uniform(spec.y_lower, spec.y_upper)});
    q.back() = i % 2;
    run.candidates_from->configurations.push_back(q);
  }
  const Plan plan = plan_problem(problem, run, Monitor{});
  EXPECT_EQ(plan.criterion, "o1");
  EXPECT_THAT(plan.statistics.notes, testing::Contains(HasSubstr("Criterion o1, since no poses were found")));
  // Parameters that the tracker alone can tell are there, although every second candidate is of the loop.
  EXPECT_GT(read_by(plan, "tracker"), 2);
  EXPECT_GT(read_by(plan, "loop"), 2);
}

TEST(InstrumentWorth, IsNotStatedForPosesThatIdentifyNothing) {
  const Planar planar;
  PoseList list;
  for (int i = 0; i < 8; ++i) list.configurations.push_back({0.3 + 1e-7 * i * (i % 3), 0.8 + 1e-7 * i, 0});
  Problem problem = planar.problem;
  problem.design.criterion.value = "bias";
  const PoseListEvaluation evaluation = evaluate_problem(problem, list, {}, Monitor{});
  EXPECT_TRUE(evaluation.plan.instruments.empty());
}

TEST(InstrumentSight, HoldsForTheInstrumentThatReads) {
  const std::string stands = replaced_once(with_keys("line_of_sight: {range: [1.2, 2.2]}", "most: 4"), "noise: 20 um}",
                                           "noise: 20 um, stations: {S: [3, 0, 0]}}");
  const Planar seen(stands);
  const Plan plan = plan_problem(seen.problem, {}, Monitor{});
  const auto distance = [](const std::vector<double>& q, const Eigen::Vector2d& on_tip) {
    return (PlanarReadings::point(Eigen::Vector3d::Zero(), q[0], q[1], on_tip) - Eigen::Vector2d(3, 0)).norm();
  };
  const std::vector<std::vector<double>> poses = planned_poses(seen.problem, plan).configurations;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (poses[i].back() == 1) {
      EXPECT_TRUE(plan.poses[i].sights.empty()) << "a gauge looks from nowhere";
      continue;
    }
    const double d = distance(poses[i], {0.05, 0.02});
    EXPECT_GE(d, 1.2);
    EXPECT_LE(d, 2.2);
    ASSERT_EQ(plan.poses[i].sights.size(), 1U);
    EXPECT_NEAR(plan.poses[i].sights.front().distance, d, 1e-12);
  }
  // Poses of the gauge lie anywhere: without a tracker there is nothing to be seen.
  const Variant variant = make_variant(seen.problem, {}, Monitor{});
  EXPECT_GE(variant.workspace->violation(std::vector{1.9, 1.9, 0.0}), 0);
  EXPECT_LT(variant.workspace->violation(std::vector{1.9, 1.9, 1.0}), 0);
  EXPECT_THAT(message_of<std::runtime_error>([&] {
                const Planar both(stands + "workspace: {line_of_sight: {range: [0.1, 5]}}\n");
                plan_problem(both.problem, {}, Monitor{});
              }),
              HasSubstr("each instrument has its own key line_of_sight"));
  EXPECT_THAT(message_of<std::runtime_error>([&] {
                const Planar gauge(with_keys("most: 8", "line_of_sight: {range: [1, 2]}"));
                plan_problem(gauge.problem, {}, Monitor{});
              }),
              HasSubstr("gauge: line_of_sight: the instrument has no position"));
}

}  // namespace
}  // namespace posewright
