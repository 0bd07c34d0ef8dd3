#include "restarts.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <utility>

#include "posewright/support/bytes.hpp"
#include "posewright/support/parallel.hpp"
#include "posewright/support/tasks.hpp"
#include "reduced_task.hpp"
#include "starts.hpp"

namespace posewright {
namespace {

// How many of the reduced search's results are taken through all candidates. Where values have kinks the best of them
// is seldom the best in the end.
constexpr std::size_t finished = 2, finished_at_kinks = 8;
// Under a time limit; nobody waits for so many.
constexpr int most_starts = 100'000'000;

/// The best few outcomes so far and totals over all: what is kept does not depend on the order in which they come.
class BestOutcomes {
 public:
  explicit BestOutcomes(std::size_t kept) : kept_(kept) {}

  void add(std::size_t restart, Outcome outcome) {
    ++count_;
    exchanges_ += outcome.exchanges;
    std::sort(outcome.members.begin(), outcome.members.end());
    const auto before = [](const Entry& a, const Entry& b) {
      return a.second.value != b.second.value ? a.second.value > b.second.value : a.first < b.first;
    };
    Entry entry{restart, std::move(outcome)};
    // The same local optimum met again counts once.
    const auto same = std::find_if(best_.begin(), best_.end(),
                                   [&](const Entry& other) { return other.second.members == entry.second.members; });
    if (same != best_.end() && before(*same, entry)) return;
    if (same != best_.end()) best_.erase(same);
    best_.insert(std::upper_bound(best_.begin(), best_.end(), entry, before), std::move(entry));
    if (best_.size() > kept_) best_.pop_back();
  }

  int count() const { return count_; }
  long exchanges() const { return exchanges_; }
  std::vector<Outcome> take() {
    std::vector<Outcome> outcomes;
    for (Entry& entry : best_) outcomes.push_back(std::move(entry.second));
    return outcomes;
  }

