#include "replacements.hpp"

#include <algorithm>
#include <cmath>

#include "../without_roadmap.hpp"
#include "posewright/study/expected_error.hpp"
#include "posewright/study/judgement.hpp"
#include "posewright/study/study.hpp"
#include "posewright/study/variant.hpp"
#include "posewright/study/written_plan.hpp"
#include "posewright/support/error.hpp"
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

/// The poses of the list that `wanted` takes, by place and id.
template <class Wanted>
PoseList subset(const PoseList& plan, const Wanted& wanted) {
  PoseList list;
  list.name = plan.name;
  for (std::size_t i = 0; i < plan.configurations.size(); ++i)
    if (wanted(i, plan.ids.empty() ? int(i) + 1 : plan.ids[i])) list.configurations.push_back(plan.configurations[i]);
  return list;
}

Configurations configurations_of(const PoseList& list, std::size_t dimension) {
  Configurations result;
  result.dimension = int(dimension);
  for (const std::vector<double>& q : list.configurations) append(result, q);
  return result;
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

std::optional<RouteWorth> worth_of_route(const Problem& problem, const PoseList& plan, const PoseList& routed,
                                         const Route& route, const Monitor& monitor) {
  const auto measured = [&](std::size_t i) { return !plan.measured.empty() && plan.measured[i]; };
  const auto on_route = [&](std::size_t, int id) {
    return std::any_of(route.poses.begin(), route.poses.end(), [&](const PlannedPose& pose) { return pose.id == id; });
  };
  const PoseList kept = subset(routed, on_route);
  const PoseList all = subset(plan, [&](std::size_t i, int) { return !measured(i); });
  RunOptions run;
  run.candidates_from = kept;
  if (std::find(plan.measured.begin(), plan.measured.end(), true) != plan.measured.end())
    run.measured = subset(plan, [&](std::size_t i, int) { return measured(i); });
  try {
    Problem free = without_roadmap(problem);
    free.design.poses = Located<int>{int(kept.configurations.size()), 0};
    const Study study = make_study(resolve(free, run, monitor), monitor);
    const std::size_t dimension = study.first().workspace->coordinates().size();
    const Judgement left = judge(study, configurations_of(kept, dimension));
    const Judgement planned = judge(study, configurations_of(all, dimension));
    const VariantColumns& columns = study.first().columns;
    const auto interest = double(columns.parameters.size()) - columns.nuisance;
    const double gain = left.evaluations.front().log_det - planned.evaluations.front().log_det;
    RouteWorth worth{std::exp(gain / interest)};
    // The list is all that is known of the workspace: without test poses no place stands apart from it.
    if (study.first().test_points.empty()) return worth;
    const auto expected = [&](const PoseList& list, const Judgement& judgement) {
      return expected_error(study.configurations, study.first(),
                            with_measured(study, configurations_of(list, dimension)),
                            judgement.evaluations.front().covariance, study.planner.threads);
    };
    worth.planned = expected(all, planned);
    worth.left = expected(kept, left);
    return worth;
  } catch (const CannotDo&) {
    return std::nullopt;
  }
}

}  // namespace posewright
