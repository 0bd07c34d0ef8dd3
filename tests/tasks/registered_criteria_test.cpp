// A criterion that a program registers is treated as those of the table: value, bound and efficiency follow from its
// own function and never from its name.

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "posewright/criterion/registry.hpp"
#include "posewright/tasks/evaluate_problem.hpp"
#include "posewright/tasks/plan_problem.hpp"
#include "posewright/tasks/select_blocks.hpp"
#include "tests/kit/design_edits.hpp"
#include "tests/kit/example_problems.hpp"
#include "tests/kit/pose_lists.hpp"
#include "tests/kit/random_blocks.hpp"

namespace posewright {

std::unique_ptr<Criterion> make_squared_variances(const CriterionData& data);  // docs/extending.md

namespace {

/// The five-bar of the examples with a variant that has less, few candidates and test poses.
Problem five_bar() {
  Problem problem = example("five_bar/problem.yaml");
  VariantSpec few = problem.variants.front();
  few.name = "few";
  few.parameters = {{"leg_?.proximal", 1}, {"leg_?.offset", 1}};
  problem.variants = {few, problem.variants.front()};
  problem.design.poses->value = 9;
  problem.design.candidates.value = 80;
  problem.design.restarts.value = 1;
  problem.design.method.value = "exchange";
  problem.design.test_poses = TestPosesSpec{};
  problem.design.test_poses->random = 4;
  return problem;
}

/// The rows of the table, before anything is added.
const std::vector<CriterionEntry>& own_rows() {
  static const std::vector<CriterionEntry> rows(criterion_registry().begin(), criterion_registry().end());
  return rows;
}

/// The same criterion once more, by a name that nobody has heard of.
std::string another_name(const CriterionEntry& entry) {
  CriterionEntry again = entry;
  again.name = "registered_" + entry.name;
  if (find_criterion(again.name) == nullptr) register_criterion(again);
  return again.name;
}

class RegisteredCriteria : public testing::Test {
 protected:
  RegisteredCriteria() { own_rows(); }
  Plan plan(const std::string& criterion) const {
    DesignEdits options = DesignEdits().edit("criterion", criterion);
    if (find_criterion(criterion)->needs_truth) options.edit("truth", "links_and_offsets");
    return planned(problem_, options);
  }
  Problem problem_ = five_bar();
};

TEST_F(RegisteredCriteria, OfAnyNameGiveThePlanValueBoundAndEfficiencyOfTheirOwnFunction) {
  for (const CriterionEntry& entry : own_rows()) {
    const Plan known = plan(entry.name), again = plan(another_name(entry));
    EXPECT_EQ(known.criterion_value, again.criterion_value) << entry.name;
    EXPECT_EQ(known.certificate.proved, again.certificate.proved) << entry.name;
    EXPECT_EQ(known.certificate.bound, again.certificate.bound) << entry.name;
    EXPECT_EQ(known.certificate.efficiency, again.certificate.efficiency) << entry.name;
    for (std::size_t i = 0; i < known.poses.size(); ++i)
      EXPECT_EQ(known.poses[i].candidate, again.poses[i].candidate) << entry.name;
  }
}

TEST_F(RegisteredCriteria, OfAnyNameAreScoredAlikeInAListThatIsGiven) {
  const Plan made = plan("o1");
  for (const CriterionEntry& entry : own_rows()) another_name(entry);
  DesignEdits options = DesignEdits().edit("criterion", "registered_a").edit("truth", "links_and_offsets");
  const PoseListEvaluation e = evaluate_problem(options.of(problem_), planned_poses(problem_, made), {}, Monitor{});
  const auto score = [&](const std::string& name) {
    for (const CriterionScore& s : e.scores)
      if (s.name == name) return s;
    ADD_FAILURE() << name << " is not scored";
    return CriterionScore{};
  };
  EXPECT_LT(*score("a").efficiency, 0.999) << "a plan for another criterion is not the best by this one";
  for (const CriterionEntry& entry : own_rows()) {
    if (entry.several_variants) continue;
    EXPECT_EQ(score(entry.name).value, score("registered_" + entry.name).value) << entry.name;
    EXPECT_EQ(score(entry.name).efficiency, score("registered_" + entry.name).efficiency) << entry.name;
  }
  EXPECT_EQ(e.plan.certificate.efficiency, *score("a").efficiency);
}

TEST_F(RegisteredCriteria, ShownValuesAreThoseOfTheirDefinitions) {
  // Another road: variances, indices and errors as they stand in the plan, from the QR factor of the stacked rows.
  const auto near = [](double value, double expected, const std::string& what) {
    EXPECT_NEAR(value, expected, 1e-8 * std::abs(expected)) << what;
  };
  for (const CriterionEntry& entry : own_rows()) {
    const Plan p = plan(entry.name);
    double squares = 0;
    for (const PlannedParameter& parameter : p.parameters)
      squares += std::pow(*parameter.sigma / parameter.label.tolerance, 2);
    const double worst = *std::max_element(p.test_errors.begin(), p.test_errors.end());
    if (entry.name == "o1") near(p.criterion_value, p.indices.o1, entry.name);
    if (entry.name == "ds") near(p.criterion_value, p.log_det, entry.name);
    if (entry.name == "a") near(p.criterion_value, -squares, entry.name);
    if (entry.name == "o2") near(p.criterion_value, p.indices.o2, entry.name);
    if (entry.name == "o3") near(p.criterion_value, p.indices.o3, entry.name);
    if (entry.name == "o4") near(p.criterion_value, p.indices.o4, entry.name);
    if (entry.name == "o5") near(p.criterion_value, p.indices.o5, entry.name);
    if (entry.name == "test_pose") near(p.criterion_value, -*p.rho0 * *p.rho0, entry.name);
    if (entry.name == "test_pose_max") near(p.criterion_value, -worst * worst, entry.name);
    if (entry.name == "discriminate") near(p.criterion_value, p.discrimination->noncentrality(), entry.name);
    if (entry.name == "maximin" || entry.name == "compound") {
      const double one = p.variants[0].efficiency, other = p.variants[1].efficiency;
      near(p.criterion_value, entry.name == "maximin" ? std::min(one, other) : (std::log(one) + std::log(other)) / 2,
           entry.name);
    }
  }
}

TEST_F(RegisteredCriteria, OfTheGuideIsPlannedByAndItsValueIsThatOfItsDefinition) {
  if (find_criterion("phi2") == nullptr)
    register_criterion({.name = "phi2",
                        .summary = "root sum of squares of the variances",
                        .make = make_squared_variances,
                        .shown = shown_variance,
                        .scaled = true});
  BlockFile file;
  file.blocks = random_blocks(60, 2, 5, 3);
  for (int j = 0; j < 5; ++j) file.columns.push_back("c" + std::to_string(j));
  const BlockArray blocks = random_blocks(60, 2, 5, 3);
  SelectOptions options;
  options.criterion = "phi2";
  options.poses = 8;
  const Plan p = select_blocks(std::move(file), options, Monitor{});
  const auto variances = [&](const std::vector<int>& members) {
    const BlockArray chosen = blocks.subset(members);
    return Eigen::MatrixXd((chosen.all().transpose() * chosen.all()).inverse()).norm();
  };
  std::vector<int> members;
  for (const PlannedPose& pose : p.poses) members.push_back(*pose.candidate);
  EXPECT_NEAR(-p.criterion_value, variances(members), 1e-9 * variances(members));
  EXPECT_FALSE(p.certificate.proved) << "the guide's criterion states no degree, so it has no bound";
  // No other candidate in the place of one of them is better.
  for (std::size_t k = 0; k < members.size(); ++k)
    for (int i = 0; i < 60; ++i) {
      std::vector<int> other = members;
      other[k] = i;
      if (std::count(members.begin(), members.end(), i) == 0) {
        EXPECT_GE(variances(other), variances(members) * (1 - 1e-9));
      }
    }
}

TEST_F(RegisteredCriteria, NamesThatAreTakenAndRowsThatLackAFunctionAreRefused) {
  EXPECT_THROW(register_criterion(own_rows().front()), std::invalid_argument);
  EXPECT_THROW(register_criterion({.name = "empty", .summary = "", .make = nullptr, .shown = nullptr}),
               std::invalid_argument);
}

}  // namespace
}  // namespace posewright
