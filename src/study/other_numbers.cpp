#include "posewright/study/other_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "posewright/search/other_sizes.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/parallel.hpp"

namespace posewright {
namespace {

// Other numbers of poses, as shares of the plan's own.
constexpr double shares_of_poses[] = {0.6, 0.8, 1.25, 1.6, 2.0};

/// Candidates and the poses beside them.
struct PosePool {
  Configurations configurations;
  std::vector<int> own;  // indices of the poses
};

PosePool pool_with(const Configurations& own, const Configurations& candidates) {
  PosePool pool{candidates, {}};
  for (std::size_t k = 0; k < own.count(); ++k) {
    const auto q = own[k];
    std::size_t i = 0;
    while (i < pool.configurations.count() && !std::equal(q.begin(), q.end(), pool.configurations[i].begin())) ++i;
    if (i == pool.configurations.count()) append(pool.configurations, q);
    pool.own.push_back(int(i));
  }
  return pool;
}

/// Numbers of poses of a search, without the fixed ones.
std::vector<int> numbers_beside(int own, int fixed, double most) {
  std::set<int> numbers;
  for (const double share : shares_of_poses)
    if (const int number = int(std::lround(share * (own + fixed))) - fixed;
        number >= 1 && number != own && number <= most)
      numbers.insert(number);
  return {numbers.begin(), numbers.end()};
}

}  // namespace

CurvePoint figures_of(const Study& study, const Judgement& judgement, int poses) {
  const Evaluation& evaluation = judgement.evaluations.front();
  CurvePoint point{poses, evaluation.log_det, judgement.rho0, 0.0, false};
  const VariantColumns& columns = study.first().columns;
  for (std::size_t j = std::size_t(columns.nuisance); j < columns.parameters.size(); ++j)
    point.worst_sigma =
        std::max(*point.worst_sigma, evaluation.sigma[Eigen::Index(j)] / columns.parameters[j].tolerance);
  return point;
}

std::vector<CurvePoint> other_numbers(const Study& study, const Configurations& own, const Configurations& candidates,
                                      const std::vector<double>& references, const Monitor& monitor) {
  const int threads = study.planner.threads, fixed = int(study.fixed.count());
  const PosePool pool = pool_with(own, candidates);
  const std::vector<int> numbers =
      numbers_beside(int(own.count()), fixed, double(pool.configurations.count()) * study.repeats.most);
  if (numbers.empty() || monitor.should_stop()) return {};
  SearchRequest request = search_request(study, int(own.count()));
  request.references = references;
  const std::optional<Spacing> spacing = study.distance.among(pool.configurations);
  if (spacing) request.spacing = &*spacing;
  const std::vector<std::vector<int>> found = designs_of_sizes(
      search_parts(study, study.criterion, pool.configurations, threads), request, pool.own, numbers, monitor);
  std::vector<CurvePoint> points;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i].empty()) continue;
    Configurations list = study.fixed;
    list.dimension = pool.configurations.dimension;
    for (const int k : found[i]) append(list, pool.configurations[std::size_t(k)]);
    try {
      points.push_back(figures_of(study, judge(study, list), numbers[i] + fixed));
    } catch (const CannotDo&) {
      // The search counts what is known before, the figures of the list may not.
    }
  }
  return points;
}

}  // namespace posewright
