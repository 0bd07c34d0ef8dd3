#include "posewright/model/implicit_model.hpp"

#include <utility>

#include "posewright/support/error.hpp"

namespace posewright {
namespace {

// Smallest pivot of the scaled normal matrix of the pose fit that still counts as six independent degrees of freedom.
constexpr double fit_pivot = 1e-6;

/// Σ_X in spatial-twist coordinates at the platform pose.
Eigen::Matrix<double, 6, 6> pose_covariance(const MeasurementModel& measurement, const Eigen::Isometry3d& X) {
  const Eigen::Index rows = measurement.rows();
  Eigen::MatrixXd y(rows, 6), noise(rows, rows);
  // Unit twists about the platform origin: about the origin of M the rotations would be ill-scaled far away.
  Twists local = Twists::Identity(6, 6);
  for (int k = 0; k < 3; ++k) local.block<3, 1>(0, 3 + k) = X.translation().cross(Eigen::Vector3d::Unit(k));
  measurement.rows_of_twists(X, {}, local, y);
  measurement.covariance(X, {}, noise);
  const Eigen::LLT<Eigen::MatrixXd> factor(noise);
  if (factor.info() != Eigen::Success) throw CannotDo("measurement: the noise covariance is not positive definite");
  factor.matrixL().solveInPlace(y);
  const Eigen::Matrix<double, 6, 1> scale = y.colwise().norm().transpose();
  if (!(scale.minCoeff() > 0)) throw CannotDo("measurement: the readings do not fix the pose of the platform");
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(y * scale.cwiseInverse().asDiagonal());
  const Eigen::Matrix<double, 6, 6> r = qr.matrixQR().topRows(6).triangularView<Eigen::Upper>();
  if (!(r.diagonal().cwiseAbs().minCoeff() > fit_pivot))
    throw CannotDo(
        "measurement: the readings do not fix the pose of the platform; three targets not in line are needed");
  const Eigen::Matrix<double, 6, 6> half =
      local * scale.cwiseInverse().asDiagonal() *
      r.triangularView<Eigen::Upper>().solve(Eigen::Matrix<double, 6, 6>(Eigen::Matrix<double, 6, 6>::Identity()));
  return half * half.transpose();
}

}  // namespace

ImplicitModel::ImplicitModel(std::unique_ptr<MeasurementModel> measurement, double actuator_noise)
    : measurement_(std::move(measurement)), actuator_noise_(actuator_noise) {
  if (measurement_->rows() < 6)
    throw CannotDo("measurement: " + std::to_string(measurement_->rows()) +
                   " readings do not fix the pose of the platform; at least 6 are needed");
}

bool ImplicitModel::do_linearise(std::span<const double> q, std::span<const double> correction,
                                 std::span<const int> selected, Linearisation& out) const {
  const Eigen::Index r = rows(), actuated = Eigen::Index(actuators().size());
  out.rows.resize(r, 6 + actuated);
  out.G.resize(r, Eigen::Index(selected.size()));
  if (!do_rows(q, correction, selected, out.G, out.rows.leftCols(6), out.rows.rightCols(actuated))) return false;
  const auto g_pose = out.rows.leftCols(6);
  const auto g_actuators = out.rows.rightCols(actuated);
  out.covariance = g_pose * pose_covariance(*measurement_, tool_pose(q)) * g_pose.transpose();
  out.covariance += actuator_noise_ * actuator_noise_ * g_actuators * g_actuators.transpose();
  return true;
}

}  // namespace posewright