 private:
  using Entry = std::pair<std::size_t, Outcome>;
  std::size_t kept_;
  std::vector<Entry> best_;
  int count_ = 0;
  long exchanges_ = 0;
};

// Rounds of further candidates go on while one gains this much of Φ.
constexpr double further_gain = 1e-3;
constexpr int most_further_rounds = 8;

std::size_t outcomes_to_finish(const DesignTask& task) {
  if (promises_by_members(task)) return 1;
  return task.criterion->smoother() == nullptr ? finished : finished_at_kinks;
}

/// Passes over all candidates: the result is a local optimum of the whole task.
Outcome through_all(const DesignTask& task, std::vector<int> members, const Monitor& monitor) {
  const auto state = task.criterion->start(task.candidates, std::move(members));
  const long more = settle(*state, monitor);
  return outcome_of(*state, more);
}

/// Exchanges with the candidates of largest derivative, as long as they gain.
Outcome with_further(const DesignTask& task, Outcome best, const Monitor& monitor) {
  best.exchanges = 0;
  for (int round = 0; round < most_further_rounds && !monitor.should_stop(); ++round) {
    const ReducedTask near(task, best.members);
    Outcome found = through_all(near.task(), near.reduced(best.members), monitor);
    found.members = near.original(found.members);
    found.exchanges += best.exchanges;
    const bool gained = found.value > best.value + further_gain;
    best = std::move(found);
    if (!gained) break;
  }
  return best;
}

/// Takes the best few outcomes of the reduced search on, among all candidates.
void finish(const DesignTask& task, const ReducedTask& reduced, std::vector<Outcome>& outcomes, int threads,
            const Monitor& monitor) {
  parallel_for(outcomes.size(), threads, [&](std::size_t i, int) {
    outcomes[i].members = reduced.original(outcomes[i].members);
    outcomes[i] = promises_by_members(task) ? with_further(task, std::move(outcomes[i]), monitor)
                                            : through_all(task, std::move(outcomes[i].members), monitor);
  });
}

}  // namespace

double products_of_a_pass(const DesignTask& task) {
  const BlockArray& blocks = *task.candidates.blocks;
  return double(task.poses) * double(blocks.count()) * blocks.rows() * blocks.columns();
}

int affordable_kicks(const DesignTask& task, const PlannerOptions& options) {
  // A kick costs two passes or so. More restarts than usual are more work: each keeps its kicks, so that the first of
  // them find what they found.
  constexpr double most_products = 1e10, passes = 2;
  const double usual = passes * products_of_a_pass(task) * PlannerOptions{}.restarts;
  return int(std::clamp(most_products / usual, 0.0, double(options.kicks)));
}

std::vector<int> raw_start(const DesignTask& task, std::size_t index, Random& random) {
  const bool weights = task.approximate != nullptr && !task.approximate->support.empty();
  if (weights && index == 0) return rounded_start(task);
  if (weights && index % 2 == 1) return weighted_start(task, random);
  return uniform_start(task, random);
}

namespace {

std::vector<int> settle_smoothly(const Criterion& criterion, const CandidateView& candidates, std::vector<int> members,
                                 const Monitor& monitor) {
  if (criterion.smoother() == nullptr || monitor.should_stop()) return members;
  members = settle_smoothly(*criterion.smoother(), candidates, std::move(members), monitor);
  const auto state = criterion.smoother()->start(candidates, std::move(members));
  settle(*state, monitor);
  return state->members();
}

}  // namespace

std::vector<int> start_of_restart(const DesignTask& task, std::size_t index, Random& random, const Monitor& monitor) {
  return settle_smoothly(*task.criterion, task.candidates, raw_start(task, index, random), monitor);
}

Design run_restarts(const DesignTask& task, const PlannerOptions& options, const Monitor& monitor,
                    const std::string& stage, const Search& search) {
  const ReducedTask reduced(task);
  BestOutcomes best(outcomes_to_finish(task));
  std::mutex mutex;
  const double degree = task.criterion->function().degree();
  // A limit is there to be used, where nobody says how many starts it is for.
  const bool all_time = options.use_all_time && !options.restarts_stated && monitor.deadline;
  const int starts = all_time ? std::max(options.restarts, most_starts) : options.restarts;
  Progress progress{stage, 0, all_time ? 0.0 : double(starts), {}, task.bound, {}};
  const auto tell = [&](const Outcome& outcome) {
    progress.done += 1;
    progress.best = std::max(progress.best.value_or(outcome.value), outcome.value);
    if (progress.bound && degree > 0) progress.efficiency = std::exp((*progress.best - *progress.bound) / degree);
    monitor.report(progress);
  };
  const auto carry_out = [&](std::size_t i) {
    Random random(options.seed, i);
    return search(reduced.task(), i, random, monitor);
  };
  if (all_time) {
    // Each thread takes the next start and leaves at the stop: to go through those that are left takes seconds.
    std::atomic<std::size_t> next{0};
    const int workers = thread_count(options.threads);
    parallel_for(std::size_t(workers), workers, [&](std::size_t, int) {
      for (std::size_t i = next++; i < std::size_t(starts) && (i == 0 || !monitor.should_stop()); i = next++) {
        Outcome outcome = carry_out(i);
        const std::scoped_lock lock(mutex);
        tell(outcome);
        best.add(i, std::move(outcome));
      }
    });
  } else {
    TaskGroup group{stage, std::size_t(starts), options.threads};
    group.finished = [&](std::size_t, std::string_view bytes) { tell(value_in<Outcome>(bytes)); };
    group.first_always = true;
    run_tasks(
        group, [&](std::size_t i, int) { return bytes_of(carry_out(i)); },
        [&](std::size_t i, std::string_view bytes) { best.add(i, value_in<Outcome>(bytes)); }, monitor);
  }
  Design design;
  design.restarts = best.count();
  design.exchanges = best.exchanges();
  std::vector<Outcome> outcomes = best.take();
  if (reduced.is_smaller()) finish(task, reduced, outcomes, thread_count(options.threads), monitor);
  design.value = -std::numeric_limits<double>::infinity();
  for (const Outcome& outcome : outcomes) {
    if (reduced.is_smaller()) design.exchanges += outcome.exchanges;
    if (!design.members.empty() && !(outcome.value > design.value)) continue;
    design.value = outcome.value;
    design.members = outcome.members;
  }
  design.stopped = monitor.should_stop() && design.restarts < options.restarts;
  return design;
}

}  // namespace posewright
