#pragma once

#include <memory>
#include <vector>

#include "posewright/model/identification_model.hpp"
#include "posewright/model/measurement_model.hpp"
#include "posewright/model/tip_model.hpp"

namespace posewright {

/// A robot that carries a tip, seen by an instrument: g = y − h(ρ, ξ). Parameters: the robot's, then the instrument's.
/// Targets replace the tool: where the instrument has parameters of its own, tool.* are left out.
/// Residual covariance: the instrument's, plus the joint readings' noise through ∂h/∂ρ.
class ExplicitModel : public IdentificationModel {
 public:
  ExplicitModel(std::unique_ptr<TipModel> tip, std::unique_ptr<MeasurementModel> measurement);

 private:
  bool do_linearise(std::span<const double> q, std::span<const double> correction, std::span<const int> selected,
                    Linearisation& out) const override;
  Eigen::Isometry3d do_tool_pose(std::span<const double> q) const override;

  std::unique_ptr<TipModel> tip_;
  std::unique_ptr<MeasurementModel> measurement_;
  int tip_parameters_ = 0;  ///< how many of the tip's parameters are in use (tool.* are its last)
  bool encoder_noise_ = false;
};

}  // namespace posewright
