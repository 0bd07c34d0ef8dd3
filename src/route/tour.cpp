#include "posewright/route/tour.hpp"

#include <algorithm>
#include <array>
#include <boost/graph/adjacency_matrix.hpp>
#include <boost/graph/metric_tsp_approx.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "posewright/support/random.hpp"

namespace posewright {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Held & Karp: best[set][last] = cheapest way through `set` that ends in `last`.
std::vector<int> by_dynamic_programming(const Eigen::MatrixXd& cost, const TourOptions& options) {
  const int n = int(cost.rows());
  const std::size_t sets = std::size_t(1) << n;
  std::vector<double> best(sets * std::size_t(n), infinity);
  std::vector<int> before(best.size(), -1);
  const auto at = [n](std::size_t set, int last) { return set * std::size_t(n) + std::size_t(last); };
  // A closed tour may begin anywhere.
  const int first = options.start.value_or(options.closed ? 0 : -1);
  for (int k = 0; k < n; ++k)
    if (first < 0 || k == first) best[at(std::size_t(1) << k, k)] = 0;
  for (std::size_t set = 1; set < sets; ++set)
    for (int last = 0; last < n; ++last) {
      if (best[at(set, last)] == infinity) continue;
      for (int next = 0; next < n; ++next) {
        if ((set >> next) & 1U) continue;
        const std::size_t more = set | (std::size_t(1) << next);
        const double value = best[at(set, last)] + cost(last, next);
        if (value >= best[at(more, next)]) continue;
        best[at(more, next)] = value;
        before[at(more, next)] = last;
      }
    }
  int last = 0;
  const auto total = [&](int end) { return best[at(sets - 1, end)] + (options.closed ? cost(end, first) : 0.0); };
  for (int k = 1; k < n; ++k)
    if (total(k) < total(last)) last = k;
  std::vector<int> order;
  for (std::size_t set = sets - 1; last >= 0;) {
    order.push_back(last);
    const int previous = before[at(set, last)];
    set &= ~(std::size_t(1) << last);
    last = previous;
  }
  std::reverse(order.begin(), order.end());
  return order;
}

std::vector<int> by_spanning_tree(const Eigen::MatrixXd& cost) {
  using Graph =
      boost::adjacency_matrix<boost::undirectedS, boost::no_property, boost::property<boost::edge_weight_t, double>>;
  const auto n = std::size_t(cost.rows());
  Graph graph(n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j) boost::add_edge(i, j, cost(Eigen::Index(i), Eigen::Index(j)), graph);
  std::vector<std::size_t> tour;
  boost::metric_tsp_approx_tour(graph, std::back_inserter(tour));
  tour.pop_back();
  return {tour.begin(), tour.end()};
}

/// A cycle over all nodes and, for an open tour, one more that costs nothing to go to or leave; where the first node is
/// given, it and that one always stay neighbours.
class Cycle {
 public:
  Cycle(const Eigen::MatrixXd& cost, const TourOptions& options) : n_(int(cost.rows())) {
    if (options.closed) {
      cost_ = cost;
      return;
    }
    cost_ = Eigen::MatrixXd::Zero(n_ + 1, n_ + 1);
    cost_.topLeftCorner(n_, n_) = cost;
    if (options.start) cost_(n_, *options.start) = cost_(*options.start, n_) = -1e3 * (1 + cost.sum());
  }

  std::vector<int> start(std::vector<int> tour) const {
    if (cost_.rows() > n_) tour.push_back(n_);
    return tour;
  }

  double length(const std::vector<int>& tour) const {
    double sum = cost_(tour.back(), tour.front());
    for (std::size_t i = 1; i < tour.size(); ++i) sum += cost_(tour[i - 1], tour[i]);
    return sum;
  }

  /// Reverses and moves stretches as long as that makes the tour shorter.
  void improve(std::vector<int>& tour) const {
    while (reverse_one(tour) || move_one(tour)) {
    }
  }

  /// The order from the free node on, or from `first` on.
  std::vector<int> open(std::vector<int> tour, std::optional<int> first) const {
    if (cost_.rows() > n_) {
      std::rotate(tour.begin(), std::find(tour.begin(), tour.end(), n_), tour.end());
      tour.erase(tour.begin());
      if (first && tour.front() != *first) std::reverse(tour.begin(), tour.end());
    } else if (first) {
      std::rotate(tour.begin(), std::find(tour.begin(), tour.end(), *first), tour.end());
    }
    return tour;
  }

