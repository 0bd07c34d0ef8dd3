#pragma once

#include <memory>

#include "posewright/model/identification_model.hpp"
#include "posewright/model/measurement_model.hpp"
#include "posewright/model/tip_model.hpp"
#include "posewright/problem/measurement_specs.hpp"

namespace posewright {

/// A robot that carries a tip, seen by an instrument: g = y − h(ρ, ξ). Parameters: the robot's, then the instrument's.
/// Where the instrument's targets stand for the tool, tool.* are left out. Configuration: the robot's, then the station
/// if there is a choice. Residual covariance: the instrument's, plus the joint readings' noise through ∂h/∂ρ, plus
/// the common effect of the tip's displacement at this visit on all readings.
///
/// Everything but targets and lenses acts on the readings through a motion of the tip, so G = [Y | O] · C with Y (r ×
/// 6) the rows along unit twists and O the own columns: where r is larger than that, blocks are written with 6 + |O|
/// rows.
class ExplicitModel : public IdentificationModel {
 public:
  ExplicitModel(std::unique_ptr<TipModel> tip, std::unique_ptr<MeasurementModel> measurement,
                const Repeatability& repeatability = {});

  const TipModel& tip() const { return *tip_; }
  const MeasurementModel& measurement() const { return *measurement_; }
  const Repeatability& repeatability() const { return repeatability_; }
  /// Number of the tip's parameters in use; the instrument's follow.
  int tip_parameters() const { return tip_parameters_; }

  /// Readings where the robot stands already, for a model around this one. @param y  size rows()
  bool read_settled(const Point& at, Eigen::VectorXd& y) const { return do_read(at, y); }

 private:
  void do_take_loads_at(std::span<const double> correction) override;
  bool do_linearise(const Point& at, std::span<const int> selected, Linearisation& out) const override;
  bool do_pull_back(const Point& at, std::span<const int> selected, const Eigen::MatrixXd& by_G,
                    const Eigen::MatrixXd& by_covariance, std::span<double> gradient) const override;
  bool do_read(const Point& at, Eigen::VectorXd& y) const override;
  void do_difference(const Eigen::VectorXd& measured, const Eigen::VectorXd& predicted,
                     Eigen::VectorXd& out) const override;
  void do_shifted(const Eigen::VectorXd& predicted, const Eigen::VectorXd& change, Eigen::VectorXd& out) const override;
  bool do_configuration_at(std::span<const double> actuators, const Point& start, std::span<double> q) const override;
  int do_block_rows(std::span<const int> selected) const override;
  bool do_linearise_factored(const Point& at, std::span<const int> selected, Linearisation& out) const override;
  bool do_measurable(const Point& at) const override;
  std::optional<int> do_measurable_margins() const override { return measurement_->margins(); }
  bool do_measurable_margins_at(const Point& at, std::span<double> out) const override;
  bool do_actuator_values(const Point& at, std::span<double> values) const override;
  Eigen::Isometry3d do_tool_pose(const Point& at) const override;

  bool do_reading_twists(const Point& at, Twists& twists) const override;

  struct Parts;
  Parts parts(const Point& at) const;
  bool twists_and_noise(const Parts& parts, std::span<const int> selected, Eigen::Isometry3d& X,
                        Linearisation& out) const;
  void displacements_pulled_back(const Eigen::MatrixXd& by_covariance, const Eigen::MatrixXd& unit_rows,
                                 Eigen::MatrixXd& by_unit_rows) const;
  void displace_alone(const MeasurementModel::Sighting& sighting, Linearisation& out) const;

  std::unique_ptr<TipModel> tip_;
  std::unique_ptr<MeasurementModel> measurement_;
  int tip_parameters_ = 0;           ///< how many of the tip's parameters are in use (tool.* are its last)
  std::vector<char> is_own_column_;  ///< per parameter: the instrument's, and no motion of the tip
  Repeatability repeatability_;
  bool reading_noise_ = false;
};

}  // namespace posewright
