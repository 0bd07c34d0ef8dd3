#include "scenario_weights.hpp"

#include <algorithm>
#include <cmath>

#include "posewright/support/parallel.hpp"

namespace posewright {
namespace {

constexpr int most_steps = 80;
// Scenarios that the weights leave undetermined are taken up so often.
constexpr int rounds_for_singular = 4;
// Ends where what the weights may still gain is below this share of the efficiency.
constexpr double settled_gap = 1e-3;
// The soft minimum that stands for the worst.
constexpr double sharpness = 100.0;
// So that no candidate of the pool is left out for ever, and no scenario is singular at the start.
constexpr double spread = 0.1;
constexpr double negligible = 1e-7;
// ln e of a scenario that the weights do not determine.
constexpr double undetermined = -1e3;

/// w scaled so that Σ min(w, cap) = 1.
void share_out(std::vector<double>& w, double cap) {
  std::vector<char> full(w.size(), 0);
  for (bool more = true; more;) {
    double rest = 1.0, sum = 0.0;
    for (std::size_t i = 0; i < w.size(); ++i)
      if (full[i] != 0) rest -= cap;
      else sum += w[i];
    more = false;
    for (std::size_t i = 0; i < w.size(); ++i) {
      if (full[i] != 0) continue;
      w[i] *= rest / sum;
      if (w[i] < cap * (1 - 1e-12)) continue;
      w[i] = cap;
      full[i] = 1;
      more = true;
    }
  }
}

/// Significant weights, for the candidates' numbers in the pool.
CandidateWeights more_than_traces(const std::vector<double>& w) {
  CandidateWeights result;
  for (std::size_t i = 0; i < w.size(); ++i)
    if (w[i] > negligible) result.emplace_back(int(i), w[i]);
  return result;
}

/// Σ_k λ_k d_ik of the pool's candidates, at λ that support the aim at these weights; d of what is there before added
/// to each.
std::vector<double> derivative(const ScenarioFigures& figures, const RobustRequest& request, const ScenarioPool& pool,
                               const std::vector<int>& scenarios, const std::vector<double>& w) {
  const CandidateWeights weights = more_than_traces(w);
  std::vector<ScenarioFigures::Seen> seen(scenarios.size());
  std::vector<double> values(scenarios.size());
  parallel_for(scenarios.size(), thread_count(request.planner.threads), [&](std::size_t s, int) {
    const auto k = std::size_t(scenarios[s]);
    seen[s] = figures.evaluate(pool.blocks(k), pool.prior(k), weights);
    values[s] = std::max(undetermined, figures.efficiency(seen[s].log_det, k));
  });
  const std::vector<double> lambda = request.aim.measure == RobustAim::Measure::worst
                                         ? soft_minimum_weights(values, sharpness)
                                         : figures.combination(scenarios.size()).supporting(values);
  std::vector<double> d(w.size(), 0.0);
  for (std::size_t s = 0; s < scenarios.size(); ++s)
    for (std::size_t i = 0; i < w.size(); ++i) d[i] += lambda[s] * (seen[s].sensitivity[i] + seen[s].of_prior);
  return d;
}

/// Adds those scenarios that the weights do not determine.
void take_undetermined(const ScenarioFigures& figures, const RobustRequest& request, const ScenarioPool& pool,
                       const std::vector<double>& w, std::vector<int>& scenarios) {
  const CandidateWeights weights = more_than_traces(w);
  std::vector<char> open(figures.scenarios(), 0);
  parallel_for(open.size(), thread_count(request.planner.threads), [&](std::size_t k, int) {
    const Eigen::MatrixXd prior = pool.prior(k) / double(request.poses);
    open[k] = std::isfinite(figures.function().value(weighted_information(pool.blocks(k), prior, weights))) ? 0 : 1;
  });
  for (std::size_t k = 0; k < open.size(); ++k)
    if (open[k] != 0 && !std::binary_search(scenarios.begin(), scenarios.end(), int(k)))
      scenarios.insert(std::upper_bound(scenarios.begin(), scenarios.end(), int(k)), int(k));
}

}  // namespace

CandidateWeights robust_weights(const ScenarioFigures& figures, const RobustRequest& request, const ScenarioPool& pool,
                                const CandidateWeights& start, const Monitor& monitor) {
  const std::vector<int>& candidates = pool.candidates();
  const double cap = figures.cap();
  std::vector<double> w = pool.in_pool(start);
  for (double& weight : w) weight = (1 - spread) * weight + spread / double(w.size());
  share_out(w, cap);
  std::vector<int> scenarios = representatives(figures, request.aim, candidates, figures.given(), {});
  for (int round = 0; round < rounds_for_singular && !monitor.should_stop(); ++round) {
    for (int step = 0; step < most_steps && !monitor.should_stop(); ++step) {
      const std::vector<double> d = derivative(figures, request, pool, scenarios, w);
      if (best_mean(d, cap) < figures.interest() * (1 + settled_gap)) break;
      for (std::size_t i = 0; i < w.size(); ++i) w[i] *= d[i];
      share_out(w, cap);
    }
    const std::size_t before = scenarios.size();
    take_undetermined(figures, request, pool, w, scenarios);
    if (scenarios.size() == before) break;
    for (double& weight : w) weight += spread / double(w.size());
    share_out(w, cap);
  }
  CandidateWeights result = more_than_traces(w);
  double sum = 0.0;
  for (const auto& [i, weight] : result) sum += weight;
  for (auto& [i, weight] : result) {
    i = candidates[std::size_t(i)];
    weight /= sum;
  }
  return result;
}

}  // namespace posewright
