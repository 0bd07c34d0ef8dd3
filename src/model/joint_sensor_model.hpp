#pragma once

#include <memory>

#include "posewright/model/identification_model.hpp"
#include "posewright/model/tip_model.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

/// Self-calibration: a closed chain's redundant joint sensors against what its other joints say. No instrument, so
/// base.* and tool.* have no effect and are left out of what `auto` chooses from.
class JointSensorModel : public IdentificationModel {
 public:
  /// Throws CannotDo for a robot without redundant sensors, InputError for a sensor that it has not.
  JointSensorModel(std::unique_ptr<TipModel> tip, const MeasurementSpec& measurement, const ProblemFile& file);

 private:
  void do_take_loads_at(std::span<const double> correction) override;
  bool do_linearise(const Point& at, std::span<const int> selected, Linearisation& out) const override;
  bool do_read(const Point& at, Eigen::VectorXd& y) const override;
  void do_difference(const Eigen::VectorXd& measured, const Eigen::VectorXd& predicted,
                     Eigen::VectorXd& out) const override;
  bool do_configuration_at(std::span<const double> actuators, const Point& start, std::span<double> q) const override;
  bool do_measurable(const Point& at) const override;
  std::optional<int> do_measurable_margins() const override { return 0; }
  bool do_actuator_values(const Point& at, std::span<double> values) const override;
  Eigen::Isometry3d do_tool_pose(const Point& at) const override;

  std::unique_ptr<TipModel> tip_;
  std::vector<int> sensors_;  // which of the robot's, in the order of the rows
  double variance_;
};

}  // namespace posewright
