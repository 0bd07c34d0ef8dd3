// Prior knowledge in evaluation, search and bound; what is worth identifying.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "posewright/planning/evaluate.hpp"
#include "posewright/planning/practical_identifiability.hpp"
#include "posewright/search/search.hpp"
#include "tests/kit/random_blocks.hpp"

namespace posewright {
namespace {

std::vector<Parameter> prior_labels(int count, int nuisance) {
  std::vector<Parameter> parameters;
  for (int j = 0; j < count; ++j)
    parameters.push_back(
        {"p" + std::to_string(j), "m", 0, 0.3 + 0.1 * j, j < nuisance ? Role::nuisance : Role::interest});
  return parameters;
}

Eigen::VectorXd tolerances(const std::vector<Parameter>& parameters) {
  Eigen::VectorXd t(Eigen::Index(parameters.size()));
  for (std::size_t j = 0; j < parameters.size(); ++j) t[Eigen::Index(j)] = parameters[j].tolerance;
  return t;
}

TEST(Prior, EvaluationCountsEveryToleranceAsOneMoreMeasurement) {
  const BlockArray blocks = random_blocks(3, 2, 7, 1);  // six rows for seven parameters
  const std::vector<Parameter> parameters = prior_labels(7, 2);
  Eigen::MatrixXd m = blocks.all().transpose() * blocks.all();
  m += tolerances(parameters).cwiseAbs2().cwiseInverse().asDiagonal();
  const Eigen::MatrixXd covariance = m.inverse();
  const Evaluation e = evaluate(blocks, parameters, Prior::every);
  for (int j = 0; j < 7; ++j) {
    EXPECT_NEAR(e.sigma[j], std::sqrt(covariance(j, j)), 1e-12);
    EXPECT_LT(e.sigma[j], parameters[std::size_t(j)].tolerance);
  }
  EXPECT_NEAR(e.log_det_full, std::log(m.determinant()), 1e-10);
  EXPECT_LT(e.contribution.sum(), 1) << "the rest is the prior's";
}

/// Best three of eight by trying all.
double best_of_three(const BlockArray& blocks, const std::vector<Parameter>& parameters) {
  double best = -INFINITY;
  for (int a = 0; a < 8; ++a)
    for (int b = a + 1; b < 8; ++b)
      for (int c = b + 1; c < 8; ++c)
        best = std::max(best, evaluate(blocks.subset({a, b, c}), parameters, Prior::every).log_det);
  return best;
}

TEST(Prior, SearchFindsTheBestPlanAndTheBoundHolds) {
  for (const int nuisance : {0, 2})
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
      const BlockArray blocks = random_blocks(8, 2, 7, 50 + seed);
      const std::vector<Parameter> parameters = prior_labels(7, nuisance);
      SearchRequest request;
      request.criterion = "o1";
      request.method = "exchange";
      request.poses = 3;
      const auto part = [&](const std::vector<int>& members) {
        std::vector<SearchPart> parts(1);
        parts[0].blocks = blocks.subset(members);
        parts[0].nuisance = nuisance;
        parts[0].scale = tolerances(parameters);
        parts[0].prior = tolerances(parameters).cwiseAbs2().cwiseInverse().asDiagonal();
        return parts;
      };
      std::vector<int> all = {0, 1, 2, 3, 4, 5, 6, 7};
      const SearchResult found = search(part(all), request, Monitor{});
      const double value = evaluate(blocks.subset(found.design.members), parameters, Prior::every).log_det;
      const double best = best_of_three(blocks, parameters);
      EXPECT_NEAR(value, best, 1e-9) << nuisance << " " << seed;
      EXPECT_GE(found.certificate.bound, best - 1e-9);
      EXPECT_LT(found.certificate.bound, best + 2) << "the bound is of some use";
      EXPECT_LT(found.certificate.max_sensitivity_ratio, 1 + 1e-6);
      // The search's own value, whitened coordinates, differs by a constant only.
      request.poses = 8;
      const SearchResult everything = search(part(all), request, Monitor{});
      EXPECT_NEAR(everything.certificate.bound, evaluate(blocks.subset(all), parameters, Prior::every).log_det, 1e-6)
          << "with all candidates in it the bound is the plan";
    }
}

TEST(PracticalIdentifiability, WithAllCandidatesChosenSigmaIsThatOfTheWholePool) {
  const BlockArray pool = random_blocks(12, 2, 6, 3);
  const std::vector<Parameter> parameters = prior_labels(6, 1);
  const PracticalIdentifiability p = practical_identifiability(pool, parameters, 12, 0.1, Monitor{});
  const Evaluation e = evaluate(pool, parameters);
  for (int j = 0; j < 6; ++j) {
    EXPECT_NEAR(p.sigma[j], e.sigma[j], 1e-9);
    const Eigen::VectorXd column = pool.all().col(j);
    Eigen::MatrixXd others(column.size(), 5);
    for (int k = 0, at = 0; k < 6; ++k)
      if (k != j) others.col(at++) = pool.all().col(k);
    const Eigen::VectorXd rest = column - others * others.householderQr().solve(column);
    EXPECT_NEAR(p.unexplained[j], rest.norm() / column.norm(), 1e-9) << "√(1 − R²) by regression";
  }
  EXPECT_TRUE(p.near.empty());
}

TEST(PracticalIdentifiability, NearCopiesAreNamedAndTheWorstIsFixedFirst) {
  BlockArray pool = random_blocks(200, 2, 5, 4);
  const BlockArray noise = random_blocks(200, 2, 5, 5);
  for (std::size_t i = 0; i < pool.count(); ++i)
    pool.block(i).col(3) = 2 * pool.block(i).col(1) + 0.002 * noise.block(i).col(0);
  std::vector<Parameter> parameters = prior_labels(5, 0);
  const PracticalIdentifiability p = practical_identifiability(pool, parameters, 20, 0.1, Monitor{});
  ASSERT_EQ(p.near.size(), 2U);
  std::vector<std::string> equations;
  for (const Dependency& d : p.near) equations.push_back(describe(d, parameters));
  EXPECT_THAT(equations, testing::UnorderedElementsAre("p3 = 2·p1", "p1 = 0.5·p3"));
  // σ of the pair is hundreds of times the others'; with one of them fixed the other is as good as any.
  EXPECT_GT(p.sigma[1], parameters[1].tolerance);
  EXPECT_GT(p.sigma[3], parameters[3].tolerance);
  EXPECT_EQ(p.recommended.size(), 4U);
  EXPECT_THAT(p.recommended, testing::IsSupersetOf({0, 2, 4}));
}

TEST(PracticalIdentifiability, NuisanceParametersAreNeverFixed) {
  const BlockArray pool = random_blocks(50, 2, 4, 6);
  std::vector<Parameter> parameters = prior_labels(4, 1);
  for (Parameter& p : parameters) p.tolerance = 1e-9;
  const PracticalIdentifiability p = practical_identifiability(pool, parameters, 5, 0.1, Monitor{});
  EXPECT_EQ(p.recommended, std::vector<int>{0});
}

}  // namespace
}  // namespace posewright
