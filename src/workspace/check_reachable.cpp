#include <algorithm>

#include "checks.hpp"
#include "posewright/support/error.hpp"
#include "posewright/workspace/motion_space.hpp"

namespace posewright {
namespace {

constexpr int milestones = 400;
constexpr std::uint64_t roadmap_seed = 31415;
// Milestones that a pose is tried with, nearest first.
constexpr std::size_t tries = 8;

/// Of this thread: the milestone from which a motion led to a pose last.
std::size_t& last_milestone() {
  static thread_local std::size_t last = 0;
  return last;
}

/// A straight motion leads to the part of a roadmap that home belongs to. A pose that none is found for may still be
/// reachable by a way that the roadmap does not know: the check errs on the safe side.
class ReachableCheck : public SingleCheck {
 public:
  ReachableCheck(const Problem& problem, const Cell* cell, const Monitor& monitor)
      : SingleCheck("not reachable from home"),
        space_(problem, std::shared_ptr<const Cell>(std::shared_ptr<void>(), cell)) {
    const std::vector<double> home = space_.home();
    if (const std::string why = space_.violation(home); !why.empty())
      throw CannotDo("home is not free: " + why + "; set workspace: motion: home to a configuration that is");
    Roadmap roadmap(space_, milestones, roadmap_seed, RoadmapUse::connection, monitor);
    if (monitor.should_stop())
      throw CannotDo("stopped before the search for configurations reachable from home was finished");
    milestones_ = roadmap.connected(home);
  }
  bool follows_motions() const override { return true; }

 private:
  bool holds(std::span<const double> q) const override {
    const std::vector<double> at = space_.reduced(q);
    std::vector<std::pair<double, std::size_t>> near;
    for (std::size_t i = 0; i < milestones_.size(); ++i) near.emplace_back(space_.distance(at, milestones_[i]), i);
    const std::size_t count = std::min(tries, near.size());
    std::partial_sort(near.begin(), near.begin() + std::ptrdiff_t(count), near.end());
    // The one that led to the pose asked for before is often near.
    std::size_t& last = last_milestone();
    if (const auto known = std::find_if(near.begin(), near.begin() + std::ptrdiff_t(count),
                                        [last](const auto& n) { return n.second == last; });
        known != near.begin() + std::ptrdiff_t(count))
      std::rotate(near.begin(), known, known + 1);
    return std::any_of(near.begin(), near.begin() + std::ptrdiff_t(count), [&](const auto& n) {
      if (!space_.is_free(at, milestones_[n.second])) return false;
      last = n.second;
      return true;
    });
  }

  MotionSpace space_;
  std::vector<std::vector<double>> milestones_;
};

}  // namespace

void add_reachable_check(const CheckContext& context, Checks& checks) {
  if (!context.problem.workspace.motion.reachable) return;
  const Monitor unwatched;
  const Monitor& monitor = context.monitor == nullptr ? unwatched : *context.monitor;
  checks.push_back(std::make_unique<ReachableCheck>(context.problem, context.cell, monitor));
}

}  // namespace posewright
