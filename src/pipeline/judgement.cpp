#include "judgement.hpp"

#include <algorithm>
#include <cmath>

#include "discrepancy.hpp"
#include "test_points.hpp"

namespace posewright {
namespace {

void add_effects(Judgement& judgement, const Preparation& prepared, const Configurations& poses,
                 const Settings& settings) {
  const Discrepancy& known = *prepared.discrepancy;
  const PreparedVariant& fitted = prepared.first();
  const EffectFit fit = fit_effects(known.effects, fitted, poses, settings);
  judgement.discrimination = discrimination_of(known.truth, known.effects, fit.unfitted, fitted, poses, settings.prior);
  if (known.test_points.empty()) {
    const Eigen::Index interest = fit.errors.rows() - fitted.columns().nuisance;
    judgement.squared_bias =
        (fitted.scale.tail(interest).cwiseInverse().asDiagonal() * fit.errors.bottomRows(interest)).squaredNorm();
    return;
  }
  double sum = 0, total = 0;
  for (const TestPoint& point : known.test_points) {
    sum += point.weight * errors_at(point, known.effects, fit).squaredNorm();
    total += point.weight;
  }
  judgement.squared_bias = sum / total;
}

}  // namespace

Judgement judge(const Preparation& prepared, const Configurations& poses, const Settings& settings) {
  Configurations all = prepared.measured;
  all.dimension = poses.dimension;
  all.values.insert(all.values.end(), poses.values.begin(), poses.values.end());
  Judgement judgement;
  for (const PreparedVariant& variant : prepared.variants)
    judgement.evaluations.push_back(
        evaluate(build_blocks(*variant.model, variant.columns().selected, all, settings.planner.threads),
                 variant.columns().parameters, settings.prior, variant.scale));
  const PreparedVariant& first = prepared.first();
  if (!first.test_points.empty())
    judgement.rho0 =
        predicted_error(first.test_points, judgement.evaluations.front().covariance, judgement.test_errors);
  if (prepared.discrepancy != nullptr) add_effects(judgement, prepared, all, settings);
  return judgement;
}

std::vector<double> log_efficiencies(const Judgement& judgement, const Preparation& prepared,
                                     const std::vector<double>& references) {
  std::vector<double> result;
  for (std::size_t v = 0; v < references.size(); ++v) {
    const VariantColumns& columns = prepared.variants[v].columns();
    const double interest = double(columns.selected.size()) - columns.nuisance;
    result.push_back((judgement.evaluations[v].log_det - references[v]) / interest);
  }
  return result;
}

namespace {

/// Both values of a criterion that is −(a variance).
CriterionValue of_variance(double variance) { return {-std::log(variance), -variance}; }

CriterionValue of_index(double index) { return {std::log(index), index}; }

}  // namespace

CriterionValue criterion_value(const std::string& criterion, const Evaluation& e, int nuisance,
                               const Eigen::VectorXd& scale) {
  const ObservabilityIndices& o = e.indices;
  if (criterion == "ds") return {e.log_det, e.log_det};
  if (criterion == "o2") return of_index(o.o2);
  if (criterion == "o3") return of_index(o.o3);
  if (criterion == "o4") return of_index(o.o4);
  if (criterion == "o5") return of_index(o.o5);
  if (criterion == "a") {
    Eigen::ArrayXd sigma = e.sigma;
    if (scale.size() > 0) sigma /= scale.array();
    return of_variance(sigma.tail(sigma.size() - nuisance).square().sum());
  }
  return {e.log_det, o.o1};
}

CriterionValue criterion_value(const std::string& criterion, const Judgement& judgement, const Preparation& prepared,
                               const std::vector<double>& references) {
  if (criterion == "test_pose") return of_variance(*judgement.rho0 * *judgement.rho0);
  if (criterion == "test_pose_max") {
    const double worst = *std::max_element(judgement.test_errors.begin(), judgement.test_errors.end());
    return of_variance(worst * worst);
  }
  if (criterion == "discriminate") {
    const double lambda = judgement.discrimination->noncentrality();
    return {std::log(lambda), lambda};
  }
  if (criterion == "bias") {
    const PreparedVariant& first = prepared.first();
    const double variance =
        judgement.rho0
            ? *judgement.rho0 * *judgement.rho0
            : -criterion_value("a", judgement.evaluations.front(), first.columns().nuisance, first.scale).shown;
    return of_variance(variance + judgement.squared_bias);
  }
  if (criterion == "compound" || criterion == "maximin") {
    const std::vector<double> efficiency = log_efficiencies(judgement, prepared, references);
    if (criterion == "maximin") {
      const double least = *std::min_element(efficiency.begin(), efficiency.end());
      return {least, std::exp(least)};
    }
    double sum = 0, total = 0;
    for (std::size_t v = 0; v < efficiency.size(); ++v) {
      sum += prepared.variants[v].weight * efficiency[v];
      total += prepared.variants[v].weight;
    }
    return {sum / total, sum / total};
  }
  return criterion_value(criterion, judgement.evaluations.front(), prepared.first().columns().nuisance,
                         prepared.first().scale);
}

}  // namespace posewright
