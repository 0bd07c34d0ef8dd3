#include "posewright/planning/workspace_bound.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "posewright/planning/ascent.hpp"
#include "posewright/support/parallel.hpp"
#include "posewright/support/random.hpp"

namespace posewright {
namespace {

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
  std::size_t candidates = 0;  // the first of the pool, all others were found
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

/// Where the local searches start: half of the starts are the pool's largest d, half are drawn from the rest.
std::vector<std::size_t> starts_of(const ApproximateDesign& design, int count, Random& random) {
  std::vector<std::size_t> order(design.sensitivity.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto half = std::min(order.size(), std::size_t(count / 2 + 1));
  const auto& d = design.sensitivity;
  std::partial_sort(order.begin(), order.begin() + std::ptrdiff_t(half), order.end(),
                    [&](auto a, auto b) { return d[a] != d[b] ? d[a] > d[b] : a < b; });
  for (std::size_t i = half; i < std::min(order.size(), std::size_t(count)); ++i)
    std::swap(order[i], order[i + std::size_t(random.index(int(order.size() - i)))]);
  order.resize(std::min(order.size(), std::size_t(count)));
  return order;
}

std::vector<AscentResult> search_from(const std::vector<std::size_t>& starts, const Pool& pool,
                                      const Eigen::MatrixXd& T, const ConfigurationSpace& space,
                                      const WorkspaceBoundOptions& options) {
  std::vector<AscentResult> results(starts.size());
  parallel_for(starts.size(), thread_count(options.threads), [&](std::size_t i, int) {
    const auto probe = space.probe();
    Sensitivity d(T);
    results[i] = ascend(space, *probe, d, pool.blocks.rows(), pool.blocks.columns(), pool.configurations[starts[i]],
                        options.evaluations);
  });
  return results;
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
  Pool pool{blocks.subset(order), {}, order.size()};
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
  Pool pool = first_pool(blocks, on_candidates, space, std::size_t(20 * blocks.columns()));
  ApproximateDesign design;
  WorkspaceBound result;
  result.degree = function.degree();
  Random random(options.seed, 0);
  const auto probe = space.probe();
  for (int round = 0; round < options.rounds; ++round) {
    design = solve_approximate_design(pool.blocks, function, weights, monitor);
    const std::vector<AscentResult> ends =
        search_from(starts_of(design, options.starts, random), pool, design.factor, space, options);
    result.searches += int(ends.size());
    // What the prior adds to every d, so that Σ w d is the degree.
    const double extra =
        weights.prior.size() > 0 ? (design.factor.transpose() * weights.prior * design.factor).trace() : 0.0;
    const double own = *std::max_element(design.sensitivity.begin(), design.sensitivity.end());
    double most = own;
    std::vector<std::vector<double>> found;
    for (const AscentResult& end : ends) {
      most = std::max(most, end.value);
      if (end.value > own * (1 + 1e-6) || end.value + extra > design.degree * (1 + options.tolerance))
        found.push_back(end.q);
    }
    result.value = design.value;
    result.max_ratio = std::max(1.0, (most + extra) / design.degree);
    result.bound = design.value + design.degree * std::log(result.max_ratio);
    result.stopped = monitor.should_stop();
    monitor.report({"workspace bound", double(round + 1), double(options.rounds), {}, {}, 1 / result.max_ratio});
    if (result.max_ratio <= 1 + options.tolerance || result.stopped || found.empty()) break;
    append(pool, found, *probe);
  }
  for (std::size_t i = 0; i < design.support.size(); ++i)
    if (std::size_t(design.support[i]) >= pool.candidates && design.weights[i] > 1e-6)
      result.support.push_back(pool.configurations[std::size_t(design.support[i])]);
  return result;
}

}  // namespace posewright
