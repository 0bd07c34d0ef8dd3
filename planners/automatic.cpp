#include "automatic.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "continuous.hpp"
#include "exchange.hpp"
#include "posewright/criterion/information_function.hpp"
#include "posewright/support/parallel.hpp"
#include "reduced_task.hpp"
#include "restarts.hpp"
#include "tabu.hpp"

namespace posewright {
namespace {

using Clock = std::chrono::steady_clock;

// Shares of the time that is left, for the stages that could take any time.
constexpr double exchange_share = 0.5, tabu_share = 0.5;
constexpr std::size_t tabu_starts = 4;

/// The caller's monitor with an earlier deadline.
class Part {
 public:
  Part(const Monitor& whole, double share) {
    monitor_.interrupted = whole.interrupted;
    monitor_.on_progress = [&whole](const Progress& progress) { whole.report(progress); };
    if (!whole.deadline) return;
    const auto now = Clock::now();
    monitor_.deadline = now + std::chrono::duration_cast<Clock::duration>(share * (*whole.deadline - now));
  }
  const Monitor& monitor() const { return monitor_; }

 private:
  Monitor monitor_;
};

/// Candidates of a smaller pool together with configurations that are none.
class ExtendedTask {
 public:
  ExtendedTask(const DesignTask& task, std::vector<int> kept, std::vector<std::vector<double>> added)
      : task_(task), kept_(std::move(kept)), added_(std::move(added)), spacing_(task.space->spacing()) {
    const BlockArray part = task.candidates.blocks->subset(kept_);
    blocks_ = BlockArray(kept_.size() + added_.size(), part.rows(), part.columns());
    std::copy_n(part.data(), part.count() * std::size_t(part.rows() * part.stride()), blocks_.data());
    const auto probe = task.space->probe();
    for (std::size_t i = 0; i < added_.size(); ++i)
      probe->block(added_[i], blocks_.row(kept_.size() + i, 0), blocks_.stride());
    task_.candidates.blocks = &blocks_;
    task_.approximate = nullptr;
    task_.space = nullptr;
    task_.workspace = nullptr;
    if (spacing_.unit.size() == 0) return;
    spacing_.points.resize(Eigen::Index(blocks_.count()), spacing_.unit.size());
    for (std::size_t i = 0; i < blocks_.count(); ++i) {
      const auto q = configuration(*task.space, int(i));
      std::copy(q.begin(), q.end(), spacing_.points.row(Eigen::Index(i)).data());
    }
    task_.candidates.spacing = &spacing_;
  }

  const DesignTask& task() const { return task_; }
  PoseSet pose_set(const DesignTask& whole, const std::vector<int>& members) const {
    PoseSet poses;
    poses.blocks = blocks_.subset(members);
    for (const int i : members) {
      const auto q = configuration(*whole.space, i);
      poses.configurations.emplace_back(q.begin(), q.end());
      poses.candidates.push_back(std::size_t(i) < kept_.size() ? kept_[std::size_t(i)] : -1);
    }
    return poses;
  }

 private:
  std::span<const double> configuration(const ConfigurationSpace& space, int i) const {
    const auto at = std::size_t(i);
    return at < kept_.size() ? space.candidate(kept_[at]) : std::span<const double>(added_[at - kept_.size()]);
  }

  DesignTask task_;
  std::vector<int> kept_;
  std::vector<std::vector<double>> added_;
  BlockArray blocks_;
  Spacing spacing_;
};

class Run {
 public:
  Run(const DesignTask& task, const PlannerOptions& options, const Monitor& monitor)
      : task_(task), options_(options), monitor_(monitor), begin_(Clock::now()) {
    best_.value = -std::numeric_limits<double>::infinity();
  }

