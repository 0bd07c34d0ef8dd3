// Base and tool, geometry, stiffness one after the other lead where the joint estimate is.

#include "posewright/calibration/in_steps.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "posewright/model/model_factory.hpp"
#include "tests/kit/example_problems.hpp"
#include "tests/kit/virtual_data.hpp"

namespace posewright {
namespace {

TEST(Steps, GoneThroughUntilTheySettleEndAtTheJointEstimate) {
  const Problem problem = example("kr270/compensator.yaml");
  const VariantSpec& spec = find_variant(problem, "stiffness");
  const auto model = make_model({problem, spec});
  const VariantColumns columns = select_columns(*model, {problem, spec});
  Random random(4, 9);
  std::vector<MeasuredPose> poses = random_poses(*model, 60, random);
  read_poses_of(*model, random_truth(*model, columns, 0.1, random), 1.0, random, poses);
  FitOptions options;
  options.prior = Prior::manufactured;
  const Fit joint = fit(*model, columns, poses, options);
  const StepwiseFit stepwise = fit_in_steps(*model, columns, poses, options, joint);
  ASSERT_EQ(stepwise.steps.size(), 2U);  // no geometry in this variant
  EXPECT_EQ(stepwise.steps[0].name, "base and tool");
  EXPECT_EQ(stepwise.steps[1].name, "stiffness");
  EXPECT_EQ(stepwise.steps[0].columns + stepwise.steps[1].columns, int(columns.selected.size()));
  EXPECT_GT(stepwise.steps[0].scale, stepwise.steps[1].scale);
  EXPECT_TRUE(stepwise.settled);
  EXPECT_GT(stepwise.rounds, 2);
  for (std::size_t j = 0; j < columns.selected.size(); ++j) {
    const double sigma = std::sqrt(joint.covariance(Eigen::Index(j), Eigen::Index(j)));
    EXPECT_NEAR(stepwise.correction[std::size_t(columns.selected[j])], joint.change[Eigen::Index(j)], 0.1 * sigma)
        << columns.parameters[j].name;
  }
}

}  // namespace
}  // namespace posewright
