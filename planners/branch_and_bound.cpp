#include <algorithm>
#include <cmath>
#include <numeric>

#include "design_tree.hpp"
#include "exchange.hpp"
#include "planners.hpp"
#include "posewright/criterion/information_function.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/parallel.hpp"

namespace posewright {
namespace {

// Designs that are better by less count as equal.
constexpr double equal_values = 1e-9;
constexpr double most_enumerated = 3e6;

/// Number of sets of N of n, with repeats or without.
double number_of_sets(double n, int poses, bool repeats) {
  double sets = 1.0;
  for (int i = 0; i < poses; ++i) sets *= (repeats ? n + i : n - i) / (i + 1);
  return sets;
}

class Enumeration {
 public:
  Enumeration(const DesignTask& task, const Monitor& monitor, Design& best)
      : task_(task), monitor_(monitor), best_(best), members_(std::size_t(task.poses)) {
    const BlockArray& blocks = *task.candidates.blocks;
    const int m = blocks.columns();
    base_ = task.candidates.prior != nullptr ? *task.candidates.prior : Eigen::MatrixXd::Zero(m, m);
  }
  bool run() { return next(0, 0, 0, base_); }

 private:
  bool next(int position, int first, int repeated, const Eigen::MatrixXd& information) {
    if (position == task_.poses) {
      if (monitor_.should_stop()) return false;
      const double value = task_.criterion->of_information_alone()
                               ? task_.criterion->function().value(information)
                               : task_.criterion->start(task_.candidates, members_)->value();
      if (value <= best_.value + equal_values || !allowed()) return true;
      best_.value = value;
      best_.members = members_;
      return true;
    }
    const BlockArray& blocks = *task_.candidates.blocks;
    for (int i = first; i < int(blocks.count()); ++i) {
      const int used = i == first && position > 0 ? repeated : 0;
      if (used >= task_.candidates.max_repeats) continue;
      members_[std::size_t(position)] = i;
      const auto block = blocks.block(std::size_t(i));
      if (!next(position + 1, i, used + 1, information + block.transpose() * block)) return false;
    }
    return true;
  }

  bool allowed() const { return task_.candidates.spacing == nullptr || task_.candidates.spacing->allows(members_); }

  const DesignTask& task_;
  const Monitor& monitor_;
  Design& best_;
  std::vector<int> members_;
  Eigen::MatrixXd base_;
};

/// The proved optimum over the candidates (Welch 1982, Technometrics 24(1)). Each node fixes how often some candidates
/// are chosen at least and at most (DesignTree); its bound is the optimum over numbers that need not be whole
/// (NodeRelaxation), which knows how few rows are left to choose (RankLimitedLogDet; RowInertia for o3). `exchange`
/// finds the design to begin with. Criteria without a bound are enumerated; throws CannotDo if that would be more than
/// a few million sets. Ends early when the monitor says so, or where PlannerOptions::gap lets it: `optimal` tells, and
/// `bound` what no design exceeds.
Design proved_design(const DesignTask& task, const PlannerOptions& options, const Monitor& monitor) {
  PlannerOptions first = options;
  first.use_all_time = false;  // the proof is what takes it
  Design design = exchange_planner().plan(task, first, monitor);
  if (task.criterion->function().degree() > 0) {
    DesignTree tree(task, thread_count(options.threads), monitor, design, options.gap);
    // Where there is a smoother criterion, Φ has kinks and many local optima.
    if (task.criterion->smoother() != nullptr)
      tree.search_beside([&](int starts, int call) {
        PlannerOptions more = first;
        more.restarts = starts;
        more.seed += std::uint64_t(call);
        return exchange_planner().plan(task, more, monitor);
      });
    const bool ended = tree.run();
    design.optimal = ended && *design.bound <= design.value + equal_values;
    design.stopped = !ended;
    return design;
  } else {
    const double sets =
        number_of_sets(double(task.candidates.blocks->count()), task.poses, task.candidates.max_repeats > 1);
    // With reserve each set costs N factorisations.
    if (!(sets <= (task.criterion->of_information_alone() ? most_enumerated : 0.01 * most_enumerated)))
      throw CannotDo("criterion " + task.criterion->name() +
                     " gives parts of the choice no bound: every set would have to be tried, and there are too many; "
                     "other methods state how near the best their plan is");
    design.optimal = Enumeration(task, monitor, design).run();
  }
  design.stopped = !design.optimal;
  return design;
}

}  // namespace

Planner branch_and_bound_planner() {
  return {"branch_and_bound", "the proved optimum of small problems", proved_design};
}

}  // namespace posewright
