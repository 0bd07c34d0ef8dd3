// Components of variance against the likelihood by definition, and the two cases that they are for.

#include "src/calibration/restricted_likelihood.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "posewright/support/dense.hpp"
#include "posewright/support/random.hpp"

namespace posewright {
namespace {

/// Readings of random columns: `flat` ones of which nothing is known, then those of one group with these values.
ComponentProblem problem_of(const Eigen::VectorXd& truth, int flat, int readings, Random& random) {
  ComponentProblem problem;
  problem.J.resize(readings, truth.size());
  for (double& value : problem.J.reshaped()) value = random.normal();
  problem.y = problem.J * truth;
  for (double& value : problem.y) value += random.normal();
  problem.precision = problem.about = Eigen::VectorXd::Zero(truth.size());
  problem.group.assign(std::size_t(truth.size()), 0);
  std::fill_n(problem.group.begin(), flat, -1);
  return problem;
}

/// −½ ln|V| − ½ ln|XᵀV⁻¹X| − ½ rᵀPr, V = I + s² Z Zᵀ, and the decade about one.
double restricted_likelihood(const ComponentProblem& problem, int flat, double s) {
  const Eigen::MatrixXd X = problem.J.leftCols(flat), Z = problem.J.rightCols(problem.J.cols() - flat);
  const Eigen::MatrixXd V = Eigen::MatrixXd::Identity(X.rows(), X.rows()) + s * s * Z * Z.transpose();
  const Eigen::LLT<Eigen::MatrixXd> root(V);
  const Eigen::MatrixXd M = X.transpose() * root.solve(X);
  const Eigen::LLT<Eigen::MatrixXd> small(M);
  const Eigen::VectorXd b = X.transpose() * root.solve(problem.y);
  const auto log_det = [](const Eigen::LLT<Eigen::MatrixXd>& llt) {
    return 2 * Eigen::MatrixXd(llt.matrixL()).diagonal().array().log().sum();
  };
  return -0.5 * (log_det(root) + log_det(small) + problem.y.dot(root.solve(problem.y)) - b.dot(small.solve(b)) +
                 std::pow(std::log(s) / std::log(10.0), 2));
}

TEST(RestrictedLikelihood, TheSizeOfAGroupIsWhereTheLikelihoodByDefinitionIsLargest) {
  Random random(11, 1);
  for (const double size : {1.5, 4.0, 20.0}) {
    Eigen::VectorXd truth(34);
    for (double& value : truth) value = size * random.normal();
    const ComponentProblem problem = problem_of(truth, 4, 60, random);
    const VarianceComponents found = restricted_components(problem);
    ASSERT_TRUE(found.own.empty());
    const double s = found.spread[10];
    EXPECT_EQ(found.spread[0], 1.0) << "nothing is known of it";
    const double here = restricted_likelihood(problem, 4, s);
    for (double other = 1.0; other < 100; other *= 1.05)
      EXPECT_LE(restricted_likelihood(problem, 4, other), here + 1e-6) << other << " against " << s;
  }
}

TEST(RestrictedLikelihood, OneColumnThatIsFarOffHasItsOwnSizeAndTheOthersKeepTheirs) {
  Random random(12, 1);
  for (const double off : {10.0, 40.0, 200.0}) {
    Eigen::VectorXd truth(30);
    for (double& value : truth) value = 0.7 * random.normal();
    truth[17] = off;
    const VarianceComponents found = restricted_components(problem_of(truth, 4, 60, random));
    ASSERT_EQ(found.own, std::vector<int>{17}) << off;
    EXPECT_NEAR(found.spread[17], off, 0.3 * off);
    EXPECT_LT(found.spread[20], 2.0) << off;
  }
}

TEST(RestrictedLikelihood, ManySmallColumnsAreShrunkAndNoneIsTakenForAnotherOne) {
  Random random(13, 1);
  int own = 0;
  for (int draw = 0; draw < 100; ++draw) {
    Eigen::VectorXd truth(34);
    for (double& value : truth) value = random.normal();
    const VarianceComponents found = restricted_components(problem_of(truth, 4, 50, random));
    own += found.own.empty() ? 0 : 1;
    EXPECT_LT(found.spread[20], 2.0);
  }
  EXPECT_LE(own, 5) << "a chance of one in a hundred each";
}

TEST(RestrictedLikelihood, AStatedSizeThatTheReadingsContradictIsNamedAndKept) {
  Random random(14, 1);
  Eigen::VectorXd truth = Eigen::VectorXd::Zero(20);
  truth[5] = 8.0;
  ComponentProblem problem = problem_of(truth, 20, 60, random);
  problem.precision.setOnes();
  const VarianceComponents found = restricted_components(problem);
  EXPECT_EQ(found.contradicted, std::vector<int>{5});
  EXPECT_EQ(found.spread[5], 1.0);
}

}  // namespace
}  // namespace posewright
