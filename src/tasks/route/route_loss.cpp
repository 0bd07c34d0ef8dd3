#include "route_loss.hpp"

#include <algorithm>
#include <cmath>

#include "../without_roadmap.hpp"
#include "posewright/study/expected_error.hpp"
#include "posewright/study/judgement.hpp"
#include "posewright/study/study.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

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
