// Every criterion of the registry: what states say of swaps, additions and removals against Φ(M) from scratch, and Φ's
// derivatives against differences.

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "posewright/criterion/information_function.hpp"
#include "posewright/criterion/inverse_information.hpp"
#include "posewright/criterion/registry.hpp"
#include "posewright/criterion/reserve.hpp"
#include "posewright/criterion/sensitivity.hpp"
#include "posewright/support/random.hpp"
#include "tests/kit/random_blocks.hpp"

namespace posewright {
namespace {

constexpr int change_columns = 8;

CriterionData data_of(int nuisance) {
  CriterionData data{Eigen::MatrixXd::Identity(change_columns, change_columns),
                     Eigen::VectorXd::LinSpaced(change_columns, 0.5, 2.0), nuisance};
  const BlockArray points = random_blocks(3, 3, change_columns, 31);
  for (std::size_t t = 0; t < 3; ++t) {
    Eigen::MatrixXd A = points.block(t);
    A.leftCols(nuisance).setZero();
    data.test_points.push_back({A, 1.0 + double(t)});
  }
  data.effects = {2, random_blocks(1, 2, 3, 95).block(0), random_blocks(1, 3, change_columns - 2, 94).block(0),
                  random_blocks(1, 3, 3, 93).block(0)};
  data.variants = {{0, 4, nuisance, 1.0, 2.0}, {4, 4, 1, 3.0, 4.0}};
  return data;
}

Eigen::MatrixXd information(const BlockArray& blocks, const std::vector<int>& members) {
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(change_columns, change_columns);
  for (const int i : members) M += blocks.block(std::size_t(i)).transpose() * blocks.block(std::size_t(i));
  return M;
}

struct Case {
  std::string criterion;
  int rows, nuisance;
};
void PrintTo(const Case& c, std::ostream* out) {
  *out << c.criterion << ", r = " << c.rows << ", nuisance " << c.nuisance;
}

class Changes : public testing::TestWithParam<Case> {
 protected:
  Changes()
      : blocks(random_blocks(40, GetParam().rows, change_columns, 5)),
        criterion(make_criterion(GetParam().criterion, data_of(GetParam().nuisance))),
        view{&blocks, GetParam().nuisance, 1} {
    for (int i = 0; i < 14; ++i) start.push_back(2 * i);
  }
  double phi(const std::vector<int>& members) const {
    return criterion->function().value(information(blocks, members));
  }

