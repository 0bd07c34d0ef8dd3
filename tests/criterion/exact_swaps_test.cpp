// Best swaps and additions of criteria with a swap formula against every swap tried by Φ's definition: residuals of
// least squares, singular values and determinants of stacked rows, nothing shared with the product.

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "posewright/criterion/registry.hpp"
#include "posewright/support/random.hpp"
#include "tests/kit/random_blocks.hpp"

namespace posewright {
namespace {

constexpr int swap_columns = 8, swap_effects = 2, swap_candidates = 60;

// The power means that o3 is settled under first, from the nearest to o3 to the smoothest.
const std::map<std::string, double> means = {{"mean16", 16}, {"mean4", 4}, {"mean1", 1}};

struct SwapCase {
  std::string criterion;
  int rows, nuisance;
  bool prior;
  int repeats, poses;
};
void PrintTo(const SwapCase& c, std::ostream* out) {
  *out << c.criterion << ", r = " << c.rows << ", nuisance " << c.nuisance << (c.prior ? ", prior" : "") << ", repeats "
       << c.repeats << ", N = " << c.poses;
}

class ExactSwaps : public testing::TestWithParam<SwapCase> {
 protected:
  ExactSwaps()
      : blocks(random_blocks(swap_candidates, GetParam().rows, swap_columns, 15)),
        data{Eigen::MatrixXd::Identity(swap_columns, swap_columns), Eigen::VectorXd::LinSpaced(swap_columns, 0.4, 2.5),
             GetParam().nuisance} {
    // Candidates of unlike size, some of them nearly the same.
    Random random(3, 0);
    for (std::size_t i = 0; i < blocks.count(); ++i) blocks.block(i) *= std::exp(1.5 * random.uniform());
    for (std::size_t i = 50; i < blocks.count(); ++i) blocks.block(i) = 1.001 * blocks.block(i - 50);
    data.effects = {swap_effects, random_blocks(1, swap_effects, 3, 95).block(0),
                    random_blocks(1, 4, swap_columns - swap_effects, 96).block(0), random_blocks(1, 4, 3, 97).block(0)};
    data.variants = {{0, 4, GetParam().nuisance, 1.0, 2.0}, {4, 4, 1, 3.0, 4.0}};
    if (GetParam().criterion == "compound" || GetParam().criterion == "maximin") separate_rows();
    prior_rows = 0.3 * random_blocks(1, 3, swap_columns, 8).block(0);
    prior = prior_rows.transpose() * prior_rows;
    const bool mean = means.contains(GetParam().criterion);
    owner = make_criterion(mean ? "o3" : GetParam().criterion, data);
    criterion = owner.get();
    for (const char* name : {"mean16", "mean4", "mean1"}) {
      if (!mean) break;
      criterion = criterion->smoother();
      if (name == GetParam().criterion) break;
    }
    view = {&blocks, GetParam().nuisance, GetParam().repeats, GetParam().prior ? &prior : nullptr};
    for (int i = 0; i < GetParam().poses; ++i) start.push_back(i);
    if (GetParam().repeats > 1) start.back() = 0;
  }

  /// As the blocks of several variants are: rows of one below those of the other. One row stays common to both.
  void separate_rows() {
    if (GetParam().rows == 1) return;
    for (std::size_t i = 0; i < blocks.count(); ++i) {
      blocks.block(i).topRightCorner(1, 4).setZero();
      blocks.block(i).bottomLeftCorner(GetParam().rows - 1, 4).setZero();
    }
  }

  Eigen::MatrixXd stacked(const std::vector<int>& members) const {
    const Eigen::Index r = blocks.rows(), extra = GetParam().prior ? prior_rows.rows() : 0;
    Eigen::MatrixXd G(Eigen::Index(members.size()) * r + extra, swap_columns);
    for (std::size_t i = 0; i < members.size(); ++i)
      G.middleRows(Eigen::Index(i) * r, r) = blocks.block(std::size_t(members[i]));
    if (extra > 0) G.bottomRows(extra) = prior_rows;
    return G;
  }

  /// Singular values of the columns behind the first `nuisance`, less what those imitate.
  static Eigen::VectorXd singular_values(const Eigen::MatrixXd& G, Eigen::Index nuisance) {
    Eigen::MatrixXd X = G.rightCols(G.cols() - nuisance);
    if (nuisance > 0) X -= G.leftCols(nuisance) * G.leftCols(nuisance).colPivHouseholderQr().solve(X);
    return Eigen::JacobiSVD<Eigen::MatrixXd>(X).singularValues();
  }

