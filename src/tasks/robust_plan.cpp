#include "robust_plan.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "posewright/criterion/registry.hpp"
#include "posewright/study/drawn_robots.hpp"
#include "posewright/study/judgement.hpp"

namespace posewright {
namespace {

RobustPlan figures_of(const RobustResult& result, const Settings& settings, bool searched) {
  RobustPlan plan;
  plan.draws = settings.robust->draws;
  plan.measure = robust_aim_text(settings.robust->aim);
  plan.searched = searched;
  plan.references = result.references;
  plan.nominal = result.nominal.efficiency;
  plan.efficiency = result.robust.efficiency;
  plan.nominal_value = result.nominal.combined;
  plan.value = result.robust.combined;
  plan.bound = result.bound;
  plan.unreached = result.unreached;
  plan.stopped = result.stopped;
  return plan;
}

/// What is left of the plan without each of its poses, for the nominal robot.
std::vector<double> without_each(const SearchResult& found, const Study& study, const Settings& settings,
                                 const Configurations& all) {
  const auto phi_of_members = [&](std::size_t left_out) {
    Configurations some;
    some.dimension = all.dimension;
    for (std::size_t i = 0; i < found.design.members.size(); ++i)
      if (i != left_out) append(some, all[std::size_t(found.design.members[i])]);
    return phi_of(*found.measure, settings.criterion, study, some, settings);
  };
  const double whole = phi_of_members(found.design.members.size());
  std::vector<double> without;
  for (std::size_t i = 0; i < found.design.members.size(); ++i)
    without.push_back(std::min(1.0, std::exp((phi_of_members(i) - whole) / (found.degree > 0 ? found.degree : 1.0))));
  return without;
}

}  // namespace

RobustPlan plan_robust(const Problem& problem, const Study& study, const Settings& settings, SearchResult& found,
                       const Monitor& monitor) {
  Configurations all = study.configurations;
  all.rows.clear();
  // What optimal weights use counts as candidates, as in the certificate.
  std::vector<std::vector<double>>& added = found.design.added;
  added.insert(added.end(), found.support.begin(), found.support.end());
  for (const std::vector<double>& q : added) append(all, q);
  const DrawnRobots robots(problem, study, all, settings.planner.seed, settings.planner.threads, monitor);
  Spacing spacing;
  const RobustResult result =
      search_robust(robust_request(study, settings, robots, all, found.design.members, spacing), monitor);
  if (result.plan != found.design.members) {
    found.design.members = result.plan;
    found.design.optimal = false;
    found.without = without_each(found, study, settings, all);
  }
  found.design.exchanges += result.exchanges;
  return figures_of(result, settings, true);
}

RobustPlan judge_robust_list(const Problem& problem, const Study& study, const Settings& settings,
                             const Configurations& poses, const Monitor& monitor) {
  Configurations all = study.configurations;
  all.rows.clear();
  std::vector<int> plan(poses.count());
  std::iota(plan.begin(), plan.end(), int(all.count()));
  for (std::size_t i = 0; i < poses.count(); ++i) append(all, poses[i]);
  const DrawnRobots robots(problem, study, all, settings.planner.seed, settings.planner.threads, monitor);
  Spacing spacing;
  return figures_of(judge_robust(robust_request(study, settings, robots, all, std::move(plan), spacing), monitor),
                    settings, false);
}

}  // namespace posewright
