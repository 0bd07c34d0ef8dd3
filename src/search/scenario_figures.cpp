#include "scenario_figures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "posewright/criterion/sensitivity.hpp"
#include "posewright/planning/whiten.hpp"
#include "posewright/support/bytes.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/tasks.hpp"

namespace posewright {
namespace {

// References one part in a thousand of an efficiency too high say nothing else of a plan.
constexpr double reference_tolerance = 1e-3;
constexpr double rounding = 1e-12;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Where weights of a scenario like the nominal one are, ascending: few, because a step costs the cube of their number.
std::vector<int> first_set(const ApproximateDesign& optimum, std::size_t least) {
  std::vector<int> order(optimum.sensitivity.size()), set = optimum.weighted();
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return optimum.sensitivity[std::size_t(a)] > optimum.sensitivity[std::size_t(b)];
  });
  const std::size_t wanted = std::max(least, 2 * set.size());
  std::vector<char> taken(order.size(), 0);
  for (const int i : set) taken[std::size_t(i)] = 1;
  for (const int i : order) {
    if (set.size() >= wanted) break;
    if (taken[std::size_t(i)] == 0) set.push_back(i);
  }
  std::sort(set.begin(), set.end());
  return set;
}

}  // namespace

ScenarioFigures::ScenarioFigures(const RobustRequest& request, const Monitor& monitor)
    : request_(request),
      monitor_(monitor),
      columns_(request.nominal.columns()),
      interest_(columns_ - request.nuisance),
      function_(request.nuisance, columns_),
      weights_(std::size_t(request.scenarios), 1.0) {
  const double n = request_.poses;
  std::vector<int> all(request_.nominal.count());
  std::iota(all.begin(), all.end(), 0);
  nominal_ = request_.nominal.subset(all);
  const Whitening whitening =
      posewright::whiten(nominal_, request_.prior.size() > 0 ? Eigen::MatrixXd(request_.prior / n) : Eigen::MatrixXd());
  R_ = whitening.R;
  offset_ = whitening.log_det_offset(request_.nuisance);
  options_.cap = std::min(1.0, double(request_.repeats.most) / n);
  options_.tolerance = reference_tolerance;
  ApproximateDesignOptions options = options_;
  options.threads = request_.planner.threads;
  options.prior = whitening.prior;
  optimum_ = solve_approximate_design(nominal_, function_, options, monitor_);
  options_.start = first_set(optimum_, std::size_t(std::ceil(2 / options_.cap)));
}

void ScenarioFigures::whiten(BlockArray& blocks) const {
  auto rows = blocks.all();
  R_.triangularView<Eigen::Upper>().solveInPlace<Eigen::OnTheRight>(rows);
}

Eigen::MatrixXd ScenarioFigures::prior_of(int scenario) const {
  if (!request_.prior_of) return {};
  Eigen::MatrixXd prior = request_.prior_of(scenario);
  R_.triangularView<Eigen::Upper>().solveInPlace<Eigen::OnTheRight>(prior);
  R_.transpose().triangularView<Eigen::Lower>().solveInPlace(prior);
  return prior;
}

Eigen::MatrixXd ScenarioFigures::information(const BlockArray& blocks, const std::vector<int>& members) {
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(blocks.columns(), blocks.columns());
  for (const int i : members) {
    const auto block = blocks.block(std::size_t(i));
    M.noalias() += block.transpose() * block;
  }
  return M;
}

std::string ScenarioFigures::reference_of(int scenario) const {
  BlockArray blocks = request_.blocks(scenario, {});
  whiten(blocks);
  const Eigen::MatrixXd prior = prior_of(scenario);
  ApproximateDesignOptions options = options_;
  if (prior.size() > 0) options.prior = prior / double(request_.poses);
  const Seen seen = look(blocks, prior, optimal_weights());
  // Where the nominal weights are as good as that, what they prove is enough.
  const double ratio = (best_mean(seen.sensitivity, options_.cap) + seen.of_prior) / interest_;
  const bool enough = std::isfinite(seen.value) && ratio < 1 + reference_tolerance;
  ByteWriter out;
  out.put(enough ? seen.value + interest_ * std::log(std::max(1.0, ratio) * (1 + rounding))
                 : solve_approximate_design(blocks, function_, options, Monitor()).bound_for(request_.poses));
  Eigen::MatrixXd M = information(blocks, request_.plan);
  if (prior.size() > 0) M += prior;
  out.put(function_.value(M));
  std::int64_t unreached = 0;
  for (std::size_t i = 0; i < blocks.count(); ++i) unreached += blocks.block(i).isZero(0.0) ? 1 : 0;
  out.put(unreached);
  put(seen, out);
  return out.take();
}

bool ScenarioFigures::find_references(long& unreached) {
  std::vector<double> references, given;
  Look all;
  const bool stopped = run_tasks(
      {"drawn robots", weights_.size(), request_.planner.threads},
      [&](std::size_t k, int) { return reference_of(int(k)); },
      [&](std::size_t, std::string_view bytes) {
        ByteReader in(bytes);
        references.push_back(in.get<double>());
        given.push_back((in.get<double>() - references.back()) / interest_);
        unreached += long(in.get<std::int64_t>());
        take(in, references.back(), all);
      },
      monitor_);
  if (references.size() < weights_.size()) return false;
  references_ = std::move(references);
  given_ = std::move(given);
  accept(std::move(all));
  return !stopped;
}

