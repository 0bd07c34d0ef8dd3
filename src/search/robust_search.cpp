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
#include "scenario_weights.hpp"

namespace posewright {
namespace {

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
