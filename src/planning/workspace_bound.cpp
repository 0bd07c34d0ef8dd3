#include "posewright/planning/workspace_bound.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <utility>

#include "posewright/planning/ascent.hpp"
#include "posewright/planning/taylor_bound.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/parallel.hpp"
#include "posewright/support/random.hpp"

namespace posewright {
namespace {

// A quick look gets so many rounds and no more.
constexpr int few_rounds = 8;
// Candidates that the weights are solved over at first, for each column: optimal weights sit on some two for each;
// those that turn out to be missing come in later.
constexpr int pool_per_column = 4;
// Largest d over its bound from which on the local searches are thorough.
constexpr double nearly = 1.02;
// Starts of local searches are apart by this share of a coordinate's range, ends that count as two by that.
constexpr double start_distance = 0.1, end_distance = 1e-3;

// Boxes that are looked into for what searches miss: a second or two.
constexpr long boxes_of_a_look = 300;

/// d(q) for fixed weights.
class Sensitivity : public BlockObjective {
 public:
  explicit Sensitivity(const Eigen::MatrixXd& T) : T_(T), S_(T * T.transpose()) {}
  double value(const BlockArray::ConstMap& J) override {
    rotated_.noalias() = J * T_;
    return rotated_.squaredNorm();
  }
  const Eigen::MatrixXd& gradient(const BlockArray::ConstMap&) override { return S_; }

