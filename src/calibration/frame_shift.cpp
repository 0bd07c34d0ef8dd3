#include "posewright/calibration/frame_shift.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "posewright/calibration/placing_columns.hpp"
#include "posewright/model/campaigns.hpp"
#include "posewright/model/placement.hpp"
#include "posewright/support/error.hpp"
#include "stacked_readings.hpp"

namespace posewright {
namespace {

/// The base's columns; fewer than six if the model has none.
VariantColumns base_columns(const IdentificationModel& model) {
  VariantColumns columns;
  columns.selected = base_parameters(model);
  for (const int i : columns.selected) {
    columns.parameters.push_back(model.parameters()[std::size_t(i)]);
    columns.parameters.back().places = true;
    columns.tiers.push_back(0);
  }
  return columns;
}

/// Throws CannotDo if a pose is out of reach.
double root_mean_square(const IdentificationModel& model, const VariantColumns& base,
                        const std::vector<MeasuredPose>& poses, const std::vector<double>& correction) {
  StackedReadings stacked(model, base, poses, Prior::none, correction);
  const Eigen::VectorXd x = stacked.start();
  stacked.weigh(x, Weighting::weighted);
  Eigen::VectorXd residuals(stacked.rows());
  stacked.residual(x, residuals);
  return std::sqrt(residuals.squaredNorm() / double(stacked.readings()));
}

/// Rotation of the base's displacement.
Eigen::Matrix3d rotation_of(const std::vector<double>& correction, const std::vector<int>& base) {
  const auto angle = [&](std::size_t k) { return correction[std::size_t(base[3 + k])]; };
  return rotation_of_rpy({angle(0), angle(1), angle(2)});
}

}  // namespace

std::optional<FrameShift> frame_shift(const IdentificationModel& model, const std::vector<MeasuredPose>& poses,
                                      const std::vector<double>& correction) {
  const VariantColumns base = base_columns(model);
  if (base.selected.size() < 6 || poses.size() < 3) return std::nullopt;
  FrameShift shift;
  std::vector<double> best = correction;
  try {
    shift.before = shift.after = root_mean_square(model, base, poses, correction);
    // From where the fit left it, and from the side that the nominal robot says.
    std::vector<double> aside = correction;
    const std::vector<double> rough = placed(model, base, poses, {});
    for (const int i : base.selected) aside[std::size_t(i)] = rough[std::size_t(i)];
    for (const std::vector<double>& start : {correction, aside}) {
      FitOptions options;
      options.start = start;
      const std::vector<double> found = fit(model, base, poses, options).correction;
      const double rms = root_mean_square(model, base, poses, found);
      if (!(rms < shift.after)) continue;
      shift.after = rms;
      best = found;
    }
  } catch (const CannotDo&) {
    return std::nullopt;  // these poses do not tell where the base is
  }
  Eigen::Vector3d moved;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto i = std::size_t(base.selected[k]);
    moved[Eigen::Index(k)] = best[i] - correction[i];
  }
  shift.moved = moved.norm();
  shift.turned =
      Eigen::AngleAxisd(rotation_of(best, base.selected) * rotation_of(correction, base.selected).transpose()).angle();
  return shift;
}

}  // namespace posewright
