// Every criterion: value by its definition, derivative against differences, swaps against recomputation.

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <bit>
#include <cmath>

#include "posewright/criterion/observability_indices.hpp"
#include "posewright/criterion/registry.hpp"
#include "posewright/criterion/spectral.hpp"
#include "posewright/criterion/trace.hpp"
#include "posewright/planning/approximate_design.hpp"
#include "posewright/planning/whiten.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/random.hpp"
#include "tests/kit/random_blocks.hpp"

namespace posewright {
namespace {

constexpr int criteria_columns = 7, criteria_effects = 2, criteria_fitted = criteria_columns - criteria_effects;

/// Raw blocks of unequal units, and the same whitened.
struct Fixture {
  BlockArray raw, white;
  CriterionData data;

  Fixture(int rows, int nuisance, std::uint64_t seed, std::size_t count = 40)
      : raw(random_blocks(count, rows, criteria_columns, seed)) {
    for (std::size_t i = 0; i < raw.count(); ++i)
      for (int j = 0; j < criteria_columns; ++j) raw.block(i).col(j) *= std::pow(3.0, j - 3);
    std::vector<int> all(raw.count());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = int(i);
    white = raw.subset(all);
    data.R = whiten(white).R;
    data.scale = Eigen::VectorXd::LinSpaced(criteria_columns, 0.5, 3.0);
    data.nuisance = nuisance;
    const BlockArray points = random_blocks(3, 3, criteria_columns, 77);
    for (std::size_t t = 0; t < 3; ++t) {
      Eigen::MatrixXd A = points.block(t);
      A.leftCols(nuisance).setZero();
      data.test_points.push_back({A, double(t + 1)});
    }
    data.effects = {criteria_effects, random_blocks(1, criteria_effects, 3, 78).block(0),
                    random_blocks(1, 4, criteria_fitted, 79).block(0), random_blocks(1, 4, 3, 80).block(0)};
  }

  /// The same for criteria with a truth: residuals and errors of least squares, effect by effect.
  double definition_with_truth(const std::string& name, const std::vector<int>& members) const {
    const Eigen::MatrixXd X = raw.subset(members).all(), A = X.leftCols(criteria_fitted);
    const Eigen::MatrixXd E = X.rightCols(criteria_effects) * data.effects.mix;
    const Eigen::MatrixXd taken = A.colPivHouseholderQr().solve(E);
    if (name == "discriminate") return std::log((E - A * taken).squaredNorm());
    const Eigen::MatrixXd &L = data.effects.error_rows, covariance = (A.transpose() * A).inverse();
    return -std::log((L * covariance * L.transpose()).trace() + (L * taken - data.effects.error_offset).squaredNorm());
  }

