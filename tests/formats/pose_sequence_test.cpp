#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "posewright/results/plan.hpp"
#include "posewright/results/route.hpp"
#include "posewright/support/error.hpp"
#include "sequences.hpp"

namespace posewright {
namespace {

TEST(PoseSequence, ReadsPlansAndRoutesAsTheyAreWritten) {
  Plan plan;
  Route route;
  const PoseSequence wanted = random_route(6, 4, 9);
  for (const SequencePose& pose : wanted.poses) {
    PlannedPose planned;
    planned.id = pose.id;
    for (std::size_t i = 0; i < 6; ++i) planned.configuration.push_back({wanted.names[i], "rad", pose.values[i]});
    planned.choices = {{"load_case", "heavy"}, {"station", "Süd"}, {"temperature", "20"}};
    planned.tool_pose = pose.tool_pose;
    for (const SequenceTarget& target : pose.targets) {
      TargetSight sight;
      sight.target = target.name;
      sight.station = target.station;
      sight.position = target.position;
      sight.hidden_by = target.hidden ? "table" : "";
      planned.sights.push_back(sight);
    }
    plan.poses.push_back(planned);
    route.poses.push_back(planned);
  }
  plan.poses[1].measured = true;
  route.names = wanted.names;
  route.units = wanted.units;
  route.home = wanted.home;
  route.closed = route.from_home = true;
  route.settle = 2.5;
  for (const SequenceMotion& motion : wanted.motions)
    route.motions.push_back({motion.from, motion.to, motion.points, motion.seconds, 0, "straight"});
  TargetSight reference;
  reference.target = "R1";
  route.references.push_back({2, {reference}});
  for (const PoseSequence& found :
       {parse_sequence(plan_json(plan), "plan.json"), parse_sequence(route_json(route), "route.json")}) {
    EXPECT_EQ(found.names, wanted.names);
    EXPECT_EQ(values_of(found), values_of(wanted));
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_EQ(found.poses[k].id, wanted.poses[k].id);
      EXPECT_EQ(found.poses[k].choices, plan.poses[k].choices);
      EXPECT_LT((found.poses[k].tool_pose->matrix() - wanted.poses[k].tool_pose->matrix()).norm(), 1e-14);
      EXPECT_EQ(found.poses[k].targets[1].hidden, wanted.poses[k].targets[1].hidden);
      EXPECT_EQ(found.poses[k].measured, !found.is_route && k == 1);
    }
  }
  const PoseSequence found = parse_sequence(route_json(route), "route.json");
  EXPECT_TRUE(found.is_route && found.closed && found.from_home);
  EXPECT_DOUBLE_EQ(found.settle, 2.5);
  for (std::size_t k = 0; k < wanted.motions.size(); ++k) EXPECT_EQ(found.motions[k].points, wanted.motions[k].points);
  for (const SequencePose& pose : found.poses) EXPECT_EQ(pose.references.size(), pose.id == 2 ? 1U : 0U);
  // A list as poses.csv has it.
  EXPECT_EQ(text_in("csv", parse_sequence(plan_json(plan), "plan.json")), poses_csv(plan));
  // A route whose motions were edited is not followed.
  route.motions[1].points.back()[0] += 0.1;
  EXPECT_THROW(parse_sequence(route_json(route), "route.json"), InputError);
  EXPECT_THROW(parse_sequence("{\"schema\": \"posewright/plan/1\", \"poses\": [{\"id\": 1}]}", "blocks.json"),
               InputError);
}

}  // namespace
}  // namespace posewright
