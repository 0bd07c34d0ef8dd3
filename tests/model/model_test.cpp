#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <numbers>

#include "posewright/model/model_factory.hpp"
#include "posewright/model/variant_columns.hpp"
#include "posewright/model/whitening.hpp"
#include "posewright/problem/read_problem.hpp"
#include "posewright/support/error.hpp"
#include "tests/kit/example_problems.hpp"

namespace posewright {
namespace {

using testing::HasSubstr;

TEST(Whitening, BlockTransposedTimesBlockIsGWeightedByTheInverseCovariance) {
  const Problem problem = example("telescope/problem.yaml");
  const auto model = make_model(problem);
  const std::vector<int> selected = {0, 1, 3, 8, 20, 53};
  const std::vector<double> q = {1e-3, -5e-4, 1e-4, 2e-3, -1e-3, 3e-3};
  Linearisation scratch;
  std::vector<double> out(6 * 8, -1.0);
  ASSERT_EQ(model->block_rows(selected), 6) << "four targets of three values tell of one pose";
  ASSERT_TRUE(whitened_block(*model, q, {}, selected, scratch, out.data(), 8));
  ASSERT_TRUE(model->linearise(q, {}, selected, scratch));
  const Eigen::Map<Eigen::Matrix<double, 6, 8, Eigen::RowMajor>> all(out.data());
  const Eigen::MatrixXd j = all.leftCols(6);
  const Eigen::MatrixXd expected = scratch.G.transpose() * scratch.covariance.inverse() * scratch.G;
  EXPECT_LT((j.transpose() * j - expected).norm(), 1e-9 * expected.norm());
  EXPECT_EQ(all(0, 6), -1) << "nothing beyond the columns is touched";
}

TEST(Whitening, RepeatsDivideTheReadingNoiseButNotWhatStaysAtAPose) {
  Problem problem = example("kr270/problem.yaml");
  problem.measurement.repeats = 4;
  problem.measurement.repeatability.translation = 3e-5;
  const auto model = make_model(problem);
  Linearisation scratch;
  ASSERT_TRUE(model->linearise(std::vector<double>{0.1, -1, 0.5, 0, 0.3, 0}, {}, std::vector<int>{0}, scratch));
  EXPECT_NEAR(scratch.covariance(4, 4), 1e-8 / 4 + 9e-10, 1e-20);
  EXPECT_EQ(scratch.covariance(4, 3), 0);
  EXPECT_NEAR(scratch.covariance(4, 1), 9e-10, 1e-20) << "all targets stand off alike";
}

TEST(Whitening, EncoderNoiseEntersThroughTheJointTwists) {
  Problem problem = example("kr270/problem.yaml");
  std::get<SerialArmSpec>(problem.robot).encoder_noise = 1e-5;
  const auto model = make_model(problem);
  std::vector<int> offsets;
  for (int i = 0; i < int(model->parameters().size()); ++i)
    if (model->parameters()[std::size_t(i)].name.ends_with(".offset")) offsets.push_back(i);
  ASSERT_EQ(offsets.size(), 6U);
  Linearisation scratch;
  ASSERT_TRUE(model->linearise(std::vector<double>{0.1, -1, 0.5, 0.2, 0.3, 0.4}, {}, offsets, scratch));
  // A joint offset moves the tip as a reading error does.
  const Eigen::MatrixXd expected =
      1e-8 / 3 * Eigen::MatrixXd::Identity(9, 9) + 1e-10 * scratch.G * scratch.G.transpose();
  EXPECT_LT((scratch.covariance - expected).norm(), 1e-12 * expected.norm());
}

TEST(Variant, GlobsNamesRolesAndTolerancesAreResolved) {
  const Problem problem = example("kr270/problem.yaml");
  const auto model = make_model(problem);
  const VariantColumns columns = select_columns(*model, {problem, problem.variants.front()});
  EXPECT_EQ(columns.nuisance, 15);
  ASSERT_EQ(columns.parameters.size(), 33U);
  EXPECT_EQ(columns.parameters[0].role, Role::nuisance);
  EXPECT_EQ(columns.parameters[15].name, "px1");
  EXPECT_NEAR(columns.parameters[15].nominal, 0.35, 1e-12);
  EXPECT_EQ(columns.parameters[32].name, "phiz5");
}

std::string complaint(Problem problem, const std::function<void(VariantSpec&)>& change) {
  change(problem.variants.front());
  try {
    select_columns(*make_model(problem), {problem, problem.variants.front()});
    return "accepted";
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(ListedPositions, EachHasTheParameterThatIsNamedAfterIt) {
  // The problem's order is descending; physics alone says which compliance bends the arm where.
  const Problem problem = example("kr270/elastostatic.yaml");
  const auto model = make_model(problem);
  const std::vector<std::pair<double, std::string>> places = {
      {-0.01, "-0.01deg"}, {-25.2, "-25.2deg"}, {-56.9, "-56.9deg"}, {-99.8, "-99.8deg"}, {-140, "-140deg"}};
  const auto& parameters = model->parameters();
  std::vector<int> selected;
  for (const auto& [degrees, text] : places)
    for (std::size_t i = 0; i < parameters.size(); ++i)
      if (parameters[i].name == "joint_a2.compliance@" + text) selected.push_back(int(i));
  ASSERT_EQ(selected.size(), 5U);
  EXPECT_TRUE(std::is_sorted(selected.begin(), selected.end())) << "parameters follow the file's order";
  for (std::size_t here = 0; here < places.size(); ++here) {
    const std::vector<double> q = {0.3, places[here].first * std::numbers::pi / 180, 0.4, 0.2, -0.5, 0.1, 1};
    Linearisation scratch;
    ASSERT_TRUE(model->linearise(q, {}, selected, scratch));
    for (std::size_t i = 0; i < places.size(); ++i)
      EXPECT_EQ(scratch.G.col(Eigen::Index(i)).norm() > 0, i == here)
          << places[i].second << " at " << places[here].second;
  }
}

TEST(Variant, NumbersOfListedPositionsAreRefusedBecauseTheyFollowedAnotherOrder) {
  EXPECT_THAT(
      complaint(example("kr270/elastostatic.yaml"),
                [](VariantSpec& v) {
                  v.parameters = {{"joint_a2.compliance_3", 7}};
                }),
      testing::AllOf(HasSubstr(":7: 'joint_a2.compliance_3' matches no parameter of this robot; compliances at listed "
                               "positions are named by their place, no longer by a number; parameters: "),
                     HasSubstr("joint_a2.compliance@-0.01deg, joint_a2.compliance@-25.2deg")));
}

TEST(Variant, BadPatternsNameWhatExists) {
  const Problem problem = example("kr270/problem.yaml");
  EXPECT_THAT(complaint(problem,
                        [](VariantSpec& v) {
                          v.parameters = {{"joint_9.*", 7}};
                        }),
              HasSubstr("problem.yaml:7: 'joint_9.*' matches no parameter of this robot; parameters: base.x"));
  EXPECT_THAT(complaint(problem,
                        [](VariantSpec& v) {
                          v.nuisance = {{"*", 8}};
                        }),
              HasSubstr("leaves no parameter of interest free"));
  EXPECT_THAT(complaint(problem,
                        [](VariantSpec& v) {
                          v.tolerance = {{{"dq2", 9}, 1e-3, Quantity::length}};
                        }),
              HasSubstr(":9: the tolerance of 'dq2' is in a unit"));
}

TEST(SixPus, PlatformAtReferenceNeedsAlmostNoActuation) {
  const auto model = make_model(example("telescope/problem.yaml"));
  std::vector<double> rho(6);
  ASSERT_TRUE(model->actuator_values(std::vector<double>(6, 0.0), rho));
  for (const double r : rho) EXPECT_NEAR(r, 0, 1e-5);
  EXPECT_FALSE(model->actuator_values(std::vector<double>{0.9, 0, 0, 0, 0, 0}, rho)) << "out of reach";
}

TEST(IdentificationModel, WrongSizesAreRefused) {
  const auto model = make_model(example("telescope/problem.yaml"));
  Linearisation scratch;
  EXPECT_THROW(model->linearise(std::vector<double>(5), {}, std::vector<int>{0}, scratch), std::invalid_argument);
  EXPECT_THROW(model->linearise(std::vector<double>(6), std::vector<double>(3), std::vector<int>{0}, scratch),
               std::invalid_argument);
}

}  // namespace
}  // namespace posewright
