#pragma once

#include <memory>

#include "posewright/model/identification_model.hpp"
#include "posewright/model/tip_model.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

/// Distance of a sphere on the tip between two configurations, e.g. by a ball bar's two ends or a cable
/// sensor read twice: d = ‖p(q') − p(q)‖ for each target. Configuration: q, then q' (coordinates NAME.second), then
/// what is chosen for both (the load case). Parameters: the robot's without tool.*, target.NAME.{x,y,z}. Where the base
/// stands has no effect.
class DistancePairModel : public IdentificationModel {
 public:
  DistancePairModel(std::unique_ptr<TipModel> tip, const MeasurementSpec& spec);

 private:
  void do_take_loads_at(std::span<const double> correction) override;
  bool do_linearise(const Point& at, std::span<const int> selected, Linearisation& out) const override;
  bool do_read(const Point& at, Eigen::VectorXd& y) const override;
  bool do_configuration_at(std::span<const double> actuators, const Point& start, std::span<double> q) const override;
  bool do_measurable(const Point& at) const override;
  std::optional<int> do_measurable_margins() const override;
  bool do_measurable_margins_at(const Point& at, std::span<double> out) const override;
  bool do_pull_back(const Point& at, std::span<const int> selected, const Eigen::MatrixXd& by_G,
                    const Eigen::MatrixXd& by_covariance, std::span<double> gradient) const override;
  bool do_actuator_values(const Point& at, std::span<double> values) const override;
  /// Offset of the second configuration.
  Eigen::Isometry3d do_tool_pose(const Point& at) const override;

  /// The robot's own coordinates at the first (0) or second (1) end.
  std::vector<double> at_end(std::span<const double> q, std::size_t which) const;
  struct End;
  bool end(const Point& at, std::size_t which, std::span<const int> selected, End& result) const;
  std::span<const double> tip_part(std::span<const double> correction) const;
  Eigen::Vector3d target(const Eigen::Isometry3d& X, std::span<const double> correction, std::size_t t) const;

  std::unique_ptr<TipModel> tip_;
  DistanceMeasurement spec_;
  double repeats_;
  Repeatability repeatability_;
  int tip_parameters_ = 0;
  std::size_t moving_ = 0;  ///< the robot's coordinates that are not choices; these come first
};

}  // namespace posewright