  double definition(const std::vector<int>& members) const {
    const Eigen::MatrixXd G = stacked(members);
    const std::string& name = GetParam().criterion;
    const Eigen::MatrixXd A = G.leftCols(swap_columns - swap_effects);
    const Eigen::MatrixXd E = G.rightCols(swap_effects) * data.effects.mix;
    if (name == "bias") {
      const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> fit(A);
      const Eigen::MatrixXd& L = data.effects.error_rows;
      const Eigen::MatrixXd by_noise = L * fit.solve(Eigen::MatrixXd::Identity(A.rows(), A.rows()));
      return -std::log(by_noise.squaredNorm() + (L * fit.solve(E) - data.effects.error_offset).squaredNorm());
    }
    if (name == "discriminate") return std::log((E - A * A.colPivHouseholderQr().solve(E)).squaredNorm());
    if (name == "compound" || name == "maximin") {
      double sum = 0.0, least = INFINITY;
      for (const VariantGroup& v : data.variants) {
        const Eigen::VectorXd sigma = singular_values(G.middleCols(v.first, v.columns), v.nuisance);
        const double efficiency = (2 * sigma.array().log().sum() - v.reference) / double(v.columns - v.nuisance);
        sum += v.weight / 4.0 * efficiency;
        least = std::min(least, efficiency);
      }
      return name == "compound" ? sum : least;
    }
    const Eigen::VectorXd s = singular_values(G * data.scale.asDiagonal(), GetParam().nuisance);
    const double most = s[0], smallest = s[s.size() - 1];
    if (name == "o2") return std::log(smallest / most);
    if (name == "o3") return std::log(smallest);
    if (name == "o4") return std::log(smallest * smallest / most);
    if (means.contains(name)) return -std::log(s.array().pow(-2 * means.at(name)).sum()) / (2 * means.at(name));
    return -std::log(s.cwiseInverse().sum());
  }

  BlockArray blocks;
  CriterionData data;
  Eigen::MatrixXd prior_rows, prior;
  std::unique_ptr<Criterion> owner;
  const Criterion* criterion = nullptr;
  CandidateView view;
  std::vector<int> start;
};

TEST_P(ExactSwaps, TheChosenSwapIsThatOfTryingAll) {
  const auto state = criterion->start(view, start);
  int taken = 0;
  for (int pass = 0; pass < 3; ++pass)
    for (int position = 0; position < GetParam().poses; ++position) {
      const double before = definition(state->members());
      double best = 1e-9;
      for (int j = 0; j < swap_candidates; ++j) {
        if (!state->may_enter(j) || j == state->members()[std::size_t(position)]) continue;
        std::vector<int> other = state->members();
        other[std::size_t(position)] = j;
        best = std::max(best, definition(other) - before);
      }
      const Swap swap = state->best_swap(position, 1e-9);
      ASSERT_NEAR(swap.enter < 0 ? 1e-9 : swap.gain, best, 2e-8) << "pass " << pass << ", position " << position;
      if (swap.enter < 0) continue;
      state->apply(position, swap.enter);
      ASSERT_NEAR(definition(state->members()) - before, best, 2e-8);
      ++taken;
    }
  EXPECT_GT(taken, 2);
}

TEST_P(ExactSwaps, TheLeastBadSwapIsFoundToo) {
  // As tabu asks for it: no gain is too small.
  const auto state = criterion->start(view, start);
  for (int position = 0; position < GetParam().poses; ++position) {
    const double before = definition(state->members());
    double best = -INFINITY;
    for (int j = 0; j < swap_candidates; ++j) {
      if (!state->may_enter(j) || j == state->members()[std::size_t(position)]) continue;
      std::vector<int> other = state->members();
      other[std::size_t(position)] = j;
      best = std::max(best, definition(other) - before);
    }
    EXPECT_NEAR(state->best_swap(position, -INFINITY).gain, best, 2e-8);
  }
}

TEST_P(ExactSwaps, TheBestAdditionIsThatOfTryingAll) {
  const auto state = criterion->start(view, start);
  for (int i = 0; i < 4; ++i) {
    const double before = definition(state->members());
    std::vector<int> longer = state->members();
    longer.push_back(0);
    double best = -INFINITY;
    for (int j = 0; j < swap_candidates; ++j) {
      longer.back() = j;
      if (state->may_enter(j)) best = std::max(best, definition(longer) - before);
    }
    const Swap addition = state->best_addition();
    EXPECT_NEAR(addition.gain, best, 2e-8);
    state->add(addition.enter);
    EXPECT_NEAR(definition(state->members()) - before, best, 2e-8);
  }
}

std::vector<SwapCase> swap_cases() {
  std::vector<SwapCase> cases;
  for (const char* name :
       {"compound", "maximin", "discriminate", "bias", "o2", "o3", "o4", "o5", "mean16", "mean4", "mean1"})
    for (const int rows : {1, 2, 3})
      for (const int nuisance : {0, 2})
        for (const bool prior : {false, true}) {
          const int repeats = nuisance > 0 ? 3 : 1;
          cases.push_back({name, rows, nuisance, prior, repeats, 12});
          // As few rows as there are parameters, or one more: whoever leaves is indispensable.
          const bool two_variants = std::string(name) == "compound" || std::string(name) == "maximin";
          const int few = two_variants ? 5 : (swap_columns + rows) / rows;
          if (repeats == 1 && !prior) cases.push_back({name, rows, nuisance, prior, repeats, few});
        }
  return cases;
}

INSTANTIATE_TEST_SUITE_P(All, ExactSwaps, testing::ValuesIn(swap_cases()), [](const auto& instance) {
  const SwapCase& c = instance.param;
  return c.criterion + "_r" + std::to_string(c.rows) + "_nuisance" + std::to_string(c.nuisance) +
         (c.prior ? "_prior" : "") + "_repeats" + std::to_string(c.repeats) + "_N" + std::to_string(c.poses);
});

}  // namespace
}  // namespace posewright