  Design carry_out() {
    greedy();
    // A limit is there to be used; without one the work is what the options say.
    for (std::uint64_t round = 0; round == 0 || (options_.use_all_time && monitor_.deadline && !monitor_.should_stop());
         ++round) {
      exchange(options_.seed + (round << 32));
      tabu(options_.seed + (round << 32));
      // Moves between the candidates see Φ of the whole design only: not what is left without a pose.
      if (task_.space != nullptr && task_.criterion->of_information_alone()) beyond(options_.seed + (round << 32));
      // Rounds after the first are a gift of the time limit: to be stopped in one of them cuts nothing short.
      if (round == 0) best_.stopped = monitor_.should_stop();
    }
    if (moved_ && moved_->value > best_.value) write_to(best_, *moved_, task_.candidates.blocks->count());
    return std::move(best_);
  }

 private:
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
    record("greedy");
  }

  void exchange(std::uint64_t seed) {
    const Part part(monitor_, exchange_share);
    PlannerOptions options = options_;
    options.seed = seed;
    const Design found = run_restarts(task_, options, part.monitor(), "exchange",
                                      [&](const DesignTask& task, std::size_t i, Random& random, const Monitor& watch) {
                                        return exchange_restart(task, i, options.kicks, random, watch);
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
    parallel_for(outcomes.size(), thread_count(options_.threads), [&](std::size_t i, int) {
      if (i > 0 && part.monitor().should_stop()) return;
      Random random(mix_bits(seed) + 1, i);
      outcomes[i] = tabu_search(reduced.task(), start, tabu_patience(options_.kicks), random, part.monitor());
    });
    for (Outcome& outcome : outcomes) {
      if (!outcome.done || !(outcome.value > best_.value + smallest_gain)) continue;
      const auto state = task_.criterion->start(task_.candidates, reduced.original(outcome.members));
      const long more = outcome.exchanges + settle(*state, monitor_);
      take(outcome_of(*state, more));
    }
    record("tabu");
  }

  void improve_from(PoseSet poses) {
    best_.exchanges += improve(task_, poses, monitor_);
    if (!moved_ || poses.value > moved_->value) moved_ = std::move(poses);
  }

  /// Poses between the candidates, and new ones where the optimal weights want them.
  void beyond(std::uint64_t seed) {
    improve_from(pose_set_of(task_, best_.members));
    record("continuous");
    if (task_.workspace == nullptr || task_.workspace->support.empty() || monitor_.should_stop()) return;
    std::vector<std::vector<double>> added = task_.workspace->support;
    for (std::size_t i = 0; i < moved_->configurations.size(); ++i)
      if (moved_->candidates[i] < 0) added.push_back(moved_->configurations[i]);
    const std::size_t others = added.size();
    const std::vector<int> kept = promising(moved_->candidates);
    const ExtendedTask extended(task_, kept, std::move(added));
    std::vector<int> start;
    std::size_t next = task_.workspace->support.size();
    for (const int candidate : moved_->candidates)
      start.push_back(candidate >= 0 ? int(std::lower_bound(kept.begin(), kept.end(), candidate) - kept.begin())
                                     : int(kept.size() + next++));
    if (next != others) throw std::logic_error("auto: poses and configurations do not match");
    PlannerOptions options = options_;
    options.seed = mix_bits(seed) + 2;
    options.restarts = std::max(1, options_.restarts / 2);
    const Design found = run_restarts(extended.task(), options, monitor_, "new candidates",
                                      [&](const DesignTask& task, std::size_t i, Random& random, const Monitor& watch) {
                                        const auto from = i % 2 == 0 ? start : start_of_restart(task, i, random);
                                        return exchange_search(task, from, options.kicks, random, watch);
                                      });
    best_.exchanges += found.exchanges;
    PoseSet poses = extended.pose_set(task_, found.members);
    poses.value = found.value;
    improve_from(std::move(poses));
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
  const Monitor& monitor_;
  Clock::time_point begin_;
  Design best_;
  std::optional<PoseSet> moved_;
};

}  // namespace

Design AutomaticPlanner::do_plan(const DesignTask& task, const PlannerOptions& options, const Monitor& monitor) const {
  return Run(task, options, monitor).carry_out();
}

}  // namespace posewright
