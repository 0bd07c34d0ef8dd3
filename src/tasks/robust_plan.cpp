#include "robust_plan.hpp"

#include <algorithm>
#include <cmath>

#include "posewright/study/drawn_robots.hpp"
#include "posewright/study/judgement.hpp"

namespace posewright {
namespace {

RobustPlan figures_of(const RobustResult& result, const RobustSpec& spec, bool searched) {
  RobustPlan plan;
  plan.draws = spec.draws;
  plan.aim = spec.aim;
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

/// Efficiency of the plan without each of its poses, for the nominal robot.
std::vector<double> without_each(const SearchResult& found, const Study& study) {
  const Configurations chosen = chosen_by(found.design, study.configurations);
  const auto phi = [&](const Configurations& poses) { return phi_of(*found.measure, study.criterion, study, poses); };
  const double whole = phi(chosen), degree = found.degree > 0 ? found.degree : 1.0;
  std::vector<double> left;
  for (std::size_t i = 0; i < chosen.count(); ++i)
    left.push_back(std::min(1.0, std::exp((phi(without(chosen, {int(i)})) - whole) / degree)));
  return left;
}

}  // namespace

RobustPlan plan_robust(const Study& study, SearchResult& found, const Monitor& monitor) {
  Configurations all = study.configurations;
  // What optimal weights use counts as candidates, as in the certificate.
  std::vector<std::vector<double>>& added = found.design.added;
  added.insert(added.end(), found.support.begin(), found.support.end());
  for (const std::vector<double>& q : added) append(all, q);
  const DrawnRobots robots(study, all, monitor);
  const RobustResult result = search_robust(robust_request(study, robots, all, found.design.members), monitor);
  if (result.plan != found.design.members) {
    found.design.members = result.plan;
    found.design.optimal = false;
    found.without = without_each(found, study);
  }
  found.design.exchanges += result.exchanges;
  return figures_of(result, *study.robust, true);
}

RobustPlan judge_robust_list(const Study& study, const Configurations& candidates, const std::vector<int>& list,
                             const Monitor& monitor) {
  const DrawnRobots robots(study, candidates, monitor);
  return figures_of(judge_robust(robust_request(study, robots, candidates, list), monitor), *study.robust, false);
}

}  // namespace posewright
