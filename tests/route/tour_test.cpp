#include "posewright/route/tour.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "posewright/support/random.hpp"

namespace posewright {
namespace {

/// Cost of visiting the nodes in that order.
double tour_cost(const Eigen::MatrixXd& cost, const std::vector<int>& order, bool closed) {
  double sum = closed && order.size() > 1 ? cost(order.back(), order.front()) : 0.0;
  for (std::size_t i = 1; i < order.size(); ++i) sum += cost(order[i - 1], order[i]);
  return sum;
}

/// Largest coordinate difference of random points, as times of joints that move together are.
Eigen::MatrixXd random_costs(int n, std::uint64_t seed) {
  Random random(seed, 0);
  Eigen::MatrixXd points(6, n);
  for (double& x : points.reshaped()) x = random.uniform();
  Eigen::MatrixXd cost(n, n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) cost(i, j) = (points.col(i) - points.col(j)).cwiseAbs().maxCoeff();
  return cost;
}

double cheapest_of_all(const Eigen::MatrixXd& cost, const TourOptions& options) {
  std::vector<int> order(static_cast<std::size_t>(cost.rows()));
  std::iota(order.begin(), order.end(), 0);
  double best = 1e300;
  do {
    if (options.start && order.front() != *options.start) continue;
    best = std::min(best, tour_cost(cost, order, options.closed));
  } while (std::next_permutation(order.begin(), order.end()));
  return best;
}

std::vector<TourOptions> kinds() {
  TourOptions open, closed, started, both;
  closed.closed = both.closed = true;
  started.start = both.start = 2;
  return {open, closed, started, both};
}

void expect_all_once(const std::vector<int>& order, int n, const TourOptions& options) {
  std::vector<int> sorted = order;
  std::sort(sorted.begin(), sorted.end());
  std::vector<int> all(static_cast<std::size_t>(n));
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(sorted, all);
  if (options.start) {
    EXPECT_EQ(order.front(), *options.start);
  }
}

TEST(Tour, FewNodesAreSolvedExactly) {
  for (int n = 3; n <= 8; ++n)
    for (const TourOptions& options : kinds()) {
      const Eigen::MatrixXd cost = random_costs(n, std::uint64_t(n));
      const std::vector<int> order = cheapest_tour(cost, options);
      expect_all_once(order, n, options);
      EXPECT_NEAR(tour_cost(cost, order, options.closed), cheapest_of_all(cost, options), 1e-12) << n;
    }
}

TEST(Tour, LocalSearchIsWithin5PercentOfTheOptimumOn20ProblemsOf12) {
  for (std::uint64_t problem = 0; problem < 20; ++problem)
    for (TourOptions options : kinds()) {
      const Eigen::MatrixXd cost = random_costs(12, 100 + problem);
      const double best = tour_cost(cost, cheapest_tour(cost, options), options.closed);
      options.exact = false;
      const std::vector<int> order = cheapest_tour(cost, options);
      expect_all_once(order, 12, options);
      const double found = tour_cost(cost, order, options.closed);
      EXPECT_GE(found, best - 1e-12);
      EXPECT_LE(found, 1.05 * best) << problem;
    }
}

TEST(Tour, NodesOnACircleAreVisitedAroundIt) {
  const int n = 60;
  Eigen::MatrixXd cost(n, n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      // Shuffled, so that the order given is not a help.
      const double a = 2 * M_PI * ((i * 23) % n) / n, b = 2 * M_PI * ((j * 23) % n) / n;
      cost(i, j) = std::hypot(std::cos(a) - std::cos(b), std::sin(a) - std::sin(b));
    }
  TourOptions options;
  options.closed = true;
  EXPECT_NEAR(tour_cost(cost, cheapest_tour(cost, options), true), 2 * n * std::sin(M_PI / n), 1e-9);
}

TEST(Tour, IsTheSameOnEveryRunAndForOneAndTwoNodes) {
  const Eigen::MatrixXd cost = random_costs(40, 3);
  EXPECT_EQ(cheapest_tour(cost, {}), cheapest_tour(cost, {}));
  EXPECT_EQ(cheapest_tour(Eigen::MatrixXd::Zero(1, 1), {}), std::vector<int>{0});
  TourOptions from_second;
  from_second.start = 1;
  EXPECT_EQ(cheapest_tour(Eigen::MatrixXd::Zero(2, 2), from_second), (std::vector<int>{1, 0}));
}

TEST(Tour, RefusesCostsThatAreNone) {
  EXPECT_THROW(cheapest_tour(Eigen::MatrixXd::Zero(2, 3), {}), std::invalid_argument);
  EXPECT_THROW(cheapest_tour(Eigen::MatrixXd::Constant(3, 3, -1), {}), std::invalid_argument);
  EXPECT_THROW(cheapest_tour(Eigen::MatrixXd::Constant(3, 3, NAN), {}), std::invalid_argument);
}

}  // namespace
}  // namespace posewright
