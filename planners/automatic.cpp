#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <numeric>

#include "continuous.hpp"
#include "exchange.hpp"
#include "extended_task.hpp"
#include "planners.hpp"
#include "posewright/criterion/information_function.hpp"
#include "posewright/support/bytes.hpp"
#include "posewright/support/parallel.hpp"
#include "posewright/support/tasks.hpp"
#include "reduced_task.hpp"
#include "restarts.hpp"
#include "starts.hpp"
#include "tabu.hpp"

namespace posewright {
namespace {

using Clock = std::chrono::steady_clock;

// Shares of the time that is left, for the stages that could take any time.
constexpr double exchange_share = 0.5, tabu_share = 0.5;
constexpr std::size_t tabu_starts = 4;
// Starts that are settled among candidates, and of their results those whose poses are moved.
constexpr std::size_t settled_starts = 12, most_settled_starts = 100, moved_starts = 6, axes_for_one = 40;
// From the moved poses, and from the weights among candidates old and new.
constexpr int new_candidate_starts = 2, new_candidate_kicks = 0;
// Rounds of new candidates go on while one gains this share of the best plan.
constexpr double candidate_round_gain = 1e-4;
constexpr std::uint64_t most_candidate_rounds = 8;

/// The caller's monitor with an earlier deadline. Where there is one, tasks are this process's own: what comes after
/// would rest on what each got done.
class Part {
 public:
  Part(const Monitor& whole, double share, bool silent = false) {
    monitor_.interrupted = whole.interrupted;
    if (!silent) monitor_.on_progress = [&whole](const Progress& progress) { whole.report(progress); };
    if (!whole.deadline) {
      if (!silent) monitor_.engine = whole.engine;
      return;
    }
    const auto now = Clock::now();
    monitor_.deadline = now + std::chrono::duration_cast<Clock::duration>(share * (*whole.deadline - now));
  }
  const Monitor& monitor() const { return monitor_; }

 private:
  Monitor monitor_;
};

class AutomaticSearch {
 public:
  AutomaticSearch(const DesignTask& task, const PlannerOptions& options, const Monitor& monitor)
      : task_(task), options_(options), whole_(monitor, 1.0), monitor_(whole_.monitor()), begin_(Clock::now()) {
    best_.value = -std::numeric_limits<double>::infinity();
  }

  Design carry_out() {
    greedy();
    // Moves between the candidates see Φ of the whole design only: not what is left without a pose.
    const bool moves = task_.space != nullptr && task_.criterion->of_information_alone();
    const bool all_time = options_.use_all_time && monitor_.deadline;
    if (moves) {
      move_starts();
      const double enough = candidate_round_gain * task_.criterion->function().degree();
      for (std::uint64_t round = 0; round < most_candidate_rounds && !monitor_.should_stop(); ++round) {
        const double before = moved_->value;
        beyond(options_.seed + (round << 40), new_candidate_starts, new_candidate_kicks);
        if (!(moved_->value - before > enough)) break;
      }
      best_.stopped = monitor_.should_stop();
    }
    // A limit is there to be used. Without one the work is what the options say, where candidates are all there is.
    for (std::uint64_t round = 0; (round == 0 && !moves) || (all_time && !monitor_.should_stop()); ++round) {
      exchange(options_.seed + (round << 32));
      tabu(options_.seed + (round << 32));
      if (moves) {
        improve_from(pose_set_of(task_, best_.members));
        beyond(options_.seed + (round << 32), std::max(1, options_.restarts / 2), options_.kicks);
      }
      // Rounds after the first are a gift of the time limit: to be stopped in one of them cuts nothing short.
      if (round == 0 && !moves) best_.stopped = monitor_.should_stop();
    }
    if (moved_ && moved_->value > best_.value) write_to(best_, *moved_, task_.candidates.blocks->count());
    return std::move(best_);
  }

 private:
  /// One task an outcome; after a stop all but the first may be left out.
  void carry_out(const std::string& name, std::vector<Outcome>& outcomes, const Monitor& monitor,
                 const std::function<Outcome(std::size_t)>& search) {
    TaskGroup group{name, outcomes.size(), options_.threads, [](std::size_t, std::string_view) {}};
    group.first_always = true;
    run_tasks(
        group, [&](std::size_t i, int) { return bytes_of(search(i)); },
        [&](std::size_t i, std::string_view bytes) { outcomes[i] = value_in<Outcome>(bytes); }, monitor);
  }

  void record(const char* stage) {
    const double value = moved_ ? std::max(moved_->value, best_.value) : best_.value;
    const std::chrono::duration<double> passed = Clock::now() - begin_;
    // Only the first round is told: later ones repeat it.
    for (const SearchStage& known : best_.stages)
      if (known.name == stage) return;
    best_.stages.push_back({stage, value, passed.count()});
  }

  void take(const Outcome& outcome) {
    best_.exchanges += outcome.exchanges;
    if (!(outcome.value > best_.value)) return;
    best_.value = outcome.value;
    best_.members = outcome.members;
  }