  BlockArray blocks;
  std::unique_ptr<Criterion> criterion;
  CandidateView view;
  std::vector<int> start;
};

TEST_P(Changes, AThousandRandomSwapsKeepTheValueTrue) {
  const auto state = criterion->start(view, start);
  Random random(3, 0);
  for (int i = 0; i < 1000; ++i) {
    const int enter = random.index(40), position = random.index(14);
    if (!state->may_enter(enter)) continue;
    state->apply(position, enter);
    const double exact = phi(state->members());
    ASSERT_NEAR(state->value(), exact, 1e-8 * std::max(1.0, std::abs(exact))) << "swap " << i;
  }
}

TEST_P(Changes, TakenSwapsGainWhatIsRecomputedFromScratch) {
  Random random(4, 0);
  int taken = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const auto state = criterion->start(view, start);
    for (int i = 0; i < 5; ++i)
      if (const int enter = random.index(40); state->may_enter(enter)) state->apply(random.index(14), enter);
    for (int position = 0; position < 14; ++position) {
      const double before = phi(state->members());
      const Swap swap = state->best_swap(position, 1e-9);
      if (swap.enter < 0) continue;
      state->apply(position, swap.enter);
      ASSERT_NEAR(phi(state->members()) - before, swap.gain, 1e-7);
      ++taken;
    }
  }
  EXPECT_GT(taken, 300);
}

TEST_P(Changes, AdditionsAndRemovalsAreThoseOfTheInformation) {
  const auto state = criterion->start(view, start);
  for (int i = 0; i < 8; ++i) {
    const double before = phi(state->members());
    const Swap best = state->best_addition();
    ASSERT_GE(best.enter, 0);
    std::vector<int> after = state->members();
    after.push_back(best.enter);
    EXPECT_NEAR(phi(after) - before, best.gain, 1e-8);
    double most = -INFINITY;
    for (int j = 0; j < 40; ++j) {
      after.back() = j;
      if (state->may_enter(j)) most = std::max(most, phi(after) - before);
    }
    // Criteria without a formula look at the sixteen of largest derivative only.
    if (criterion->function().concave()) {
      EXPECT_NEAR(best.gain, most, 1e-8);
    }
    state->add(best.enter);
    EXPECT_NEAR(state->value(), phi(state->members()), 1e-8);
  }
  while (state->members().size() > 12) {
    const double before = phi(state->members());
    const double change = state->removal(3);
    state->remove(3);
    EXPECT_NEAR(phi(state->members()) - before, change, 1e-7);
  }
}

TEST_P(Changes, BannedAndCrowdedCandidatesNeverEnter) {
  Spacing spacing{Eigen::VectorXd::Constant(1, 3.0), Eigen::VectorXd::Zero(1)};
  spacing.points = Eigen::VectorXd::LinSpaced(40, 0, 39);
  view.spacing = &spacing;
  std::vector<int> sparse;
  for (int i = 0; i < 12; ++i) sparse.push_back(3 * i);
  const auto state = criterion->start(view, sparse);
  for (int j = 30; j < 37; ++j) state->ban(j, true);
  for (int pass = 0; pass < 4; ++pass)
    for (int p = 0; p < 12; ++p) {
      const Swap swap = state->best_swap(p, -INFINITY);
      if (swap.enter < 0) continue;
      EXPECT_FALSE(swap.enter >= 30 && swap.enter < 37);
      state->apply(p, swap.enter);
      for (int q = 0; q < 12; ++q)
        for (int s = 0; s < q; ++s)
          ASSERT_GE(std::abs(state->members()[std::size_t(q)] - state->members()[std::size_t(s)]), 3);
    }
}

TEST_P(Changes, GradientIsTheDerivativeAndTheExpansionIsItsFactor) {
  const InformationFunction& function = criterion->function();
  const Eigen::MatrixXd M = information(blocks, start);
  const Eigen::MatrixXd S = function.gradient(M);
  const auto derivative = [&](int i, const Eigen::MatrixXd& at) {
    const auto J = blocks.block(std::size_t(i));
    const Eigen::MatrixXd X = J.transpose() * J;
    constexpr double h = 1e-5;
    return (function.value(at + h * X) - function.value(at - h * X)) / (2 * h);
  };
  const auto along = [&](int i, const Eigen::MatrixXd& gradient) {
    const auto J = blocks.block(std::size_t(i));
    return (J * gradient * J.transpose()).trace();
  };
  for (int i = 0; i < 10; ++i) EXPECT_NEAR(along(i, S), derivative(i, M), 1e-6);
  // The worst of several things is expanded as a mean of them near it: its bound is tested by enumeration.
  for (const char* of_worst : {"maximin", "o3", "test_pose_max"})
    if (GetParam().criterion == of_worst) return;
  if (function.degree() == 0) return;
  const auto expansion = function.expand(M);
  EXPECT_NEAR(expansion->value, function.value(M), 1e-10);
  EXPECT_LT((expansion->factor * expansion->factor.transpose() - S).cwiseAbs().maxCoeff(), 1e-10);
  // Homogeneity: Φ(cM) = Φ(M) + h ln c, and Σ w d = h.
  EXPECT_NEAR(function.value(3 * M), function.value(M) + function.degree() * std::log(3.0), 1e-10);
  EXPECT_NEAR((S * M).trace(), function.degree(), 1e-9);
  BlockArray::RowMatrix rows(10 * blocks.rows(), change_columns);
  for (int i = 0; i < 10; ++i) rows.middleRows(i * blocks.rows(), blocks.rows()) = blocks.block(std::size_t(i));
  Eigen::MatrixXd H;
  expansion->curvature(rows, blocks.rows(), H);
  for (int j = 0; j < 10; ++j) {
    const auto J = blocks.block(std::size_t(j));
    const Eigen::MatrixXd X = 1e-5 * J.transpose() * J;
    const Eigen::MatrixXd change = (function.gradient(M + X) - function.gradient(M - X)) / 2e-5;
    for (int i = 0; i < 10; ++i) EXPECT_NEAR(H(i, j), -along(i, change), 1e-6);
  }
  const BlockArray::RowMatrix U = expansion->curvature_factor(rows, blocks.rows(), 1000);
  if (U.size() > 0) {
    EXPECT_LT((U * U.transpose() - H).cwiseAbs().maxCoeff(), 1e-10);
  }
  EXPECT_EQ(expansion->curvature_factor(rows, blocks.rows(), 5).size(), 0);
}

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (const CriterionEntry& entry : criterion_registry())
    for (const int rows : {1, 3})
      for (const int nuisance : {0, 2}) cases.push_back({entry.name, rows, nuisance});
  return cases;
}

