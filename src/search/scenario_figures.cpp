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

/// Support of a scenario's weights near the nominal one, ascending: few, because a step costs the cube of their number.
std::vector<int> first_set(const ApproximateDesign& optimum, std::size_t least) {
  std::vector<int> set = optimum.weighted();
  const std::size_t wanted = std::max(least, 2 * set.size());
  std::vector<char> taken(optimum.sensitivity.size(), 0);
  for (const int i : set) taken[std::size_t(i)] = 1;
  for (const int i : by_value(optimum.sensitivity, true)) {
    if (set.size() >= wanted) break;
    if (taken[std::size_t(i)] == 0) set.push_back(i);
  }
  std::sort(set.begin(), set.end());
  return set;
}

}  // namespace

std::vector<int> by_value(const std::vector<double>& values, bool largest_first) {
  std::vector<int> order(values.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    const double x = values[std::size_t(a)], y = values[std::size_t(b)];
    return largest_first ? x > y : x < y;
  });
  return order;
}

ScenarioFigures::ScenarioFigures(const RobustRequest& request, const Monitor& monitor)
    : request_(request),
      monitor_(monitor),
      columns_(request.nominal.columns()),
      interest_(columns_ - request.nuisance),
      function_(request.nuisance, columns_) {
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

double ScenarioFigures::log_det_of(const BlockArray& blocks, const Eigen::MatrixXd& prior,
                                   const std::vector<int>& members) const {
  return function_.value(summed_information(blocks, prior.size() > 0 ? &prior : nullptr, members));
}

std::string ScenarioFigures::reference_of(int scenario) const {
  BlockArray blocks = request_.blocks(scenario, {});
  whiten(blocks);
  const Eigen::MatrixXd prior = prior_of(scenario);
  ApproximateDesignOptions options = options_;
  if (prior.size() > 0) options.prior = prior / double(request_.poses);
  const Seen seen = evaluate(blocks, prior, optimal_weights());
  // Where the nominal weights are as good as that, what they prove is enough.
  const double ratio = (best_mean(seen.sensitivity, options_.cap) + seen.of_prior) / interest_;
  const bool enough = std::isfinite(seen.log_det) && ratio < 1 + reference_tolerance;
  ByteWriter out;
  out.put(enough ? seen.log_det + interest_ * std::log(std::max(1.0, ratio) * (1 + rounding))
                 : solve_approximate_design(blocks, function_, options, Monitor()).bound_for(request_.poses));
  out.put(log_det_of(blocks, prior, request_.plan));
  std::int64_t unreached = 0;
  for (std::size_t i = 0; i < blocks.count(); ++i) unreached += blocks.block(i).isZero(0.0) ? 1 : 0;
  out.put(unreached);
  write(seen, out);
  return out.take();
}

bool ScenarioFigures::find_references(long& unreached) {
  std::vector<double> references, given;
  AtWeights all;
  const bool stopped = run_tasks(
      {"drawn robots", scenarios(), request_.planner.threads}, [&](std::size_t k, int) { return reference_of(int(k)); },
      [&](std::size_t, std::string_view bytes) {
        ByteReader in(bytes);
        references.push_back(in.get<double>());
        given.push_back((in.get<double>() - references.back()) / interest_);
        unreached += long(in.get<std::int64_t>());
        read(in, all);
      },
      monitor_);
  if (references.size() < scenarios()) return false;
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

ScenarioFigures::Seen ScenarioFigures::evaluate(const BlockArray& blocks, const Eigen::MatrixXd& prior,
                                                const CandidateWeights& weights) const {
  const Eigen::MatrixXd own = prior / double(request_.poses);
  Seen seen{-infinity, 0.0, std::vector<double>(blocks.count(), 0.0)};
  const auto expansion = function_.expand(weighted_information(blocks, own, weights));
  if (expansion == nullptr) return seen;
  seen.log_det = expansion->value + interest_ * std::log(double(request_.poses));
  sensitivities(blocks, expansion->factor, 1, seen.sensitivity);
  if (own.size() > 0) seen.of_prior = (expansion->factor.transpose() * own * expansion->factor).trace();
  return seen;
}

void ScenarioFigures::write(const Seen& seen, ByteWriter& out) {
  out.put(seen.log_det);
  out.put(seen.of_prior);
  out.put(seen.sensitivity);
}

void ScenarioFigures::read(ByteReader& in, AtWeights& bounds) {
  bounds.log_dets.push_back(in.get<double>());
  bounds.of_prior.push_back(in.get<double>());
  bounds.sensitivity.emplace_back();
  in.get(bounds.sensitivity.back());
}

void ScenarioFigures::accept(AtWeights bounds) {
  at_weights_ = std::move(bounds);
  for (std::size_t k = 0; k < at_weights_.log_dets.size(); ++k)
    at_weights_.values.push_back(efficiency(at_weights_.log_dets[k], k));
  bound_ = std::min(bound_, bound_here());
}

bool ScenarioFigures::evaluate_at(const CandidateWeights& weights) {
  AtWeights all;
  run_tasks(
      {"bound over drawn robots", scenarios(), request_.planner.threads},
      [&](std::size_t k, int) {
        BlockArray blocks = request_.blocks(int(k), {});
        whiten(blocks);
        ByteWriter out;
        write(evaluate(blocks, prior_of(int(k)), weights), out);
        return out.take();
      },
      [&](std::size_t, std::string_view bytes) {
        ByteReader in(bytes);
        read(in, all);
      },
      monitor_);
  if (all.log_dets.size() < scenarios()) return false;
  accept(std::move(all));
  return true;
}

std::vector<double> ScenarioFigures::mean_sensitivity(const std::vector<double>& lambda) const {
  std::vector<double> mean(nominal_.count(), 0.0);
  for (std::size_t k = 0; k < at_weights_.sensitivity.size(); ++k)
    if (lambda[k] > 0)
      for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += lambda[k] * at_weights_.sensitivity[k][i];
  return mean;
}

double ScenarioFigures::bound_by(const std::vector<double>& lambda) const {
  double value = 0.0, of_prior = 0.0;
  for (std::size_t k = 0; k < lambda.size(); ++k) {
    if (!(lambda[k] > 0)) continue;
    value += lambda[k] * at_weights_.values[k];
    of_prior += lambda[k] * at_weights_.of_prior[k];
  }
  if (!std::isfinite(value)) return 0.0;
  return value + std::log((best_mean(mean_sensitivity(lambda), options_.cap) + of_prior) / interest_);
}

double ScenarioFigures::bound_here() const {
  double least = std::min(0.0, bound_by(combination(scenarios()).supporting(at_weights_.values)));
  if (request_.aim.measure != RobustAim::Measure::worst) return std::exp(least);
  if (!std::all_of(at_weights_.values.begin(), at_weights_.values.end(),
                   [](double value) { return std::isfinite(value); }))
    return std::exp(least);
  // Any weights are valid; those of a soft minimum spread over all scenarios that are nearly worst.
  for (const double sharpness : {10.0, 30.0, 100.0, 300.0, 1000.0})
    least = std::min(least, bound_by(soft_minimum_weights(at_weights_.values, sharpness)));
  return std::exp(least);
}

RobustFigures ScenarioFigures::figures(const std::vector<double>& values) const {
  RobustFigures result;
  for (const double value : values) result.efficiency.push_back(std::min(1.0, std::exp(value)));
  result.combined = std::min(1.0, std::exp(combine(values)));
  return result;
}

}  // namespace posewright
