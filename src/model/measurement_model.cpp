#include "posewright/model/measurement_model.hpp"

#include <Eigen/Geometry>
#include <stdexcept>
#include <vector>

#include "posewright/model/whitening.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

// Smallest pivot of the scaled normal matrix of the pose fit that still counts as six independent degrees of freedom.
constexpr double fit_pivot = 1e-6;

// Of the central differences in the tip's pose, m or rad: their error is about its square.
constexpr double pose_step = 1e-5;

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

Twist MeasurementModel::pull_back(const Sighting& sighting, const Adjoint& f) const {
  static thread_local Eigen::MatrixXd rows, noise;
  static thread_local Eigen::VectorXd column;
  rows.resize(rows_, 6);
  noise.resize(rows_, rows_);
  column.resize(rows_);
  const Eigen::Isometry3d& X = sighting.X_MeasureTip;
  Eigen::Isometry3d near;
  const auto value = [&] {
    const Sighting there{near, sighting.correction, sighting.station};
    rows_of_twists(there, Twists::Identity(6, 6), rows);
    covariance(there, noise);
    double sum = f.twist_rows.cwiseProduct(rows).sum() + f.covariance.cwiseProduct(noise).sum();
    for (std::size_t i = 0; i < f.own.size(); ++i) {
      if (Twist twist; motion(there, f.own[i], &twist)) {
        sum += f.own_motions.col(Eigen::Index(i)).dot(twist);
        continue;
      }
      own_column(there, f.own[i], column);
      sum += f.own_columns.col(Eigen::Index(i)).dot(column);
    }
    return sum;
  };
  Eigen::Vector3d shift, turn;
  for (int k = 0; k < 3; ++k) {
    double ends[2], turned[2];
    for (const int side : {0, 1}) {
      const double step = side == 0 ? -pose_step : pose_step;
      near = X;
      near.translation()[k] += step;
      ends[side] = value();
      near = X;
      near.linear() = Eigen::AngleAxisd(step, Eigen::Vector3d::Unit(k)) * X.linear();
      turned[side] = value();
    }
    shift[k] = (ends[1] - ends[0]) / (2 * pose_step);
    turn[k] = (turned[1] - turned[0]) / (2 * pose_step);
  }
  return change_by_motion(X.translation(), shift, turn);
}

bool MeasurementModel::sees(const Sighting&) const { return true; }

std::optional<int> MeasurementModel::margins() const {
  return unseen_reason_.empty() ? std::optional(0) : std::nullopt;
}

void MeasurementModel::margins_at(const Sighting&, std::span<double>) const {}

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
