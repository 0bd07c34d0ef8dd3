// Plans that choose among the configurations of a user's list.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "posewright/problem/read_problem.hpp"
#include "posewright/results/plan.hpp"
#include "posewright/support/error.hpp"
#include "posewright/tasks/plan_problem.hpp"
#include "tests/kit/message_of.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

using testing::HasSubstr;

const char* const listed_urdf =
    "<robot name=\"planar\"><link name=\"l0\"/><link name=\"l1\"/><link name=\"l2\"/><link name=\"tip\"/>"
    "<joint name=\"q1\" type=\"revolute\"><parent link=\"l0\"/><child link=\"l1\"/><axis xyz=\"0 0 1\"/>"
    "<limit lower=\"-3\" upper=\"3\" effort=\"0\" velocity=\"1\"/></joint>"
    "<joint name=\"q2\" type=\"revolute\"><parent link=\"l1\"/><child link=\"l2\"/><origin xyz=\"1.2 0 0\"/>"
    "<axis xyz=\"0 0 1\"/><limit lower=\"-2\" upper=\"2\" effort=\"0\" velocity=\"1\"/></joint>"
    "<joint name=\"end\" type=\"fixed\"><parent link=\"l2\"/><child link=\"tip\"/><origin xyz=\"0.8 0 0\"/></joint>"
    "</robot>";

const std::string listed_start =
    "posewright: 1\nrobot: {urdf: planar.urdf}\nmeasurement: {type: points, targets: {T1: [0, 0, 0]}, components: [x, "
    "y], "
    "device: {type: isotropic, noise: 0.001}}\nvariants: {all: {parameters: [q1.offset, q2.offset, q2.x, "
    "target.T1.x]}}\n";

class ListedCandidates : public testing::Test {
 protected:
  Problem problem(const std::string& design) {
    folder_.write("planar.urdf", listed_urdf);
    return read_problem(folder_.write("p.yaml", listed_start + "design: " + design + "\n"));
  }
  Plan plan(const std::string& csv,
            const std::string& design = "{criterion: o1, poses: 3, candidates_from: list.csv}") {
    folder_.write("list.csv", csv);
    return plan_problem(problem(design), {}, Monitor{});
  }
  std::string refusal(const std::string& csv,
                      const std::string& design = "{criterion: o1, poses: 3, candidates_from: list.csv}") {
    return message_of<std::runtime_error>([&] { plan(csv, design); }, "accepted");
  }
  TemporaryFolder folder_;
};

TEST_F(ListedCandidates, ThePlanSaysWhereItsPosesStandAndRepeatsCountOnce) {
  const Plan found =
      plan("id,q1 [deg],q2 [deg]\n11,0,90\n11,0,90\n12,0,90.5\n# a remark\n13,10,-90\n14,20,0\n15,30,30\n13,10,-90\n");
  EXPECT_EQ(found.statistics.drawn, 5);
  EXPECT_EQ(found.statistics.feasible, 5);
  EXPECT_EQ(found.certificate.count, 5U);
  EXPECT_THAT(found.statistics.list, HasSubstr("list.csv"));
  ASSERT_EQ(found.poses.size(), 3U);
  const std::vector<int> ids{11, 12, 13, 14, 15}, lines{2, 4, 6, 7, 8};
  std::set<int> chosen;
  for (const PlannedPose& pose : found.poses) {
    ASSERT_TRUE(pose.candidate && pose.listed);
    const auto at = std::size_t(*pose.candidate);
    ASSERT_LT(at, ids.size());
    chosen.insert(*pose.candidate);
    EXPECT_EQ(pose.listed->id, ids[at]);
    EXPECT_EQ(pose.listed->line, lines[at]);
  }
  EXPECT_EQ(chosen.size(), 3U);
  EXPECT_THAT(plan_json(found), HasSubstr("\"listed\""));
}

TEST_F(ListedCandidates, NothingIsSoughtBeyondTheList) {
  const Plan found = plan("q1,q2\n0,1.5\n0.1,1.2\n0.2,-1\n0.3,0.5\n0.5,0.1\n");
  EXPECT_FALSE(found.certificate.workspace.has_value());
  EXPECT_GT(found.certificate.efficiency, 0.5);
  EXPECT_THAT(
      refusal("q1,q2\n0,1.5\n0.1,1.2\n0.2,-1\n0.3,0.5\n", "{poses: 3, method: continuous, candidates_from: list.csv}"),
      testing::Not(HasSubstr("accepted")));
}

TEST_F(ListedCandidates, WhatIsBeyondTheLimitsIsRejectedAndNamed) {
  const Plan found = plan("q1,q2\n0,1.5\n0.1,1.2\n0.2,-2.5\n0.3,0.5\n0.5,-0.7\n0,2.0000001\n");
  EXPECT_EQ(found.statistics.drawn, 6);
  EXPECT_EQ(found.statistics.feasible, 5) << "a hair beyond a limit is the limit";
  ASSERT_EQ(found.statistics.rejected.size(), 1U);
  EXPECT_EQ(found.statistics.rejected.front().second, 1);
  ASSERT_EQ(found.statistics.notes.size(), 2U);
  EXPECT_THAT(found.statistics.notes.back(), HasSubstr("1 pose is nearer to a limit than the margin"));
  EXPECT_THAT(found.statistics.notes.back(), HasSubstr(": 6"));
  EXPECT_THAT(found.statistics.notes.front(), HasSubstr("list.csv:4: pose 3 is rejected: "));
  EXPECT_THAT(found.statistics.notes.front(), HasSubstr("'q2' is -2.5 rad"));
  for (const PlannedPose& pose : found.poses) EXPECT_NE(*pose.candidate, 2);
  EXPECT_THAT(refusal("q1,q2\n0,2.5\n0.1,-2.2\n"), HasSubstr("has no feasible configuration"));
}

TEST_F(ListedCandidates, WhatWasMeasuredWasThereWhateverTheLimitsSay) {
  const std::string rows = "0,1.5,1,1\n0.1,1.2,1,1\n0.2,-2.5,1,1\n0.3,0.5,1,1\n";
  const Plan found = plan("q1,q2,T1.x,T1.y\n" + rows, "{criterion: o1, poses: 4, candidates_from: list.csv}");
  EXPECT_EQ(found.statistics.feasible, 4);
  EXPECT_TRUE(found.statistics.rejected.empty());
  ASSERT_EQ(found.statistics.notes.size(), 1U);
  EXPECT_THAT(found.statistics.notes.front(), HasSubstr("list.csv:4: pose 3 was measured, though the problem forbids"));
  // Columns that are not readings leave the list one that is still to be measured.
  EXPECT_THAT(refusal("q1,q2,x,y\n" + rows, "{poses: 4, candidates_from: list.csv}"),
              testing::Not(HasSubstr("accepted")));
}

TEST_F(ListedCandidates, BadListsAreToldWithFileAndLine) {
  EXPECT_THAT(refusal("q1\n0\n"), HasSubstr("list.csv:1: has no column 'q2'"));
  EXPECT_THAT(refusal("q1,q2\n0,1\n0,abc\n"), HasSubstr("list.csv:3: 'abc' of 'q2' is not a value"));
  EXPECT_THAT(refusal("q1,q2\n0,1\n", "{poses: 3, candidates: 5, candidates_from: list.csv}"),
              HasSubstr("cannot be combined with candidates"));
  EXPECT_THAT(refusal("q1,q2\n0,1\n0.1,1.2\n"), testing::Not(HasSubstr("accepted")));
}

}  // namespace
}  // namespace posewright