  /// Φ of raw blocks by its definition, nothing shared with the product.
  double definition(const std::string& name, const std::vector<int>& members) const {
    if (find_criterion(name)->needs_truth) return definition_with_truth(name, members);
    Eigen::MatrixXd M = Eigen::MatrixXd::Zero(criteria_columns, criteria_columns);
    for (const int i : members) M += raw.block(std::size_t(i)).transpose() * raw.block(std::size_t(i));
    const Eigen::MatrixXd covariance = M.inverse();
    const int s = criteria_columns - data.nuisance;
    const Eigen::VectorXd unit = data.scale.tail(s).cwiseInverse();
    const Eigen::MatrixXd interest = unit.asDiagonal() * covariance.bottomRightCorner(s, s) * unit.asDiagonal();
    // Singular values of the scaled G with nuisance eliminated: λ(interest covariance)^{-1/2}.
    const Eigen::VectorXd variance = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(interest).eigenvalues();
    const Eigen::VectorXd sigma = variance.cwiseSqrt().cwiseInverse();  // descending, as variances ascend
    const ObservabilityIndices o = observability_indices(sigma, int(members.size()));
    if (name == "o2") return std::log(o.o2);
    if (name == "o3") return std::log(o.o3);
    if (name == "o4") return std::log(o.o4);
    if (name == "o5") return std::log(o.o5);
    if (name == "a") return -std::log(interest.trace());
    double sum = 0, total = 0, worst = 0;
    for (const TestPoint& t : data.test_points) {
      const double v = (t.A * covariance * t.A.transpose()).trace();
      sum += t.weight * v;
      total += t.weight;
      worst = std::max(worst, v);
    }
    return name == "test_pose" ? -std::log(sum / total) : -std::log(worst);
  }
};

class EveryCriterion : public testing::TestWithParam<std::string> {};

TEST_P(EveryCriterion, ValueIsItsDefinitionInAnyCoordinates) {
  for (const int rows : {1, 3})
    for (const int nuisance : {0, 2}) {
      const Fixture f(rows, nuisance, 3);
      const std::vector<int> members = {0, 3, 5, 8, 11, 20, 22, 30, 31};
      const auto criterion = make_criterion(GetParam(), f.data);
      const auto state = criterion->start({&f.white, nuisance, 1}, members);
      EXPECT_NEAR(state->value(), f.definition(GetParam(), members), 1e-7) << rows << nuisance;
    }
}

TEST_P(EveryCriterion, SwapsGainWhatTheySay) {
  for (const int rows : {1, 3})
    for (const int nuisance : {0, 2}) {
      const Fixture f(rows, nuisance, 4);
      std::vector<int> members = {0, 1, 2, 3, 4, 5, 6, 7, 8};
      const auto state = make_criterion(GetParam(), f.data)->start({&f.white, nuisance, 1}, members);
      int swaps = 0;
      for (int p = 0; p < 9; ++p) {
        const double before = state->value();
        const Swap swap = state->best_swap(p, 1e-9);
        if (swap.enter < 0) continue;
        state->apply(p, swap.enter);
        EXPECT_NEAR(state->value() - before, swap.gain, 1e-7);
        EXPECT_NEAR(state->value(), f.definition(GetParam(), state->members()), 1e-7);
        ++swaps;
      }
      EXPECT_GT(swaps, 1);
    }
}

TEST_P(EveryCriterion, BestSwapIsThatOfExhaustiveSearch) {
  // Criteria without a swap formula evaluate the best 16 by derivative: here that is all of them.
  const Fixture f(2, 1, 5, 20);
  std::vector<int> members = {0, 1, 2, 3, 4, 5};
  const auto state = make_criterion(GetParam(), f.data)->start({&f.white, 1, 1}, members);
  for (int p = 0; p < 6; ++p) {
    double best = 1e-9;
    for (int j = 6; j < 20; ++j) {
      std::vector<int> other = members;
      other[std::size_t(p)] = j;
      best = std::max(best, f.definition(GetParam(), other) - f.definition(GetParam(), members));
    }
    const Swap swap = state->best_swap(p, 1e-9);
    EXPECT_NEAR(swap.enter < 0 ? 1e-9 : swap.gain, best, 1e-7);
  }
}

TEST_P(EveryCriterion, NoWeightsAndNoDesignExceedItsBound) {
  for (const int nuisance : {0, 2}) {
    const Fixture f(2, nuisance, 7, 12);
    const auto criterion = make_criterion(GetParam(), f.data);
    const InformationFunction& function = criterion->function();
    if (function.degree() == 0) continue;
    Random random(9, std::uint64_t(nuisance));
    const auto information = [&](const std::vector<double>& weights) {
      Eigen::MatrixXd M = Eigen::MatrixXd::Zero(criteria_columns, criteria_columns);
      for (std::size_t i = 0; i < f.white.count(); ++i)
        M += weights[i] * f.white.block(i).transpose() * f.white.block(i);
      return M;
    };
    const auto draw = [&] {
      std::vector<double> weights;
      for (std::size_t i = 0; i < f.white.count(); ++i) weights.push_back(std::pow(random.uniform(), 3));
      return weights;
    };
    // The inequality that every bound rests on, from any weights to any others.
    for (int k = 0; k < 50; ++k) {
      const auto expansion = function.expand(information(draw()));
      ASSERT_NE(expansion, nullptr);
      const Eigen::MatrixXd M = information(draw());
      const double d = (expansion->factor.transpose() * M * expansion->factor).trace();
      EXPECT_LE(function.value(M),
                expansion->value + function.degree() * std::log(d / function.degree()) + 1e-10 * criteria_columns);
    }
    // All plans of six of the twelve.
    double best = -1e300;
    for (unsigned set = 0; set < 1U << 12; ++set) {
      if (std::popcount(set) != 6) continue;
      std::vector<double> weights(12);
      for (std::size_t i = 0; i < 12; ++i) weights[i] = double(set >> i & 1U);
      best = std::max(best, function.value(information(weights)));
    }
    ApproximateDesignOptions options;
    options.cap = 1.0 / 6;
    const double bound = solve_approximate_design(f.white, function, options, Monitor{}).bound_for(6);
    EXPECT_GE(bound, best);
    // A bound that says nothing would hold as well.
    EXPECT_LT((bound - best) / function.degree(), 0.7);
  }
}

class HomogeneousCriterion : public EveryCriterion {};

TEST_P(HomogeneousCriterion, ScaledInformationShiftsTheValueByAConstant) {
  // Φ of 4 M less Φ of M is the same for every design: what makes efficiencies comparable.
  const Fixture f(2, 1, 6);
  const auto criterion = make_criterion(GetParam(), f.data);
  const auto four_times = [&](std::vector<int> members) {
    const double once = criterion->start({&f.white, 1, 9}, members)->value();
    std::vector<int> four;
    for (int i = 0; i < 4; ++i) four.insert(four.end(), members.begin(), members.end());
    return criterion->start({&f.white, 1, 9}, four)->value() - once;
  };
  EXPECT_NEAR(four_times({0, 1, 2, 3, 4, 5}), four_times({10, 12, 14, 16, 18, 20}), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(All, EveryCriterion,
                         testing::Values("a", "o2", "o3", "o4", "o5", "test_pose", "test_pose_max", "discriminate",
                                         "bias"),
                         [](const auto& instance) { return instance.param; });
// More readings do not make a bias smaller.
INSTANTIATE_TEST_SUITE_P(All, HomogeneousCriterion,
                         testing::Values("a", "o2", "o3", "o4", "o5", "test_pose", "test_pose_max", "discriminate"),
                         [](const auto& instance) { return instance.param; });

TEST(Criteria, WhatTheyNeedIsAskedForByName) {
  CriterionData data{Eigen::MatrixXd::Identity(3, 3), Eigen::VectorXd::Ones(3), 0};
  for (const char* name : {"test_pose", "test_pose_max", "discriminate", "bias"})
    EXPECT_THROW(make_criterion(name, data), CannotDo);
}

}  // namespace
}  // namespace posewright
