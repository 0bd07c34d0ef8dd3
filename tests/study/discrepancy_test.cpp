// Planning against a truth that is not fitted, through the whole pipeline.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "posewright/planning/power.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/results/plan.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/json.hpp"
#include "posewright/tasks/compare_problem.hpp"
#include "posewright/tasks/evaluate_problem.hpp"
#include "tests/kit/design_edits.hpp"
#include "tests/kit/planar_arm.hpp"
#include "tests/kit/pose_lists.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {
namespace {

using testing::HasSubstr;

/// 2R arm, links 1 m and 0.8 m, position read with 0.1 mm; offsets and the tool are fitted, the truth has gears too, or
/// another length of the first link.
std::string arm(const std::string& design, const std::string& more = "") {
  return "posewright: 1\nrobot: {urdf: arm.urdf}\n"
         "measurement: {type: pose, components: [x, y], device: {type: isotropic, noise: {position: 0.1 mm, rotation: "
         "1 deg}}}\nvariants:\n"
         "  plain: {parameters: [q1.offset, q2.offset, tool.x]}\n"
         "  geared: {parameters: [q1.offset, q2.offset, tool.x, q1.gear, q2.gear], tolerance: {'*.gear': 2e-5}}\n"
         "  longer: {parameters: [q1.offset, q2.offset, tool.x], nominal: {q2.x: 1000.1 mm}}\n"
         "  both: {parameters: [q1.offset, q2.offset, tool.x, q1.gear], tolerance: {'*.gear': 2e-5}, nominal: {q2.x: "
         "1000.1 mm}}\n" +
         more + "design: " + design + "\n";
}

class Discrepancies : public testing::Test {
 protected:
  Problem problem(const std::string& design, const std::string& more = "") {
    folder_.write("arm.urdf", planar_arm_urdf);
    return read_problem(folder_.write("p.yaml", arm(design, more)));
  }
  static Plan plan(const Problem& problem, const std::string& criterion, const std::string& truth) {
    DesignEdits options = DesignEdits().edit("criterion", criterion).edit("truth", truth);
    return planned(problem, options);
  }
  TemporaryFolder folder_;
};

std::vector<std::vector<double>> configurations_of(const Plan& plan) {
  std::vector<std::vector<double>> list;
  for (const PlannedPose& pose : plan.poses) {
    list.emplace_back();
    for (const NamedValue& v : pose.configuration) list.back().push_back(v.value);
  }
  return list;
}

constexpr const char* six = "{variant: plain, poses: 6, candidates: 400, restarts: 3, test_poses: {random: 20}}";

TEST_F(Discrepancies, DiscriminateTellsMoreThanO1AndStaysBelowItsBound) {
  const Problem p = problem(six);
  for (const char* truth : {"geared", "longer", "both"}) {
    const Plan best = plan(p, "discriminate", truth), common = plan(p, "o1", truth);
    ASSERT_TRUE(best.discrimination && common.discrimination);
    // The other length is told best by what tells the offsets best: λ = N · (0.1 mm / 0.1 mm)².
    const bool alike = std::string(truth) == "longer";
    if (alike) {
      EXPECT_NEAR(best.discrimination->noncentrality(), 6, 1e-3);
    }
    EXPECT_GT(best.discrimination->noncentrality(), (alike ? 0.999 : 1.05) * common.discrimination->noncentrality());
    EXPECT_GT(*best.discrimination->power, *common.discrimination->power - 1e-3) << truth;
    EXPECT_NEAR(best.criterion_value, best.discrimination->noncentrality(), 1e-9);
    EXPECT_TRUE(best.certificate.proved);
    EXPECT_LE(std::log(best.criterion_value), best.certificate.bound);
    EXPECT_GT(best.certificate.efficiency, 0.9) << truth;
    EXPECT_GT(best.certificate.workspace->efficiency, 0.85) << truth;
    EXPECT_EQ(best.discrimination->degrees_of_freedom(), 6 * 2 - 3);
    EXPECT_NEAR(*best.discrimination->power, chi_square_power(best.criterion_value, 9, 0.05), 1e-12);
  }
}

TEST_F(Discrepancies, OneKnownEffectHasATestAlongItAndTolerancesHaveNone) {
  const Problem p = problem(six);
  const Plan longer = plan(p, "discriminate", "longer"), geared = plan(p, "discriminate", "geared"),
             both = plan(p, "discriminate", "both");
  EXPECT_GT(*longer.discrimination->power_along, *longer.discrimination->power);
  EXPECT_FALSE(longer.discrimination->by_tolerance);
  EXPECT_FALSE(geared.discrimination->power_along);
  EXPECT_FALSE(geared.discrimination->by_nominal);
  EXPECT_FALSE(both.discrimination->power_along);
  EXPECT_NEAR(both.discrimination->noncentrality(),
              *both.discrimination->by_nominal + *both.discrimination->by_tolerance, 1e-12);
}

TEST_F(Discrepancies, TheEvaluationOfAPlanRepeatsItsFigures) {
  const Problem p = problem(six);
  for (const char* criterion : {"discriminate", "bias"}) {
    const Plan made = plan(p, criterion, "both");
    DesignEdits options = DesignEdits().edit("criterion", criterion).edit("truth", "both");
    const PoseListEvaluation again =
        evaluate_problem(options.of(p), given_poses(p, configurations_of(made)), {}, Monitor{});
    EXPECT_NEAR(again.plan.criterion_value, made.criterion_value, 1e-9 * std::abs(made.criterion_value));
    EXPECT_NEAR(again.plan.discrimination->noncentrality(), made.discrimination->noncentrality(), 1e-9);
    const auto scored = [&](const std::string& name) {
      return std::any_of(again.scores.begin(), again.scores.end(), [&](const auto& s) { return s.name == name; });
    };
    EXPECT_TRUE(scored("discriminate") && scored("bias"));
  }
}

TEST_F(Discrepancies, BiasIsTheErrorThatComparePredicts) {
  for (const bool places : {true, false}) {
    const Problem p = problem(places ? six : "{variant: plain, poses: 6, candidates: 400, restarts: 3}");
    const Plan made = plan(p, "bias", "both");
    EXPECT_FALSE(made.certificate.proved);
    CompareOptions compare;
    compare.variants = {"plain", "both"};
    compare.truth = "both";
    compare.plans.push_back({"mine", given_poses(p, configurations_of(made))});
    DesignEdits few = DesignEdits().edit("candidates", 100);
    const Comparison c = compare_problem(few.of(p), compare, Monitor{});
    ASSERT_EQ(c.aliases.size(), 1U);
    const VariantAlias& alias = c.aliases.front();
    double expected = 0;
    if (places) {
      expected = std::pow(*alias.rho0, 2) + std::pow(alias.rho0_shift, 2) + std::pow(alias.rho0_spread, 2);
    } else {
      for (const AliasedParameter& q : alias.parameters)
        expected +=
            (std::pow(q.sigma, 2) + std::pow(q.shift, 2) + std::pow(q.spread, 2)) / std::pow(q.label.tolerance, 2);
    }
    EXPECT_NEAR(-made.criterion_value, expected, 1e-9 * expected);
    ASSERT_TRUE(alias.test);
    EXPECT_NEAR(alias.test->noncentrality(), made.discrimination->noncentrality(), 1e-9);
    EXPECT_NEAR(*alias.test->power, *made.discrimination->power, 1e-9);
  }
}

TEST_F(Discrepancies, BiasPlansErrLessThanPlansThatKnowOfNoiseAlone) {
  const Problem p = problem(six);
  EXPECT_GT(plan(p, "bias", "longer").criterion_value, [&] {
    DesignEdits options = DesignEdits().edit("criterion", "bias").edit("truth", "longer");
    return evaluate_problem(options.of(p), given_poses(p, configurations_of(plan(p, "test_pose", "longer"))), {},
                            Monitor{})
        .plan.criterion_value;
  }());
}

TEST_F(Discrepancies, MeasuredPosesAndPriorsCountInBothCriteria) {
  const Problem p = problem(six);
  const Plan first = plan(p, "discriminate", "both");
  for (const char* criterion : {"discriminate", "bias"})
    for (const bool prior : {false, true}) {
      DesignEdits options = DesignEdits()
                                .edit("criterion", criterion)
                                .edit("truth", "both")
                                .edit("poses", 4)
                                .edit("prior", prior ? "tolerance" : "none");
      options.measured = given_poses(p, configurations_of(first));
      const Plan more = planned(p, options);
      EXPECT_EQ(more.discrimination->readings, 20 + (prior ? 3 : 0));
      // More readings of the same effects leave more of them unexplained.
      if (!prior) {
        EXPECT_GT(more.discrimination->noncentrality(), first.discrimination->noncentrality());
      }
      if (more.certificate.proved) {
        EXPECT_LE(std::log(more.criterion_value), more.certificate.bound);
        EXPECT_GT(more.certificate.efficiency, 0.8);
      }
    }
}

TEST_F(Discrepancies, ThePlanFileSaysIt) {
  const Problem p = problem("{variant: plain, truth: longer, criterion: discriminate, poses: 6, candidates: 200}");
  const Plan made = plan_problem(p, {}, Monitor{});
  const auto json = parse_json(plan_json(made));
  EXPECT_EQ(json["discrimination"]["truth"], "longer");
  EXPECT_EQ(json["discrimination"]["degrees_of_freedom"], 9);
  EXPECT_TRUE(json["discrimination"]["by_tolerance"].is_null());
  EXPECT_THAT(plan_summary(made), HasSubstr("If longer is true, fitting plain leaves residuals of noncentrality"));
  EXPECT_THAT(plan_summary(made), HasSubstr("a chi-square test of 9 degrees of freedom at 5 % rejects plain with"));
  EXPECT_FALSE(parse_json(plan_json(plan(problem(six), "o1", ""))).contains("discrimination"));
}

template <class Error>
std::string message(const Problem& problem, const DesignEdits& options = {}) {
  try {
    planned(problem, options);
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST_F(Discrepancies, WhatCannotBeToldIsSaidWithItsPlace) {
  const std::string rest = "poses: 6, candidates: 100}",
                    alias_of_plain = "  same: {parameters: [q1.offset, q2.offset]}\n  denavit: {parameters: dh}\n";
  const auto said = [&](const std::string& design) {
    return message<InputError>(problem("{variant: plain, " + design + rest, alias_of_plain));
  };
  EXPECT_THAT(said("criterion: discriminate, "),
              HasSubstr("p.yaml:11: criterion 'discriminate' needs an alternative model"));
  EXPECT_THAT(said("truth: plain, "), HasSubstr("p.yaml:11: the truth 'plain' is the variant that is fitted"));
  EXPECT_THAT(said("truth: same, "), HasSubstr("p.yaml:11: truth 'same' has no effect that 'plain' does not estimate"));
  EXPECT_THAT(said("truth: denavit, "), HasSubstr("use different kinds of parameters"));
  EXPECT_THAT(said("truth: geared, criterion: compound, "), HasSubstr("needs a single fitted variant"));
  DesignEdits unknown = DesignEdits().edit("truth", "nobody");
  EXPECT_THAT(message<InputError>(problem(six), unknown), HasSubstr("nobody"));
  EXPECT_THROW(problem("{truth: nobody, " + rest), InputError);
}

TEST_F(Discrepancies, TooFewPosesForATestNameTheShortfall) {
  DesignEdits options = DesignEdits().edit("poses", 2).edit("truth", "geared").edit("criterion", "discriminate");
  const Problem wider = problem("{variant: four, poses: 6, candidates: 100}",
                                "  four: {parameters: [q1.offset, q2.offset, tool.x, q2.x]}\n");
  EXPECT_THAT(message<CannotDo>(wider, options),
              HasSubstr("2 poses give 4 equations for 4 parameters: no degree of freedom is left to distinguish 'four' "
                        "from 'geared'; at least 3 poses are needed"));
  options.edit("poses", 1);
  EXPECT_THAT(message<CannotDo>(wider, options), HasSubstr("1 poses determine 2 of 4 parameters"));
}

TEST_F(Discrepancies, AnEffectThatIsImitatedIsNoReasonForAPlan) {
  // The base's turn is the first joint's offset.
  const Problem p = problem("{variant: plain, truth: turned, criterion: discriminate, poses: 6, candidates: 100}",
                            "  turned: {parameters: [q1.offset, q2.offset, tool.x], nominal: {base.rz: 0.1 deg}}\n");
  EXPECT_THAT(message<CannotDo>(p), HasSubstr("'plain' reproduces every effect of 'turned' at every candidate"));
}

}  // namespace
}  // namespace posewright