std::vector<double> ScenarioFigures::raw_references() const {
  std::vector<double> raw = references_;
  for (double& reference : raw) reference += offset_;
  return raw;
}

CandidateWeights ScenarioFigures::optimal_weights() const {
  CandidateWeights weights;
  for (std::size_t i = 0; i < optimum_.support.size(); ++i)
    weights.emplace_back(optimum_.support[i], optimum_.weights[i]);
  return weights;
}

ScenarioFigures::Seen ScenarioFigures::look(const BlockArray& blocks, const Eigen::MatrixXd& prior,
                                            const CandidateWeights& weights) const {
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(columns_, columns_);
  if (prior.size() > 0) M = prior / double(request_.poses);
  for (const auto& [i, weight] : weights) {
    const auto block = blocks.block(std::size_t(i));
    M.noalias() += weight * block.transpose() * block;
  }
  Seen seen{-infinity, 0.0, std::vector<double>(blocks.count(), 0.0)};
  const auto expansion = function_.expand(M);
  if (expansion == nullptr) return seen;
  seen.value = expansion->value + interest_ * std::log(double(request_.poses));
  sensitivities(blocks, expansion->factor, 1, seen.sensitivity);
  if (prior.size() > 0)
    seen.of_prior = (expansion->factor.transpose() * prior * expansion->factor).trace() / double(request_.poses);
  return seen;
}

void ScenarioFigures::put(const Seen& seen, ByteWriter& out) {
  out.put(seen.value);
  out.put(seen.of_prior);
  out.put(seen.sensitivity);
}

void ScenarioFigures::take(ByteReader& in, double reference, Look& look) const {
  look.values.push_back((in.get<double>() - reference) / interest_);
  look.of_prior.push_back(in.get<double>());
  look.sensitivity.emplace_back();
  in.get(look.sensitivity.back());
}

void ScenarioFigures::accept(Look look) {
  look_ = std::move(look);
  bound_ = std::min(bound_, bound_here());
}

bool ScenarioFigures::look_from(const CandidateWeights& weights) {
  Look all;
  run_tasks(
      {"bound over drawn robots", weights_.size(), request_.planner.threads},
      [&](std::size_t k, int) {
        BlockArray blocks = request_.blocks(int(k), {});
        whiten(blocks);
        ByteWriter out;
        put(look(blocks, prior_of(int(k)), weights), out);
        return out.take();
      },
      [&](std::size_t k, std::string_view bytes) {
        ByteReader in(bytes);
        take(in, references_[k], all);
      },
      monitor_);
  if (all.values.size() < weights_.size()) return false;
  accept(std::move(all));
  return true;
}

std::vector<double> ScenarioFigures::mean_sensitivity(const std::vector<double>& lambda) const {
  std::vector<double> mean(nominal_.count(), 0.0);
  for (std::size_t k = 0; k < look_.sensitivity.size(); ++k)
    if (lambda[k] > 0)
      for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += lambda[k] * look_.sensitivity[k][i];
  return mean;
}

double ScenarioFigures::bound_by(const std::vector<double>& lambda) const {
  double value = 0.0, of_prior = 0.0;
  for (std::size_t k = 0; k < lambda.size(); ++k) {
    if (!(lambda[k] > 0)) continue;
    value += lambda[k] * look_.values[k];
    of_prior += lambda[k] * look_.of_prior[k];
  }
  if (!std::isfinite(value)) return 0.0;
  return value + std::log((best_mean(mean_sensitivity(lambda), options_.cap) + of_prior) / interest_);
}

double ScenarioFigures::bound_here() const {
  double least =
      std::min(0.0, bound_by(supporting_weights(request_.aim, look_.values, weights_, double(weights_.size()))));
  const double lowest = *std::min_element(look_.values.begin(), look_.values.end());
  if (request_.aim.measure != RobustAim::Measure::worst || !std::isfinite(lowest)) return std::exp(least);
  // Any weights are valid; those of a soft minimum spread over all scenarios that are nearly worst.
  for (const double sharpness : {10.0, 30.0, 100.0, 300.0, 1000.0}) {
    std::vector<double> lambda;
    for (const double value : look_.values) lambda.push_back(std::exp(-sharpness * (value - lowest)));
    const double sum = std::accumulate(lambda.begin(), lambda.end(), 0.0);
    for (double& weight : lambda) weight /= sum;
    least = std::min(least, bound_by(lambda));
  }
  return std::exp(least);
}

double ScenarioFigures::combine(const std::vector<double>& values) const {
  return combined(request_.aim, values, weights_, double(weights_.size()));
}

RobustFigures ScenarioFigures::figures(const std::vector<double>& values) const {
  RobustFigures result;
  for (const double value : values) result.efficiency.push_back(std::min(1.0, std::exp(value)));
  result.combined = std::min(1.0, std::exp(combine(values)));
  return result;
}

}  // namespace posewright
