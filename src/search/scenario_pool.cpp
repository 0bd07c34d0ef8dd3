#include "scenario_pool.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "posewright/support/parallel.hpp"

namespace posewright {
namespace {

// Candidates that a plan is sought among; no more than fit into this memory.
constexpr std::size_t least_pool = 240;
constexpr double most_pool_bytes = 1.2e9;
constexpr std::size_t most_representatives = 20;

std::vector<int> herded(const ScenarioFigures& figures, const std::vector<int>& candidates, std::size_t count) {
  Eigen::MatrixXd features(Eigen::Index(candidates.size()), Eigen::Index(figures.scenarios()));
  for (Eigen::Index k = 0; k < features.cols(); ++k)
    for (Eigen::Index i = 0; i < features.rows(); ++i)
      features(i, k) = figures.sensitivity(std::size_t(k), candidates[std::size_t(i)]);
  features.colwise() -= features.rowwise().mean().eval();
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(features.rows());
  std::vector<char> taken(figures.scenarios(), 0);
  std::vector<int> chosen;
  while (chosen.size() < count) {
    int best = -1;
    double least = std::numeric_limits<double>::infinity();
    for (Eigen::Index k = 0; k < features.cols(); ++k) {
      const double distance = (sum + features.col(k)).squaredNorm();
      if (taken[std::size_t(k)] != 0 || !(distance < least)) continue;
      least = distance;
      best = int(k);
    }
    sum += features.col(best);
    taken[std::size_t(best)] = 1;
    chosen.push_back(best);
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

}  // namespace

ScenarioPool::ScenarioPool(const ScenarioFigures& figures, const RobustRequest& request,
                           const std::vector<double>& values, const CandidateWeights& weighted)
    : figures_(figures), request_(request) {
  std::vector<char> taken(figures.nominal().count(), 0);
  const auto take = [&](int i) {
    if (std::exchange(taken[std::size_t(i)], char(1)) == 0) candidates_.push_back(i);
  };
  for (const int i : request.plan) take(i);
  for (const int i : figures.optimum().weighted()) take(i);
  for (const auto& [i, weight] : weighted) take(i);
  const std::size_t scenarios = figures.scenarios();
  const double each = double(scenarios) * figures.nominal().rows() * figures.nominal().stride() * sizeof(double);
  const std::size_t size =
      std::min(std::max(least_pool, std::size_t(6 * request.poses)), std::size_t(most_pool_bytes / each));
  for (const int i : by_value(figures.mean_sensitivity(figures.combination(scenarios).supporting(values)), true)) {
    if (candidates_.size() >= size) break;
    take(i);
  }
  std::sort(candidates_.begin(), candidates_.end());
  blocks_.resize(scenarios);
  priors_.resize(scenarios);
  parallel_for(scenarios, thread_count(request.planner.threads), [&](std::size_t k, int) {
    auto blocks = std::make_shared<BlockArray>(request.blocks(int(k), candidates_));
    figures.whiten(*blocks);
    blocks_[k] = std::move(blocks);
    priors_[k] = figures.prior_of(int(k));
  });
  nominal_ = figures.nominal().subset(candidates_);
  if (request.spacing) spacing_ = request.spacing->of(candidates_);
}

std::vector<int> ScenarioPool::in_pool(const std::vector<int>& members) const {
  std::vector<int> result;
  result.reserve(members.size());
  for (const int i : members)
    result.push_back(int(std::lower_bound(candidates_.begin(), candidates_.end(), i) - candidates_.begin()));
  return result;
}

CandidateView ScenarioPool::view() const {
  CandidateView view;
  view.blocks = &nominal_;
  view.nuisance = request_.nuisance;
  view.max_repeats = std::min(request_.repeats.most, request_.poses);
  view.spacing = request_.spacing ? &spacing_ : nullptr;
  return view;
}

ScenarioCriterion ScenarioPool::criterion(const std::vector<int>& scenarios) const {
  std::vector<Scenario> some;
  some.reserve(scenarios.size());
  for (const int k : scenarios)
    some.push_back({blocks_[std::size_t(k)], request_.nuisance, 1.0, figures_.references()[std::size_t(k)],
                    priors_[std::size_t(k)]});
  return {std::move(some), request_.aim, double(figures_.scenarios())};
}

std::vector<double> ScenarioPool::values_of(const std::vector<int>& members) const {
  std::vector<double> values(blocks_.size());
  parallel_for(values.size(), thread_count(request_.planner.threads), [&](std::size_t k, int) {
    values[k] = figures_.efficiency(figures_.log_det_of(*blocks_[k], priors_[k], members), k);
  });
  return values;
}

std::vector<double> ScenarioPool::in_pool(const CandidateWeights& weights) const {
  std::vector<double> result(candidates_.size(), 0.0);
  for (const auto& [i, weight] : weights) {
    const auto found = std::lower_bound(candidates_.begin(), candidates_.end(), i);
    if (found != candidates_.end() && *found == i) result[std::size_t(found - candidates_.begin())] = weight;
  }
  return result;
}

std::vector<int> ScenarioPool::heaviest(const CandidateWeights& weights) const {
  std::vector<int> chosen;
  for (const int i : by_value(in_pool(weights), true)) {
    if (int(chosen.size()) == request_.poses) break;
    if (!request_.spacing || spacing_.admits(chosen, i)) chosen.push_back(i);
  }
  if (int(chosen.size()) < request_.poses) chosen.clear();
  return chosen;
}

std::vector<int> representatives(const ScenarioFigures& figures, const RobustAim& aim,
                                 const std::vector<int>& candidates, const std::vector<double>& values,
                                 const std::vector<int>& before) {
  const std::size_t count = std::min(values.size(), most_representatives);
  if (aim.measure == RobustAim::Measure::mean) return herded(figures, candidates, count);
  const auto tail = aim.measure == RobustAim::Measure::tail ? std::size_t(std::ceil(aim.share * double(values.size())))
                                                            : std::size_t(1);
  std::vector<int> chosen = before, order = by_value(values, false);
  order.resize(std::min(order.size(), std::max(count, tail + tail / 2)));
  for (const int k : order)
    if (std::find(chosen.begin(), chosen.end(), k) == chosen.end()) chosen.push_back(k);
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

}  // namespace posewright
