#pragma once

#include <Eigen/Dense>
#include <span>
#include <vector>

#include "posewright/model/tip_model.hpp"

namespace posewright {

/// What an instrument sees of a tip frame: rows of measured values, their noise, and parameters of its own (targets).
class MeasurementModel {
 public:
  virtual ~MeasurementModel() = default;

  const std::vector<Parameter>& parameters() const { return parameters_; }
  int rows() const { return rows_; }

  /// Measured values' derivative along each tip twist: rows × twists.cols().
  /// @param X_MeasureTip  pose of the tip in the measurement frame
  /// @param correction    of the instrument's own parameters, or empty for zero
  virtual void rows_of_twists(const Eigen::Isometry3d& X_MeasureTip, std::span<const double> correction,
                              const Eigen::Ref<const Twists>& twists, Eigen::Ref<Eigen::MatrixXd> rows) const = 0;

  /// Column (size rows) of the instrument's own parameter `index`.
  virtual void own_column(const Eigen::Isometry3d& X_MeasureTip, std::span<const double> correction, int index,
                          Eigen::Ref<Eigen::VectorXd> column) const = 0;

  /// Covariance of the rows (rows × rows): reading noise over repeats, plus what stays at a pose.
  virtual void covariance(const Eigen::Isometry3d& X_MeasureTip, std::span<const double> correction,
                          Eigen::Ref<Eigen::MatrixXd> covariance) const = 0;

 protected:
  std::vector<Parameter> parameters_;
  int rows_ = 0;
};

}  // namespace posewright