 private:
  Eigen::MatrixXd T_, S_;
  BlockArray::RowMatrix rotated_;
};

/// Candidates worth keeping and configurations found.
struct Pool {
  BlockArray blocks;
  std::vector<std::vector<double>> configurations;
  std::size_t candidates = 0;   // the first of the pool, all others were found
  std::vector<int> original{};  ///< indices of those candidates
};

void append(Pool& pool, const std::vector<std::vector<double>>& found, ConfigurationSpace::Probe& probe) {
  BlockArray grown(pool.blocks.count() + found.size(), pool.blocks.rows(), pool.blocks.columns());
  std::copy_n(pool.blocks.data(), pool.blocks.count() * std::size_t(grown.rows() * grown.stride()), grown.data());
  for (std::size_t i = 0; i < found.size(); ++i) {
    probe.block(found[i], grown.row(pool.blocks.count() + i, 0), grown.stride());
    pool.configurations.push_back(found[i]);
  }
  pool.blocks = std::move(grown);
}

/// Whether two configurations are one for a local search: no coordinate differs by this share of its range or more.
bool is_same_place(const std::vector<ConfigurationSpace::Axis>& axes, std::span<const double> a,
                   std::span<const double> b, double share) {
  for (std::size_t k = 0; k < axes.size(); ++k) {
    const double apart = std::abs(a[k] - b[k]);
    if (axes[k].continuous ? apart >= share * (axes[k].upper - axes[k].lower) && apart > 0 : apart > 0) return false;
  }
  return true;
}

/// Where the local searches start: half are the pool's largest d, half are drawn from the candidates; no two in one
/// place. What is drawn depends on the seed and the round alone: not on an order of d that the last bit may turn.
std::vector<std::size_t> starts_of(const ApproximateDesign& design, const Pool& pool,
                                   const std::vector<ConfigurationSpace::Axis>& axes, int count, Random& random) {
  std::vector<std::size_t> order(design.sensitivity.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto& d = design.sensitivity;
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return d[a] != d[b] ? d[a] > d[b] : a < b; });
  std::vector<std::size_t> starts;
  const auto enter = [&](std::size_t i) {
    for (const std::size_t known : starts)
      if (is_same_place(axes, pool.configurations[known], pool.configurations[i], start_distance)) return;
    starts.push_back(i);
  };
  for (std::size_t i = 0; i < order.size() && int(starts.size()) < count / 2; ++i) enter(order[i]);
  for (int draw = 0; draw < 2 * count && int(starts.size()) < count; ++draw)
    enter(std::size_t(random.index(int(pool.candidates))));
  return starts;
}

std::vector<AscentResult> search_from(const std::vector<std::size_t>& starts, const Pool& pool,
                                      const Eigen::MatrixXd& T, const ConfigurationSpace& space, int evaluations,
                                      const WorkspaceBoundOptions& options) {
  std::vector<AscentResult> results(starts.size());
  parallel_for(starts.size(), thread_count(options.threads), [&](std::size_t i, int) {
    const auto probe = space.probe();
    Sensitivity d(T);
    results[i] = ascend(space, *probe, d, pool.blocks.rows(), pool.blocks.columns(), pool.configurations[starts[i]],
                        evaluations);
  });
  return results;
}

/// Candidates whose d exceeds `limit`, largest first, no two in one place; and the largest d of all.
std::vector<std::vector<double>> candidates_above(double limit, const BlockArray& blocks, const Eigen::MatrixXd& T,
                                                  const ConfigurationSpace& space, int most_returned, double& largest) {
  Sensitivity sensitivity(T);
  std::vector<std::pair<double, int>> above;
  for (std::size_t i = 0; i < blocks.count(); ++i) {
    const double d = sensitivity.value(blocks.block(i));
    largest = std::max(largest, d);
    if (d > limit) above.emplace_back(-d, int(i));
  }
  std::sort(above.begin(), above.end());
  std::vector<std::vector<double>> result;
  for (const auto& [d, i] : above) {
    const auto q = space.candidate(i);
    if (std::none_of(result.begin(), result.end(),
                     [&](const auto& known) { return is_same_place(space.axes(), known, q, start_distance); }))
      result.emplace_back(q.begin(), q.end());
    if (int(result.size()) == most_returned) break;
  }
  return result;
}

/// The mean of the pool's candidates, if it is feasible; else one of them.
std::vector<double> inner_place(const Pool& pool, ConfigurationSpace::Probe& probe) {
  std::vector<double> mean(pool.configurations.front().size(), 0.0);
  for (std::size_t i = 0; i < pool.candidates; ++i)
    for (std::size_t k = 0; k < mean.size(); ++k) mean[k] += pool.configurations[i][k] / double(pool.candidates);
  return probe.feasible(mean) ? mean : pool.configurations.front();
}

/// Moves q to the last feasible place on the way to it from a feasible one.
bool towards(const std::vector<double>& inside, ConfigurationSpace::Probe& probe, std::vector<double>& q) {
  if (probe.feasible(q)) return true;
  const std::vector<double> end = q;
  double feasible = 0, beyond = 1;
  for (int step = 0; step < 30; ++step) {
    const double t = 0.5 * (feasible + beyond);
    for (std::size_t k = 0; k < q.size(); ++k) q[k] = inside[k] + t * (end[k] - inside[k]);
    (probe.feasible(q) ? feasible : beyond) = t;
  }
  for (std::size_t k = 0; k < q.size(); ++k) q[k] = inside[k] + feasible * (end[k] - inside[k]);
  return probe.feasible(q);
}

/// What local searches from candidates do not find: where actuators cut the workspace, few candidates are near its
/// corners. Starts of new searches are the middles of boxes that a proof of d ≤ limit would have to cut; none if there
/// is no such proof. Raises `largest` to the largest d found.
std::vector<std::vector<double>> missed_by_searches(double limit, const Pool& pool, const Eigen::MatrixXd& T,
                                                    const ConfigurationSpace& space,
                                                    const WorkspaceBoundOptions& options, const Monitor& monitor,
                                                    double& largest) {
  SeenAbove seen;
  seen.limit = limit;
  BoxSearchOptions boxes;
  boxes.tolerance = options.tolerance;
  boxes.enough = limit;
  boxes.most_boxes = boxes_of_a_look;
  boxes.threads = options.threads;
  largest_enclosed(space, T, boxes, monitor, &seen);
  std::sort(seen.middles.begin(), seen.middles.end());
  const auto probe = space.probe();
  ProbedBlock block(pool.blocks.rows(), pool.blocks.columns());
  Sensitivity sensitivity(T);
  const std::vector<double> inside = inner_place(pool, *probe);
  std::vector<std::pair<double, std::vector<double>>> reached;
  for (std::vector<double>& q : seen.middles)
    if (towards(inside, *probe, q) && block.at(*probe, q)) reached.emplace_back(sensitivity.value(block.map()), q);
  std::sort(reached.begin(), reached.end(),
            [](const auto& a, const auto& b) { return a.first != b.first ? a.first > b.first : a.second < b.second; });
  std::vector<std::vector<double>> starts;
  for (const auto& of_value : reached) {
    if (int(starts.size()) == options.starts) break;
    const std::vector<double>& q = of_value.second;
    if (std::none_of(starts.begin(), starts.end(),
                     [&](const auto& known) { return is_same_place(space.axes(), known, q, start_distance); }))
      starts.push_back(q);
  }
  std::vector<AscentResult> ends(starts.size());
  parallel_for(starts.size(), thread_count(options.threads), [&](std::size_t i, int) {
    const auto own = space.probe();
    Sensitivity d(T);
    ends[i] = ascend(space, *own, d, pool.blocks.rows(), pool.blocks.columns(), starts[i], options.evaluations);
  });
  std::vector<std::vector<double>> found;
  for (const AscentResult& end : ends) {
    largest = std::max(largest, end.value);
    if (end.value > limit && std::none_of(found.begin(), found.end(), [&](const auto& q) {
          return is_same_place(space.axes(), q, end.q, end_distance);
        }))
      found.push_back(end.q);
  }
  return found;
}

Pool first_pool(const BlockArray& blocks, const ApproximateDesign& design, const ConfigurationSpace& space,
                std::size_t room) {
  std::vector<int> order(blocks.count());
  std::iota(order.begin(), order.end(), 0);
  const auto kept = std::ptrdiff_t(std::min(order.size(), room));
  std::partial_sort(order.begin(), order.begin() + kept, order.end(), [&](int a, int b) {
    const double x = design.sensitivity[std::size_t(a)], y = design.sensitivity[std::size_t(b)];
    return x != y ? x > y : a < b;
  });
  order.resize(std::size_t(kept));
  order.insert(order.end(), design.support.begin(), design.support.end());
  std::sort(order.begin(), order.end());
  order.erase(std::unique(order.begin(), order.end()), order.end());
  Pool pool{blocks.subset(order), {}, order.size(), order};
  for (const int i : order) pool.configurations.emplace_back(space.candidate(i).begin(), space.candidate(i).end());
  return pool;
}

}  // namespace