  void greedy() {
    const ReducedTask reduced(task_);
    const auto state = task_.criterion->start(reduced.task().candidates, {});
    fill_greedily(*state, task_.poses);
    state->refresh();
    Outcome outcome = outcome_of(*state, 0);
    outcome.members = reduced.original(outcome.members);
    take(outcome);
    // Nothing else comes after this: the optimal weights are there already, and often the better plan.
    if (monitor_.should_stop() && task_.approximate != nullptr && !task_.approximate->support.empty())
      take(outcome_of(*task_.criterion->start(task_.candidates, rounded_start(task_)), 0));
    record("greedy");
  }

  void exchange(std::uint64_t seed) {
    const Part part(monitor_, exchange_share);
    PlannerOptions options = options_;
    options.seed = seed;
    const Design found =
        run_restarts(task_, options, part.monitor(), "exchange",
                     [&](const DesignTask& task, std::size_t i, Random& random, const Monitor& watch) {
                       return exchange_restart(task, i, affordable_kicks(task, options), random, watch);
                     });
    best_.restarts += found.restarts;
    take({found.members, found.value, found.exchanges, true});
    record("exchange");
  }

  void tabu(std::uint64_t seed) {
    const Part part(monitor_, tabu_share);
    const ReducedTask reduced(task_, best_.members);
    const std::vector<int> start = reduced.reduced(best_.members);
    std::vector<Outcome> outcomes(tabu_starts);
    carry_out("tabu", outcomes, part.monitor(), [&](std::size_t i) {
      Random random(mix_bits(seed) + 1, i);
      return tabu_search(reduced.task(), start, tabu_patience(reduced.task(), options_), random, part.monitor());
    });
    for (Outcome& outcome : outcomes) {
      if (!outcome.done || !(outcome.value > best_.value + smallest_gain)) continue;
      const auto state = task_.criterion->start(task_.candidates, reduced.original(outcome.members));
      const long more = outcome.exchanges + settle(*state, monitor_);
      take(outcome_of(*state, more));
    }
    record("tabu");
  }

  /// Local optima from the greedy set and from optimal weights over the workspace, the best few with their poses moved.
  void move_starts() {
    std::vector<PoseSet> sets;
    const ReducedTask reduced(task_, best_.members);
    for (Outcome& outcome : settled(reduced.task(), reduced.reduced(best_.members))) {
      outcome.members = reduced.original(outcome.members);
      take({outcome.members, outcome.value, 0, true});
      sets.push_back(pose_set_of(task_, outcome.members));
    }
    record("exchange");
    if (task_.workspace != nullptr && !task_.workspace->support.empty()) {
      const ExtendedTask extended(task_, promising(task_.workspace->candidates), task_.workspace->support);
      for (const Outcome& outcome : settled(extended.task(), {}))
        sets.push_back(extended.pose_set(task_, outcome.members));
    }
    move_roughly(sets);
    // The rest of the moves is worth it for the best set alone.
    std::stable_sort(sets.begin(), sets.end(), [](const PoseSet& a, const PoseSet& b) { return a.value > b.value; });
    for (const PoseSet& poses : sets) remember(poses);
    moved_ = std::move(sets.front());
    best_.exchanges += improve(task_, *moved_, options_.threads, monitor_);
    remember(*moved_);
    record("continuous");
  }

  /// Progress of one of them is told; those that do not come to their turn before a stop stay as they are.
  void move_roughly(std::vector<PoseSet>& sets) {
    std::vector<long> moves(sets.size());
    parallel_for(sets.size(), thread_count(options_.threads), [&](std::size_t i, int) {
      const Part silent(monitor_, 1.0, true);
      if (i == 0 || !monitor_.should_stop())
        moves[i] = improve_roughly(task_, sets[i], i == 0 ? monitor_ : silent.monitor());
    });
    best_.exchanges = std::accumulate(moves.begin(), moves.end(), best_.exchanges);
  }

  /// Local optima from the starts `first` to `first + count`: rounded weights, one given set (if any), draws by the
  /// weights.
  std::vector<Outcome> settled_starts_of(const DesignTask& task, const std::vector<int>& given, std::size_t first,
                                         std::size_t count) {
    std::vector<Outcome> found(count);
    carry_out("local optima", found, monitor_, [&](std::size_t k) {
      const std::size_t i = first + k;
      Random random(options_.seed, i);
      const auto state = task.criterion->start(
          task.candidates,
          i == 1 && !given.empty() ? given : start_of_restart(task, i == 0 ? 0 : 2 * i + 1, random, monitor_));
      const long exchanges = settle(*state, monitor_);
      return outcome_of(*state, exchanges);
    });
    return found;
  }

