#include "posewright/model/measurement_model.hpp"

#include <stdexcept>

#include "posewright/model/whitening.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

// Smallest pivot of the scaled normal matrix of the pose fit that still counts as six independent degrees of freedom.
constexpr double fit_pivot = 1e-6;

}  // namespace

bool MeasurementModel::motion(const Sighting&, int, Twist*) const { return false; }

void MeasurementModel::own_column(const Sighting&, int, Eigen::Ref<Eigen::VectorXd>) const {
  throw std::logic_error("this instrument has no such parameter");
}

void MeasurementModel::difference(const Eigen::VectorXd& measured, const Eigen::VectorXd& predicted,
                                  Eigen::VectorXd& out) const {
  out = measured - predicted;
}

void MeasurementModel::shifted(const Eigen::VectorXd& predicted, const Eigen::VectorXd& change,
                               Eigen::VectorXd& out) const {
  out = predicted + change;
}

bool MeasurementModel::sees(const Sighting&) const { return true; }

Eigen::Matrix<double, 6, 6> fitted_pose_covariance(const MeasurementModel& measurement, const Eigen::Isometry3d& X) {
  const Eigen::Index rows = measurement.rows();
  Eigen::MatrixXd y(rows, 6), noise(rows, rows);
  // About the tip's origin: about the origin of M the rotations would be ill-scaled far away.
  Twists about_tip = Twists::Identity(6, 6);
  for (int k = 0; k < 3; ++k) about_tip.block<3, 1>(0, 3 + k) = X.translation().cross(Eigen::Vector3d::Unit(k));
  const MeasurementModel::Sighting sighting{X, {}, 0};
  measurement.rows_of_twists(sighting, about_tip, y);
  measurement.covariance(sighting, noise);
  Eigen::LLT<Eigen::MatrixXd> factor;
  factorise_covariance(noise, factor);
  factor.matrixL().solveInPlace(y);
  const Twist scale = y.colwise().norm().transpose();
  const char* const message =
      "measurement: the readings do not fix the pose; three points that are not in line are needed";
  if (rows < 6 || !(scale.minCoeff() > 0)) throw CannotDo(message);
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(y * scale.cwiseInverse().asDiagonal());
  const Eigen::Matrix<double, 6, 6> r = qr.matrixQR().topRows(6).triangularView<Eigen::Upper>();
  if (!(r.diagonal().cwiseAbs().minCoeff() > fit_pivot)) throw CannotDo(message);
  const Eigen::Matrix<double, 6, 6> half =
      scale.cwiseInverse().asDiagonal() *
      r.triangularView<Eigen::Upper>().solve(Eigen::Matrix<double, 6, 6>(Eigen::Matrix<double, 6, 6>::Identity()));
  return half * half.transpose();
}

}  // namespace posewright
