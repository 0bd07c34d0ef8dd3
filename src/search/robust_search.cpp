#include "posewright/search/robust_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>

#include "planners/local_search.hpp"
#include "posewright/criterion/scenarios.hpp"
#include "posewright/support/parallel.hpp"
#include "scenario_figures.hpp"
#include "scenario_pool.hpp"

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

/// Weights on the pool's candidates that are good over the scenarios, from `start` on: multiplicative steps w_i ∝ w_i
/// Σ_k λ_k d_ik (Silvey, Titterington & Torsney 1978) with what is above the cap shared among the others. Any weights
/// give a valid bound; how good these are decides how near it is.
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

constexpr int kicks = 8;
constexpr double agreement = 2e-3;
constexpr std::size_t searches = 4;
// Worst scenarios may be others for the plan that is found: so often they are taken up.
constexpr int most_rounds = 4;
// Weights are looked for until no others can be better by this share, so often at most.
constexpr double small_gap = 0.01;
constexpr int most_looks = 5;

using Indices = std::vector<int>;

Indices every(std::size_t count) {
  Indices all(count);
  std::iota(all.begin(), all.end(), 0);
  return all;
}

class RobustSearch {
 public:
  RobustSearch(const RobustRequest& request, const Monitor& monitor)
      : request_(request), monitor_(monitor), figures_(request, monitor) {}

  RobustResult judge() {
    RobustResult result;
    result.plan = request_.plan;
    result.stopped = !figures_.find_references(result.unreached);
    if (figures_.references().empty()) return result;
    result.references = figures_.raw_references();
    result.nominal = result.robust = figures_.figures(figures_.given());
    if (result.stopped || !evaluate_at_best_weights()) result.stopped = true;
    result.bound = figures_.bound();
    return result;
  }

  RobustResult search() {
    RobustResult result = judge();
    if (result.stopped) return result;
    // Scenarios that agree on the nominal plan have no other one to tell of: it was searched for long enough.
    const auto [lowest, highest] = std::minmax_element(figures_.given().begin(), figures_.given().end());
    if (*highest - *lowest < agreement) kicks_ = 0;
    const ScenarioPool pool(figures_, request_, figures_.given(), weighted_);
    Indices best = pool.in_pool(request_.plan);
    std::vector<double> values = figures_.given();
    Indices looked_at;
    for (int round = 0; round < most_rounds && !monitor_.should_stop(); ++round) {
      const Indices chosen = representatives(figures_, request_.aim, pool.candidates(), values, looked_at);
      if (chosen == looked_at) break;
      looked_at = chosen;
      const Indices found = best_of_starts(pool, pool.criterion(looked_at), best, result.exchanges);
      take_if_better(pool, found, best, values);
      if (looked_at.size() == values.size() || request_.aim.measure == RobustAim::Measure::mean) break;
    }
    if (looked_at.size() < values.size() && !monitor_.should_stop()) {
      const auto criterion = pool.criterion(every(values.size()));
      const auto state = criterion.start(pool.view(), best);
      result.exchanges += settle(*state, monitor_);
      take_if_better(pool, state->members(), best, values);
    }
    result.stopped = monitor_.should_stop();
    result.robust = figures_.figures(values);
    result.plan.clear();
    for (const int i : best) result.plan.push_back(pool.candidates()[std::size_t(i)]);
    std::sort(result.plan.begin(), result.plan.end());
    return result;
  }

 private:
  /// Looks from weights that are good over the scenarios where those of the nominal optimum are not.
  bool evaluate_at_best_weights() {
    weighted_ = figures_.optimal_weights();
    // What is worth most to other weights may have been left out of the pool.
    for (int look = 0; look < most_looks && figures_.gap() > small_gap; ++look) {
      const ScenarioPool pool(figures_, request_, figures_.given(), weighted_);
      CandidateWeights better = robust_weights(figures_, request_, pool, weighted_, monitor_);
      if (!figures_.evaluate_at(better)) return false;
      weighted_ = std::move(better);
    }
    return true;
  }

  /// From the plan given, from the best weights, and from there on by kicks.
  Indices best_of_starts(const ScenarioPool& pool, const ScenarioCriterion& criterion, const Indices& start,
                         long& exchanges) const {
    const Indices heaviest = pool.heaviest(weighted_);
    std::vector<Outcome> outcomes(searches);
    parallel_for(searches, thread_count(request_.planner.threads), [&](std::size_t i, int) {
      Random random(request_.planner.seed, i);
      const auto state = criterion.start(pool.view(), i % 2 == 0 || heaviest.empty() ? start : heaviest);
      long count = settle(*state, monitor_);
      Outcome best = outcome_of(*state, count);
      for (int n = 0; n < kicks_ && !monitor_.should_stop(); ++n) {
        kick(*state, int(pool.candidates().size()), random);
        count += settle(*state, monitor_);
        if (state->value() > best.value + smallest_gain) best = outcome_of(*state, count);
        else restore(*state, best.members);
      }
      best.exchanges = count;
      outcomes[i] = std::move(best);
      monitor_.report({"plan over drawn robots", double(i + 1), double(searches), {}, {}, {}});
    });
    const Outcome* best = &outcomes.front();
    for (const Outcome& outcome : outcomes) {
      exchanges += outcome.exchanges;
      if (outcome.value > best->value + smallest_gain) best = &outcome;
    }
    return best->members;
  }

  void take_if_better(const ScenarioPool& pool, const Indices& found, Indices& best,
                      std::vector<double>& values) const {
    std::vector<double> theirs = pool.values_of(found);
    // A plan that leaves fewer robots undetermined is better, whatever the rest.
    const auto singular = [](const std::vector<double>& of) {
      return std::count_if(of.begin(), of.end(), [](double value) { return !std::isfinite(value); });
    };
    const auto before = singular(values), after = singular(theirs);
    if (after > before) return;
    if (after == before && !(figures_.combine(theirs) > figures_.combine(values) + smallest_gain)) return;
    best = found;
    values = std::move(theirs);
  }

  const RobustRequest& request_;
  const Monitor& monitor_;
  ScenarioFigures figures_;
  CandidateWeights weighted_;
  int kicks_ = kicks;
};

}  // namespace

RobustResult judge_robust(const RobustRequest& request, const Monitor& monitor) {
  return RobustSearch(request, monitor).judge();
}

RobustResult search_robust(const RobustRequest& request, const Monitor& monitor) {
  return RobustSearch(request, monitor).search();
}

}  // namespace posewright