 private:
  static constexpr double least_gain = 1e-12;

  bool reverse_one(std::vector<int>& tour) const {
    const std::size_t n = tour.size();
    for (std::size_t i = 0; i + 1 < n; ++i)
      for (std::size_t j = i + 1; j < n; ++j) {
        const int before = tour[(i + n - 1) % n], after = tour[(j + 1) % n];
        if (before == tour[j]) continue;
        const double gain =
            cost_(before, tour[i]) + cost_(tour[j], after) - cost_(before, tour[j]) - cost_(tour[i], after);
        if (gain <= least_gain * (1 + std::abs(cost_(before, tour[i])))) continue;
        std::reverse(tour.begin() + std::ptrdiff_t(i), tour.begin() + std::ptrdiff_t(j) + 1);
        return true;
      }
    return false;
  }

  /// Up to three nodes in a row to another place, either way round.
  bool move_one(std::vector<int>& tour) const {
    const std::size_t n = tour.size();
    for (std::size_t count = 1; count <= 3 && count + 2 <= n; ++count)
      for (std::size_t shift = 0; shift < n; ++shift) {
        std::vector<int> rest = tour;
        std::rotate(rest.begin(), rest.begin() + std::ptrdiff_t(shift), rest.end());
        const std::vector<int> part(rest.begin(), rest.begin() + std::ptrdiff_t(count));
        rest.erase(rest.begin(), rest.begin() + std::ptrdiff_t(count));
        const double out =
            cost_(rest.back(), part.front()) + cost_(part.back(), rest.front()) - cost_(rest.back(), rest.front());
        for (std::size_t i = 0; i + 1 < rest.size(); ++i)
          for (const bool turned : {false, true}) {
            const int head = turned ? part.back() : part.front(), tail = turned ? part.front() : part.back();
            const double in = cost_(rest[i], head) + cost_(tail, rest[i + 1]) - cost_(rest[i], rest[i + 1]);
            if (out - in <= least_gain * (1 + std::abs(out))) continue;
            std::vector<int> placed = part;
            if (turned) std::reverse(placed.begin(), placed.end());
            rest.insert(rest.begin() + std::ptrdiff_t(i) + 1, placed.begin(), placed.end());
            tour = std::move(rest);
            return true;
          }
      }
    return false;
  }

  int n_;
  Eigen::MatrixXd cost_;
};

/// A | B | C | D becomes A | C | B | D: what reversals alone do not undo.
std::vector<int> double_bridge(const std::vector<int>& tour, Random& random) {
  std::array<std::size_t, 3> cut{};
  for (std::size_t& c : cut) c = 1 + std::size_t(random.index(int(tour.size()) - 1));
  std::sort(cut.begin(), cut.end());
  std::vector<int> result(tour.begin(), tour.begin() + std::ptrdiff_t(cut[0]));
  const auto append = [&](std::size_t begin, std::size_t end) {
    result.insert(result.end(), tour.begin() + std::ptrdiff_t(begin), tour.begin() + std::ptrdiff_t(end));
  };
  append(cut[1], cut[2]);
  append(cut[0], cut[1]);
  append(cut[2], tour.size());
  return result;
}

}  // namespace

std::vector<int> cheapest_tour(const Eigen::MatrixXd& cost, const TourOptions& options) {
  const int n = int(cost.rows());
  if (cost.cols() != n || !cost.allFinite() || (n > 0 && cost.minCoeff() < 0))
    throw std::invalid_argument("a tour needs a square matrix of costs, finite and not negative");
  if (options.start && (*options.start < 0 || *options.start >= n)) throw std::invalid_argument("no such first node");
  if (n <= 2) {
    std::vector<int> order(static_cast<std::size_t>(n));
    std::iota(order.begin(), order.end(), 0);
    if (options.start == 1) std::reverse(order.begin(), order.end());
    return order;
  }
  if (options.exact && n <= exact_nodes) return by_dynamic_programming(cost, options);
  const Cycle cycle(cost, options);
  std::vector<int> best = cycle.start(by_spanning_tree(cost));
  cycle.improve(best);
  double length = cycle.length(best);
  Random random(options.seed, 0);
  for (int kick = 0; kick < options.kicks; ++kick) {
    std::vector<int> trial = double_bridge(best, random);
    cycle.improve(trial);
    if (const double found = cycle.length(trial); found < length) {
      length = found;
      best = std::move(trial);
    }
  }
  return cycle.open(std::move(best), options.start);
}

}  // namespace posewright
