#include "robust_weights.hpp"

#include <algorithm>
#include <cmath>

#include "posewright/criterion/sensitivity.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/parallel.hpp"

namespace posewright {
namespace {

constexpr int most_steps = 80;
// Scenarios that the weights leave undetermined are taken up so often.
constexpr int rounds_for_singular = 4;
// Ends where what the weights may still gain is below this share of the efficiency.
constexpr double settled_gap = 1e-3;
// The soft minimum that stands for the worst.
constexpr double sharpness = 100.0;
// So that no candidate of the pool is left out for ever, and no scenario is singular at the start.
constexpr double spread = 0.1;
constexpr double negligible = 1e-7;

/// w scaled so that Σ min(w, cap) = 1.
void share_out(std::vector<double>& w, double cap) {
  std::vector<char> full(w.size(), 0);
  for (std::size_t round = 0; round <= w.size(); ++round) {
    double rest = 1.0, sum = 0.0;
    for (std::size_t i = 0; i < w.size(); ++i) (full[i] != 0 ? rest : sum) += full[i] != 0 ? -cap : w[i];
    bool more = false;
    for (std::size_t i = 0; i < w.size(); ++i) {
      if (full[i] != 0) continue;
      w[i] *= rest / sum;
      if (w[i] < cap * (1 - 1e-12)) continue;
      full[i] = 1;
      more = true;
    }
    for (std::size_t i = 0; i < w.size(); ++i)
      if (full[i] != 0) w[i] = cap;
    if (!more) return;
  }
}

/// Per pose.
Eigen::MatrixXd information(const ScenarioPool& pool, std::size_t scenario, const std::vector<double>& w,
                            const Eigen::MatrixXd& prior) {
  const BlockArray& blocks = pool.blocks(scenario);
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(blocks.columns(), blocks.columns());
  if (prior.size() > 0) M = prior;
  for (std::size_t i = 0; i < w.size(); ++i) {
    if (!(w[i] > negligible)) continue;
    const auto block = blocks.block(i);
    M.noalias() += w[i] * block.transpose() * block;
  }
  return M;
}

/// Parts of the aim and their derivatives at some weights.
class AtWeights {
 public:
  AtWeights(const ScenarioFigures& figures, const RobustRequest& request, const ScenarioPool& pool,
            std::vector<int> scenarios)
      : figures_(figures),
        request_(request),
        pool_(pool),
        scenarios_(std::move(scenarios)),
        values_(scenarios_.size()),
        d_(scenarios_.size()) {}

  /// Σ_k λ_k d_ik, at λ that support the aim there; `of_prior` the same of what is there before.
  std::vector<double> derivative(const std::vector<double>& w, double& of_prior) {
    std::vector<double> prior_share(scenarios_.size(), 0.0);
    parallel_for(scenarios_.size(), thread_count(request_.planner.threads), [&](std::size_t s, int) {
      const auto k = std::size_t(scenarios_[s]);
      const BlockArray& blocks = pool_.blocks(k);
      const Eigen::MatrixXd prior = pool_.prior(k) / double(request_.poses);
      d_[s].assign(w.size(), 0.0);
      const auto expansion = figures_.function().expand(information(pool_, k, w, prior));
      values_[s] = -1e3;
      if (expansion == nullptr) return;
      values_[s] =
          (expansion->value + figures_.interest() * std::log(double(request_.poses)) - figures_.references()[k]) /
          figures_.interest();
      sensitivities(blocks, expansion->factor, 1, d_[s]);
      if (prior.size() > 0) prior_share[s] = (expansion->factor.transpose() * prior * expansion->factor).trace();
    });
    const std::vector<double> lambda = supporting();
    std::vector<double> d(w.size(), 0.0);
    of_prior = 0.0;
    for (std::size_t s = 0; s < scenarios_.size(); ++s) {
      of_prior += lambda[s] * prior_share[s];
      for (std::size_t i = 0; i < w.size(); ++i) d[i] += lambda[s] * d_[s][i];
    }
    return d;
  }

 private:
  std::vector<double> supporting() const {
    const bool mean = request_.aim.measure == RobustAim::Measure::mean;
    const double whole = mean ? double(scenarios_.size()) : double(figures_.weights().size());
    if (request_.aim.measure != RobustAim::Measure::worst)
      return supporting_weights(request_.aim, values_, std::vector<double>(scenarios_.size(), 1.0), whole);
    const double lowest = *std::min_element(values_.begin(), values_.end());
    std::vector<double> lambda;
    double sum = 0.0;
    for (const double value : values_) {
      lambda.push_back(std::exp(-sharpness * (value - lowest)));
      sum += lambda.back();
    }
    for (double& weight : lambda) weight /= sum;
    return lambda;
  }

  const ScenarioFigures& figures_;
  const RobustRequest& request_;
  const ScenarioPool& pool_;
  std::vector<int> scenarios_;
  std::vector<double> values_;
  std::vector<std::vector<double>> d_;
};

/// Adds those scenarios that the weights do not determine.
void take_singular(const ScenarioFigures& figures, const RobustRequest& request, const ScenarioPool& pool,
                   const std::vector<double>& w, std::vector<int>& scenarios) {
  const std::size_t count = figures.weights().size();
  std::vector<char> singular(count, 0);
  parallel_for(count, thread_count(request.planner.threads), [&](std::size_t k, int) {
    const Eigen::MatrixXd prior = pool.prior(k) / double(request.poses);
    singular[k] = std::isfinite(figures.function().value(information(pool, k, w, prior))) ? 0 : 1;
  });
  for (std::size_t k = 0; k < count; ++k)
    if (singular[k] != 0 && !std::binary_search(scenarios.begin(), scenarios.end(), int(k)))
      scenarios.insert(std::upper_bound(scenarios.begin(), scenarios.end(), int(k)), int(k));
}

}  // namespace

CandidateWeights robust_weights(const ScenarioFigures& figures, const RobustRequest& request, const ScenarioPool& pool,
                                const CandidateWeights& start, const Monitor& monitor) {
  const std::vector<int>& candidates = pool.candidates();
  std::vector<double> w(candidates.size(), spread / double(candidates.size()));
  for (const auto& [i, weight] : start) {
    const auto found = std::lower_bound(candidates.begin(), candidates.end(), i);
    if (found != candidates.end() && *found == i) w[std::size_t(found - candidates.begin())] += (1 - spread) * weight;
  }
  const double cap = figures.cap();
  share_out(w, cap);
  std::vector<int> scenarios = representatives(figures, request.aim, candidates, figures.given(), {});
  for (int round = 0; round < rounds_for_singular && !monitor.should_stop(); ++round) {
    AtWeights at(figures, request, pool, scenarios);
    for (int step = 0; step < most_steps && !monitor.should_stop(); ++step) {
      double of_prior = 0.0;
      const std::vector<double> d = at.derivative(w, of_prior);
      if (best_mean(d, cap) + of_prior < figures.interest() * (1 + settled_gap)) break;
      for (std::size_t i = 0; i < w.size(); ++i) w[i] *= d[i] + of_prior;
      share_out(w, cap);
    }
    const std::size_t before = scenarios.size();
    take_singular(figures, request, pool, w, scenarios);
    if (scenarios.size() == before) break;
    for (double& weight : w) weight += spread / double(w.size());
    share_out(w, cap);
  }
  CandidateWeights result;
  double sum = 0.0;
  for (const double weight : w) sum += weight > negligible ? weight : 0.0;
  for (std::size_t i = 0; i < w.size(); ++i)
    if (w[i] > negligible) result.emplace_back(candidates[i], w[i] / sum);
  return result;
}

}  // namespace posewright