double WorkspaceBound::bound_for(int poses) const { return bound + degree * std::log(double(poses)); }

WorkspaceBound workspace_bound(const BlockArray& blocks, const ApproximateDesign& on_candidates,
                               const InformationFunction& function, const ConfigurationSpace& space,
                               const WorkspaceBoundOptions& options, const Monitor& monitor) {
  ApproximateDesignOptions weights;
  weights.prior = options.prior;
  weights.tolerance = 0.1 * options.tolerance;
  weights.threads = options.threads;
  Pool pool = first_pool(blocks, on_candidates, space, std::size_t(pool_per_column * blocks.columns()));
  ApproximateDesign design;
  WorkspaceBound result;
  result.degree = function.degree();
  // The first rounds bring in whatever is larger than the rest; only the last ones must find each top.
  int evaluations = options.evaluations / 4;
  Random random(options.seed, 0);
  const auto probe = space.probe();
  // Each round begins with the weights of the one before and what came in.
  for (const int i : on_candidates.weighted())
    weights.start.push_back(
        int(std::lower_bound(pool.original.begin(), pool.original.end(), i) - pool.original.begin()));
  if (!options.known.empty()) {
    for (std::size_t i = 0; i < options.known.size(); ++i) weights.start.push_back(int(pool.blocks.count() + i));
    append(pool, options.known, *probe);
  }
  const int rounds = blocks.count() < few_candidates ? std::min(few_rounds, options.rounds) : options.rounds;
  const bool look_into_boxes = blocks.count() >= few_candidates && options.proof.seconds != 0.0 && !space.is_box() &&
                               space.enclosure(Eigen::MatrixXd::Identity(blocks.columns(), 1)) != nullptr;
  for (int round = 0; round < rounds; ++round) {
    design = solve_approximate_design(pool.blocks, function, weights, monitor);
    const std::vector<AscentResult> ends = search_from(starts_of(design, pool, space.axes(), options.starts, random),
                                                       pool, design.factor, space, evaluations, options);
    result.searches += int(ends.size());
    // What the prior adds to every d, so that Σ w d is the degree.
    const double extra =
        weights.prior.size() > 0 ? (design.factor.transpose() * weights.prior * design.factor).trace() : 0.0;
    const double own = *std::max_element(design.sensitivity.begin(), design.sensitivity.end());
    double most = own;
    const double limit = design.degree * (1 + options.tolerance) - extra;
    std::vector<std::vector<double>> found =
        candidates_above(std::max(limit, own * (1 + 1e-6)), blocks, design.factor, space, options.starts, most);
    for (const AscentResult& end : ends) {
      most = std::max(most, end.value);
      if (end.value > own * (1 + 1e-6) || end.value > limit)
        if (std::none_of(found.begin(), found.end(),
                         [&](const auto& q) { return is_same_place(space.axes(), q, end.q, end_distance); }))
          found.push_back(end.q);
    }
    const bool thorough = evaluations == options.evaluations;
    if (thorough && look_into_boxes && (most <= limit || found.empty()) && !monitor.should_stop()) {
      const auto missed = missed_by_searches(limit, pool, design.factor, space, options, monitor, most);
      found.insert(found.end(), missed.begin(), missed.end());
    }
    result.value = design.value;
    result.max_ratio = std::max(1.0, (most + extra) / design.degree);
    result.bound = design.value + design.degree * std::log(result.max_ratio);
    result.stopped = monitor.should_stop();
    monitor.report({"workspace bound", double(round + 1), double(rounds), {}, {}, 1 / result.max_ratio});
    if (result.stopped) break;
    if (thorough && (result.max_ratio <= 1 + options.tolerance || found.empty())) break;
    if (result.max_ratio <= nearly || found.empty()) evaluations = options.evaluations;
    weights.start = design.weighted();
    for (std::size_t i = 0; i < found.size(); ++i) weights.start.push_back(int(pool.blocks.count() + i));
    append(pool, found, *probe);
  }
  result.factor = design.factor;
  for (std::size_t i = 0; i < design.support.size(); ++i)
    if (const auto at = std::size_t(design.support[i]); design.weights[i] > 1e-6) {
      if (at < pool.candidates) {
        result.candidates.push_back(pool.original[at]);
        result.candidate_weights.push_back(design.weights[i]);
      } else {
        result.support.push_back(pool.configurations[at]);
        result.weights.push_back(design.weights[i]);
      }
    }
  return result;
}

}  // namespace posewright