  /// The best few local optima of different value, from one given set (if any) and from the weights.
  std::vector<Outcome> settled(const DesignTask& task, const std::vector<int>& given) {
    const std::size_t count = std::clamp(std::size_t(options_.restarts), settled_starts, most_settled_starts);
    // Where half of them leave parameters open, as rounded weights of few poses may, the rest would too.
    std::vector<Outcome> found = settled_starts_of(task, given, 0, count / 2);
    const auto is_open = [](const Outcome& outcome) { return outcome.done && std::isinf(outcome.value); };
    if (!std::all_of(found.begin(), found.end(), is_open)) {
      const std::vector<Outcome> rest = settled_starts_of(task, given, count / 2, count - count / 2);
      found.insert(found.end(), rest.begin(), rest.end());
    }
    std::erase_if(found, [](const Outcome& outcome) { return !outcome.done; });
    for (const Outcome& outcome : found) best_.exchanges += outcome.exchanges;
    best_.restarts += int(found.size());
    std::stable_sort(found.begin(), found.end(), [](const Outcome& a, const Outcome& b) { return a.value > b.value; });
    const auto same = [](const Outcome& a, const Outcome& b) { return a.value - b.value < smallest_gain; };
    found.erase(std::unique(found.begin(), found.end(), same), found.end());
    // A move of one pose costs as many evaluations as it has axes, squared; without a gradient many more.
    const std::size_t cost = task_.space->axes().size() * (task_.space->margins() ? 1 : 2);
    const std::size_t most = std::clamp<std::size_t>(axes_for_one / cost, 1, moved_starts);
    if (found.size() > most) found.resize(most);
    return found;
  }

  /// Moved poses as candidates of the next round, so that good places of different sets meet in one.
  void remember(const PoseSet& poses) {
    for (std::size_t i = 0; i < poses.configurations.size(); ++i)
      if (poses.candidates[i] < 0 &&
          std::find(places_.begin(), places_.end(), poses.configurations[i]) == places_.end())
        places_.push_back(poses.configurations[i]);
  }

  void improve_from(PoseSet poses) {
    best_.exchanges += improve(task_, poses, options_.threads, monitor_);
    remember(poses);
    if (!moved_ || poses.value > moved_->value) moved_ = std::move(poses);
  }

  /// Poses between the candidates, and new ones where the optimal weights want them.
  void beyond(std::uint64_t seed, int restarts, int kicks) {
    if (task_.workspace == nullptr || task_.workspace->support.empty() || monitor_.should_stop()) return;
    std::vector<std::vector<double>> added = task_.workspace->support;
    added.insert(added.end(), places_.begin(), places_.end());
    const std::vector<int> kept = promising(moved_->candidates);
    std::vector<int> start;
    for (std::size_t i = 0; i < moved_->candidates.size(); ++i)
      start.push_back(moved_->candidates[i] >= 0
                          ? int(std::lower_bound(kept.begin(), kept.end(), moved_->candidates[i]) - kept.begin())
                          : int(kept.size()) +
                                int(std::find(added.begin(), added.end(), moved_->configurations[i]) - added.begin()));
    const ExtendedTask extended(task_, kept, std::move(added));
    PlannerOptions options = options_;
    options.seed = mix_bits(seed) + 2;
    options.restarts = restarts;
    const Design found = run_restarts(extended.task(), options, monitor_, "new candidates",
                                      [&](const DesignTask& task, std::size_t i, Random& random, const Monitor& watch) {
                                        const auto from = i % 2 == 0 ? start : start_of_restart(task, i, random, watch);
                                        return exchange_search(task, from, kicks, random, watch);
                                      });
    best_.exchanges += found.exchanges;
    improve_from(extended.pose_set(task_, found.members));
    record("new candidates");
  }

  /// Candidates for the extended pool: those of large sensitivity and those in use.
  std::vector<int> promising(const std::vector<int>& used) const {
    std::vector<int> also;
    for (const int i : used)
      if (i >= 0) also.push_back(i);
    std::sort(also.begin(), also.end());
    also.erase(std::unique(also.begin(), also.end()), also.end());
    const ReducedTask reduced(task_, also);
    std::vector<int> all(reduced.task().candidates.blocks->count());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = int(i);
    return reduced.original(all);
  }

  const DesignTask& task_;
  const PlannerOptions& options_;
  Part whole_;
  const Monitor& monitor_;
  Clock::time_point begin_;
  Design best_;
  std::optional<PoseSet> moved_;
  std::vector<std::vector<double>> places_;
};

/// `auto`, where poses can be moved: greedy → exchange from a dozen starts (the greedy set and optimal weights, among
/// the candidates and with the configurations that the weights use over the workspace) → the best of each moved between
/// the candidates for a few rounds, the best of all to the end → all places found so far as candidates, exchanged and
/// moved again while a round gains. For blocks alone: greedy → exchange with all restarts → tabu. Each stage starts
/// from the best so far and never loses it; Design::stages tells what each gained. Under a time limit rounds of
/// exchange with restarts and kicks, tabu and moves follow with other seeds until the time is used.
Design automatic_design(const DesignTask& task, const PlannerOptions& options, const Monitor& monitor) {
  return AutomaticSearch(task, options, monitor).carry_out();
}

}  // namespace

Planner automatic_planner() {
  return {"auto", "greedy, exchange, tabu, continuous and new candidates in turn", automatic_design};
}

}  // namespace posewright
