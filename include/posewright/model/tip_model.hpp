#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "posewright/model/identification_model.hpp"

namespace posewright {

using Twists = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// A robot whose joints carry one tip frame: where the tip is and how each parameter moves it.
///
/// Twists are spatial and in the measurement frame M: rows 0–2 the velocity of the tip-fixed point that
/// passes the origin of M, rows 3–5 the angular velocity; a tip-fixed point at p moves with v + ω × p.
class TipModel {
 public:
  virtual ~TipModel() = default;

  const std::vector<Parameter>& parameters() const { return parameters_; }
  const std::vector<Coordinate>& coordinates() const { return coordinates_; }
  const std::vector<IdentificationModel::Preference>& geometric_parameters() const { return geometric_; }
  /// 1σ of each coordinate's reading (rad or m), size coordinates().
  const std::vector<double>& encoder_noise() const { return encoder_noise_; }

  /// Pose of the tip in M, at configuration q and corrections (all parameters, or empty for zero).
  /// Fills twists (6 × selected) and, unless null, joint_twists (6 × coordinates); both are resized if needed.
  virtual Eigen::Isometry3d linearise(std::span<const double> q, std::span<const double> correction,
                                      std::span<const int> selected, Twists& twists, Twists* joint_twists) const = 0;

 protected:
  std::vector<Parameter> parameters_;
  std::vector<Coordinate> coordinates_;
  std::vector<IdentificationModel::Preference> geometric_;
  std::vector<double> encoder_noise_;
};

}  // namespace posewright
