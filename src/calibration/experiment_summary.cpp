#include "posewright/calibration/experiment_summary.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "posewright/calibration/residual_statistics.hpp"
#include "posewright/support/distributions.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

using End = VirtualCalibration::End;
using Draws = std::vector<const VirtualCalibration*>;

// The χ² test rejects a right model in the rest of the draws.
constexpr double accepted = 0.95;

double binomial_error(double share, std::size_t count) { return std::sqrt(share * (1 - share) / double(count)); }

ParameterErrors errors_of(const Draws& draws, Eigen::Index j) {
  ParameterErrors result;
  const auto count = double(draws.size());
  double squares = 0, inside = 0, profiled = 0;
  std::vector<double> in_sigma;
  for (const auto* draw : draws) {
    in_sigma.push_back(draw->sigma[j] > 0 ? draw->error[j] / draw->sigma[j] : 0.0);
    result.bias += draw->error[j] / count;
    result.stated += draw->sigma[j] * draw->sigma[j] / count;
    inside += std::abs(draw->error[j]) <= draw->interval * draw->sigma[j] ? 1 : 0;
    if (draw->tau.size() > 0) profiled += std::abs(draw->tau[j]) <= draw->interval ? 1 : 0;
  }
  for (const auto* draw : draws) squares += std::pow(draw->error[j] - result.bias, 2);
  result.observed = std::sqrt(squares / (count - 1));
  result.stated = std::sqrt(result.stated);
  result.bias_error = result.observed / std::sqrt(count);
  result.coverage = inside / count;
  if (draws.front()->tau.size() > 0) result.profiled = profiled / count;
  result.histogram = half_sigma_histogram(in_sigma);
  return result;
}

void add_chi_square(const Draws& draws, bool tested, ExperimentSummary& summary) {
  std::map<int, double> limits;  // by freedom: missing targets change it
  double rejected = 0, freedom = 0;
  for (const auto* draw : draws) {
    if (draw->freedom < 1) return;
    double& limit = limits[draw->freedom];
    if (limit == 0) limit = chi_square_quantile(accepted, draw->freedom);
    rejected += draw->chi_square > limit ? 1 : 0;
    summary.chi_square += draw->chi_square / draw->freedom / double(draws.size());
    freedom += draw->freedom;
  }
  summary.chi_square_error = std::sqrt(2 / freedom);
  if (!tested) return;
  summary.rejected = rejected / double(draws.size());
  summary.rejected_error = binomial_error(*summary.rejected, draws.size());
}

void add_lost(const std::vector<VirtualCalibration>& all, std::size_t poses, ExperimentSummary& summary) {
  summary.lost.assign(poses, 0.0);
  double draws = 0;
  for (const VirtualCalibration& draw : all) {
    if (draw.lost.empty()) continue;
    ++draws;
    for (std::size_t k = 0; k < poses; ++k) summary.lost[k] += draw.lost[k];
  }
  for (double& share : summary.lost) {
    share /= std::max(1.0, draws);
    summary.lost_poses += share;
  }
}

}  // namespace

ExperimentSummary summarise(const VirtualExperiment& experiment, const std::vector<VirtualCalibration>& all) {
  ExperimentSummary summary;
  summary.asked = int(all.size());
  add_lost(all, experiment.poses.size(), summary);
  Draws draws;
  for (const VirtualCalibration& draw : all) {
    if (draw.end == End::fitted) draws.push_back(&draw);
    summary.not_converged += draw.end == End::not_converged ? 1 : 0;
    if (draw.end == End::failed && summary.failed++ == 0) summary.first_failure = draw.why;
  }
  summary.fitted = int(draws.size());
  if (draws.size() < 2)
    throw CannotDo(summary.failed > 0 ? "fewer than two draws could be calibrated: " + summary.first_failure
                                      : "fewer than two draws were calibrated");
  summary.sigma_error = 1 / std::sqrt(2.0 * double(draws.size()));
  summary.coverage_error = binomial_error(interval_probability, draws.size());
  for (Eigen::Index j = 0; j < draws.front()->error.size(); ++j) summary.parameters.push_back(errors_of(draws, j));
  add_chi_square(draws, experiment.options.fit.weighting != Weighting::robust, summary);
  if (!experiment.places) return summary;
  summary.mean_square = 0.0;
  for (const auto* draw : draws) {
    *summary.mean_square += draw->mean_square / double(draws.size());
    summary.largest = std::max(summary.largest, draw->largest);
    summary.distances.push_back(std::sqrt(draw->mean_square));
  }
  std::sort(summary.distances.begin(), summary.distances.end());
  return summary;
}

}  // namespace posewright
