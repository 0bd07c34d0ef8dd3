#include "posewright/calibration/interpolation.hpp"

#include <cmath>

#include "posewright/calibration/residual_statistics.hpp"
#include "posewright/support/dense.hpp"
#include "stacked_readings.hpp"

namespace posewright {
namespace {

/// Whitened residuals and columns at the estimate.
struct AtEstimate {
  FittedRows rows;  // J and r of the estimated columns
  EffectFeatures features;
  Eigen::MatrixXd Z;   // Σ⁻¹ = I − Z Zᵀ
  Eigen::MatrixXd W;   // P = Σ⁻¹ − W Wᵀ
  Eigen::MatrixXd JR;  // J R⁻¹ with JᵀΣ⁻¹J (and tolerances) = RᵀR
  Eigen::VectorXd u;   // û
  Eigen::VectorXd Pr;
};

AtEstimate at_estimate(const IdentificationModel& model, const VariantColumns& columns,
                       const std::vector<MeasuredPose>& poses, const Fit& fit,
                       const std::shared_ptr<const UnmodelledEffect>& effect) {
  std::vector<int> selected = columns.selected;
  selected.insert(selected.end(), effect->columns().begin(), effect->columns().end());
  FittedRows rows = fitted_rows(model, selected, poses, fit.correction, fit);
  const Eigen::MatrixXd places = places_of(*effect, poses);
  const EffectFeatures features(effect, places, features_of_a_fit);
  Eigen::MatrixXd along = rows.J.rightCols(Eigen::Index(effect->columns().size()));
  effect->take_sizes(along);
  const Eigen::MatrixXd F = EffectRows(features.at(places), std::move(along), rows.first).dense();
  rows.J.conservativeResize(Eigen::NoChange, Eigen::Index(columns.selected.size()));

  AtEstimate at{std::move(rows), features, {}, {}, {}, {}, {}};
  const Eigen::LLT<Eigen::MatrixXd> inner(
      Eigen::MatrixXd(Eigen::MatrixXd::Identity(F.cols(), F.cols()) + F.transpose() * F));
  at.Z = inner.matrixL().solve(F.transpose()).transpose();
  // The covariance of a fit is that of its noise; here both are in units of it.
  const double unit = fit.noise_factor * (fit.scale_known ? 1.0 : fit.scale);
  const Eigen::LLT<Eigen::MatrixXd> root(Eigen::MatrixXd(fit.covariance / (unit * unit)));
  at.JR = at.rows.J * Eigen::MatrixXd(root.matrixL());
  at.W = at.JR - at.Z * (at.Z.transpose() * at.JR);
  // The gradient is zero at the estimate: P r = Σ⁻¹ r, whatever tolerances say beside the readings.
  at.Pr = at.rows.r - at.Z * (at.Z.transpose() * at.rows.r);
  at.u = inner.solve(F.transpose() * at.rows.r);
  return at;
}

/// Readings of a pose that judge, as rows of what was read.
std::vector<Eigen::Index> judging(const IdentificationModel& model, const std::vector<int>& read,
                                  const std::string& unit) {
  std::vector<Eigen::Index> rows;
  for (std::size_t i = 0; i < read.size(); ++i)
    if (model.readings()[std::size_t(read[i])].unit == unit) rows.push_back(Eigen::Index(i));
  return rows;
}

std::string unit_of(const IdentificationModel& model) {
  for (const Reading& reading : model.readings())
    if (reading.unit == "m") return "m";
  return model.readings().front().unit;
}

/// Each pose as the others predict it.
void leave_each_out(const IdentificationModel& model, const std::vector<MeasuredPose>& poses, const Fit& fit,
                    const AtEstimate& at, Interpolation& result) {
  std::vector<double> gains;
  double alone = 0, interpolated = 0;
  int number = 0;
  Linearisation noise;
  Eigen::VectorXd y;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const std::vector<int> read = indices_read(poses[k].y);
    const std::vector<Eigen::Index> judged = judging(model, read, result.unit);
    if (judged.empty() || !linearise_at(model, poses[k], fit.correction, {}, noise, y)) continue;
    const Eigen::Index first = at.rows.first[k], count = at.rows.first[k + 1] - first;
    const auto Z = at.Z.middleRows(first, count), W = at.W.middleRows(first, count);
    const Eigen::MatrixXd P = Eigen::MatrixXd::Identity(count, count) - Z * Z.transpose() - W * W.transpose();
    const Eigen::LDLT<Eigen::MatrixXd> factor(P);
    // Readings that no other pose tells anything of have no prediction.
    if (!(factor.vectorD().minCoeff() > 1e-10)) continue;
    const Eigen::VectorXd missed = factor.solve(at.Pr.segment(first, count));
    const Eigen::VectorXd by_parameters =
        at.rows.r.segment(first, count) + at.JR.middleRows(first, count) * (W.transpose() * missed);
    const Eigen::LLT<Eigen::MatrixXd> root(Eigen::MatrixXd(noise.covariance(read, read)));
    const Eigen::VectorXd with = (root.matrixL() * missed)(judged), without = (root.matrixL() * by_parameters)(judged);
    alone += without.squaredNorm();
    interpolated += with.squaredNorm();
    number += int(judged.size());
    gains.push_back((without.squaredNorm() - with.squaredNorm()) / double(judged.size()));
  }
  if (gains.size() < 2) {
    result.why_not = "no pose can be predicted from the others";
    return;
  }
  result.alone = std::sqrt(alone / number);
  result.interpolated = std::sqrt(interpolated / number);
  result.gain = mean_in_standard_errors(gains);
}

}  // namespace

Interpolation interpolate(const IdentificationModel& model, const VariantColumns& columns,
                          const std::vector<MeasuredPose>& poses, const std::vector<MeasuredPose>& others,
                          const Fit& fit, const std::shared_ptr<const UnmodelledEffect>& effect) {
  Interpolation result;
  result.unit = unit_of(model);
  const AtEstimate at = at_estimate(model, columns, poses, fit, effect);
  leave_each_out(model, poses, fit, at, result);
  result.others = residuals_of(model, fit.correction, others);
  Linearisation there;
  Eigen::VectorXd y;
  for (std::size_t k = 0; k < others.size(); ++k) {
    if (!linearise_at(model, others[k], fit.correction, effect->columns(), there, y)) continue;
    Eigen::MatrixXd along = there.G;
    effect->take_sizes(along);
    Eigen::MatrixXd F = Eigen::MatrixXd::Zero(along.rows(), at.features.columns());
    add_feature_columns(at.features.at(effect->places(others[k].q)), along, F.middleRows(0, F.rows()));
    result.others[k] -= F * at.u;
  }
  return result;
}

}  // namespace posewright
