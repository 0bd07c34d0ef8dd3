#include "measure_inclination.hpp"

#include <algorithm>
#include <cmath>

#include "posewright/model/placement.hpp"

namespace posewright {

InclinationModel::InclinationModel(const MeasurementSpec& spec)
    : spec_(std::get<InclinationMeasurement>(spec.instrument)),
      R_TipSensor_(isometry({Eigen::Vector3d::Zero(), spec_.rpy}).linear()),
      repeats_(spec.repeats) {
  rows_ = int(spec_.axes.size());
  unseen_reason_ = "the inclination is out of range";
  for (const int axis : spec_.axes) readings_.push_back({std::string("inclination.") + "xyz"[axis], "rad"});
}

Eigen::Vector3d InclinationModel::axis(const Sighting& sighting, Eigen::Index row) const {
  return sighting.X_MeasureTip.linear() * R_TipSensor_.col(spec_.axes[std::size_t(row)]);
}

void InclinationModel::read(const Sighting& sighting, Eigen::Ref<Eigen::VectorXd> y) const {
  for (Eigen::Index row = 0; row < rows_; ++row)
    y[row] = std::asin(std::clamp(axis(sighting, row).dot(spec_.up), -1.0, 1.0));
}

/// A turn ω takes s to ω × s, so sᵀu changes by ωᵀ(s × u).
void InclinationModel::rows_of_twists(const Sighting& sighting, const Eigen::Ref<const Twists>& twists,
                                      Eigen::Ref<Eigen::MatrixXd> rows) const {
  for (Eigen::Index row = 0; row < rows_; ++row)
    rows.row(row) = axis(sighting, row).cross(spec_.up).normalized().transpose() * twists.bottomRows<3>();
}

void InclinationModel::covariance(const Sighting&, Eigen::Ref<Eigen::MatrixXd> covariance) const {
  covariance = spec_.sigma * spec_.sigma / repeats_ * Eigen::MatrixXd::Identity(rows_, rows_);
}

/// The row is h = s × u of length 1, whose change is across h.
Twist InclinationModel::pull_back(const Sighting& sighting, const Adjoint& f) const {
  Twist sum = Twist::Zero();
  for (Eigen::Index row = 0; row < rows_; ++row) {
    const Eigen::Vector3d s = axis(sighting, row), h = s.cross(spec_.up);
    const Eigen::Vector3d unit = h.normalized(), by_row = f.twist_rows.row(row).tail<3>().transpose();
    const Eigen::Vector3d by_h = (by_row - unit.dot(by_row) * unit) / h.norm();
    sum.tail<3>() += s.cross(Eigen::Vector3d(spec_.up.cross(by_h)));
  }
  return sum;
}

bool InclinationModel::sees(const Sighting& sighting) const {
  for (Eigen::Index row = 0; row < rows_; ++row)
    if (std::abs(axis(sighting, row).dot(spec_.up)) > std::sin(spec_.range)) return false;
  return true;
}

void InclinationModel::margins_at(const Sighting& sighting, std::span<double> out) const {
  for (Eigen::Index row = 0; row < rows_; ++row) {
    const double share = axis(sighting, row).dot(spec_.up) / std::sin(spec_.range);
    out[std::size_t(2 * row)] = 1.0 + share;
    out[std::size_t(2 * row) + 1] = 1.0 - share;
  }
}

}  // namespace posewright