INSTANTIATE_TEST_SUITE_P(All, Changes, testing::ValuesIn(all_cases()), [](const auto& instance) {
  return instance.param.criterion + "_r" + std::to_string(instance.param.rows) + "_nuisance" +
         std::to_string(instance.param.nuisance);
});

TEST(Drift, TenThousandSwapsLeaveTheRunningInverseWithin1e8) {
  // As every state does it: refreshed where an update would lose accuracy, and every forty swaps.
  const BlockArray blocks = random_blocks(200, 3, 12, 8);
  CriterionData data{Eigen::MatrixXd::Identity(12, 12), Eigen::VectorXd::Ones(12), 0};
  const auto criterion = make_criterion("o1", data);
  std::vector<int> members;
  for (int i = 0; i < 15; ++i) members.push_back(i);
  const auto state = criterion->start({&blocks, 0, 1}, members);
  Random random(1, 0);
  for (int swaps = 0; swaps < 10000;) {
    const int enter = random.index(200);
    if (!state->may_enter(enter)) continue;
    state->apply(random.index(15), enter);
    ++swaps;
  }
  InverseInformation fresh(blocks, 12, nullptr);
  ASSERT_TRUE(fresh.refresh(state->members(), 0));
  EXPECT_NEAR(state->value(), fresh.log_det(), 1e-8);
  for (int p = 0; p < 15; ++p) EXPECT_NEAR(state->loss(p), fresh.trace(state->members()[std::size_t(p)]), 1e-8);
}

TEST(Reserve, ValueIsTheWorstOfAllLossesAndSwapsRaiseIt) {
  const BlockArray blocks = random_blocks(60, 2, 6, 12);
  CriterionData data{Eigen::MatrixXd::Identity(6, 6), Eigen::VectorXd::Ones(6), 0};
  const auto inner = make_criterion("o1", data);
  const ReserveCriterion reserve(*inner);
  const auto state = reserve.start({&blocks, 0, 1}, {0, 1, 2, 3, 4, 5});
  const auto worst = [&] {
    double least = INFINITY;
    for (std::size_t i = 0; i < state->members().size(); ++i) {
      std::vector<int> left = state->members();
      left.erase(left.begin() + std::ptrdiff_t(i));
      least = std::min(least, inner->start({&blocks, 0, 1}, left)->value());
    }
    return least;
  };
  EXPECT_NEAR(state->value(), worst(), 1e-9);
  int taken = 0;
  for (int pass = 0; pass < 3; ++pass)
    for (int p = 0; p < 6; ++p) {
      const double before = state->value();
      const Swap swap = state->best_swap(p, 1e-9);
      if (swap.enter < 0) continue;
      state->apply(p, swap.enter);
      EXPECT_NEAR(state->value() - before, swap.gain, 1e-8);
      EXPECT_NEAR(state->value(), worst(), 1e-8);
      ++taken;
    }
  EXPECT_GT(taken, 3);
}

}  // namespace
}  // namespace posewright
