#include "replacements.hpp"

#include <algorithm>

#include "posewright/study/variant.hpp"
#include "posewright/study/written_plan.hpp"
#include "posewright/tasks/plan_problem.hpp"

namespace posewright {
namespace {

// Drawn ones: each has to be connected with home.
constexpr int most_candidates = 1000;

int id_of(const PoseList& list, std::size_t i) { return list.ids.empty() ? int(i) + 1 : list.ids[i]; }

bool is_lost(const Route& route, int id) {
  return std::any_of(route.unreachable.begin(), route.unreachable.end(),
                     [&](const SkippedPose& lost) { return lost.pose == id; });
}

/// The plan's own pose for which one that is lost now was taken.
void note_replaced(std::vector<SkippedPose>& replaced, const SkippedPose& lost, int by) {
  const auto before =
      std::find_if(replaced.begin(), replaced.end(), [&](const SkippedPose& r) { return r.by == lost.pose; });
  if (before != replaced.end()) before->by = by;
  else replaced.push_back({lost.pose, lost.reason, by});
}

Plan next_best(Problem problem, const PoseList& kept, int poses, std::uint64_t seed, const Monitor& monitor) {
  problem.workspace.motion.reachable = true;
  DesignSpec& design = problem.design;
  design.poses = {poses, design.line};
  design.smallest = false;
  if (!design.candidates_from) design.candidates.value = std::min(design.candidates.value, most_candidates);
  design.robust.reset();
  RunOptions run;
  run.measured = kept;
  run.fixed = PoseList{};
  run.candidates_alone = true;
  run.proof.seconds = 0;
  run.seed = seed;
  return plan_problem(problem, run, monitor);
}

}  // namespace

PoseList with_replacements(const Problem& problem, const PoseList& list, const Route& route, std::uint64_t seed,
                           const Monitor& monitor, std::vector<SkippedPose>& replaced) {
  PoseList rest = list, kept;
  rest.configurations.clear();
  rest.ids.clear();
  rest.measured.clear();
  int last = 0;
  for (std::size_t i = 0; i < list.configurations.size(); ++i) {
    const int id = id_of(list, i);
    last = std::max(last, id);
    if (is_lost(route, id)) continue;
    rest.configurations.push_back(list.configurations[i]);
    rest.ids.push_back(id);
    rest.measured.push_back(!list.measured.empty() && list.measured[i]);
  }
  kept.name = list.name;
  kept.configurations = rest.configurations;
  const Plan plan = next_best(problem, kept, int(route.unreachable.size()), seed + std::uint64_t(last), monitor);
  const PoseList found = poses_of(plan, pose_coordinates(problem));
  std::size_t next = 0;
  for (std::size_t i = 0; i < found.configurations.size(); ++i) {
    if (found.measured[i]) continue;
    rest.configurations.push_back(found.configurations[i]);
    rest.ids.push_back(++last);
    rest.measured.push_back(false);
    note_replaced(replaced, route.unreachable[next++], last);
  }
  return rest;
}

void settle_replaced(Route& route) {
  for (SkippedPose& lost : route.unreachable) {
    const auto own = std::find_if(route.replaced.begin(), route.replaced.end(),
                                  [&](const SkippedPose& r) { return r.by == lost.pose; });
    if (own == route.replaced.end()) continue;
    lost = {own->pose, own->reason};
    route.replaced.erase(own);
  }
}

}  // namespace posewright
