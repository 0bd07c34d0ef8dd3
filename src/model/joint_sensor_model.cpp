#include <algorithm>
#include <cmath>
#include <numbers>

#include "instruments.hpp"
#include "posewright/model/closed_chain.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

/// Self-calibration: a closed chain's redundant joint sensors against what its other joints say. No instrument, so
/// base.* and tool.* have no effect and are left out of what `auto` chooses from.
class JointSensorModel : public IdentificationModel {
 public:
  /// Throws CannotDo for a robot without redundant sensors, InputError for a sensor that it has not.
  JointSensorModel(std::unique_ptr<TipModel> tip, const MeasurementSpec& measurement, const ProblemFile& file)
      : tip_(std::move(tip)) {
    const auto& spec = std::get<JointsMeasurement>(measurement.instrument);
    const std::vector<Coordinate>& all = tip_->sensors();
    if (all.empty()) throw CannotDo("measurement: this robot has no redundant joint sensors; a five_bar has");
    std::string names;
    for (const Coordinate& c : all) names += (names.empty() ? "sensors: " : ", ") + c.name;
    for (const Located<std::string>& name : spec.sensors) {
      const auto found =
          std::find_if(all.begin(), all.end(), [&](const Coordinate& c) { return c.name == name.value; });
      if (found == all.end())
        throw InputError(file.at(name.line), "'" + name.value + "' is not a redundant sensor of this robot", names);
      sensors_.push_back(int(found - all.begin()));
    }
    if (sensors_.empty())
      for (int i = 0; i < int(all.size()); ++i) sensors_.push_back(i);
    for (const int i : sensors_) {
      const Quantity own = all[std::size_t(i)].unit == "m" ? Quantity::length : Quantity::angle;
      if (spec.quantity != Quantity::number && spec.quantity != own)
        throw InputError(file.at(measurement.line),
                         "the noise of the joint sensors has the wrong unit for '" + all[std::size_t(i)].name + "'",
                         "allowed: " + allowed_units({own}));
    }
    for (const int i : sensors_) readings_.push_back({all[std::size_t(i)].name, all[std::size_t(i)].unit});
    variance_ = spec.sigma * spec.sigma / measurement.repeats;
    parameters_ = tip_->parameters();
    coordinates_ = tip_->coordinates();
    actuators_ = tip_->actuators();
    for (const Preference& p : tip_->geometric_parameters()) {
      const std::string& name = parameters_[std::size_t(p.parameter)].name;
      if (!name.starts_with("base.") && !name.starts_with("tool.")) geometric_.push_back(p);
    }
    rows_ = int(sensors_.size());
    unmeasurable_reason_ = near_singularity();
  }

 private:
  void do_take_loads_at(std::span<const double> correction) override { tip_->take_loads_at(correction); }

  bool do_linearise(const Point& at, std::span<const int> selected, Linearisation& out) const override {
    static thread_local Eigen::MatrixXd rows, reading_rows;
    if (!tip_->sensor_rows(at, selected, rows, reading_rows)) return false;
    out.G.resize(rows_, rows.cols());
    out.rows.resize(rows_, reading_rows.cols());
    for (Eigen::Index i = 0; i < rows_; ++i) {
      out.G.row(i) = rows.row(sensors_[std::size_t(i)]);
      out.rows.row(i) = reading_rows.row(sensors_[std::size_t(i)]);
    }
    for (Eigen::Index j = 0; j < out.rows.cols(); ++j) out.rows.col(j) *= tip_->reading_noise()[std::size_t(j)];
    out.covariance.setZero(rows_, rows_);
    out.covariance.diagonal().array() += variance_;
    out.share_readings();
    out.covariance.noalias() += out.rows * out.rows.transpose();
    return true;
  }

  bool do_read(const Point& at, Eigen::VectorXd& y) const override {
    static thread_local Eigen::VectorXd all;
    if (!tip_->sensor_values(at, all)) return false;
    for (Eigen::Index i = 0; i < rows_; ++i) y[i] = all[sensors_[std::size_t(i)]];
    return true;
  }

  void do_difference(const Eigen::VectorXd& measured, const Eigen::VectorXd& predicted,
                     Eigen::VectorXd& out) const override {
    out = measured - predicted;
    for (Eigen::Index i = 0; i < rows_; ++i)
      if (readings_[std::size_t(i)].unit == "rad") out[i] = std::remainder(out[i], 2 * std::numbers::pi);
  }

  bool do_configuration_at(std::span<const double> actuators, const Point& start, std::span<double> q) const override {
    return tip_->configuration_at(actuators, start, q);
  }

  bool do_measurable(const Point& at) const override {
    Twists none;
    Eigen::Isometry3d X;
    return tip_->linearise(at, {}, X, none, nullptr);
  }
  std::optional<int> do_measurable_margins() const override { return 0; }

  bool do_actuator_values(const Point& at, std::span<double> values) const override {
    return tip_->actuator_values(at, values);
  }

  Eigen::Isometry3d do_tool_pose(const Point& at) const override {
    Twists none;
    Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
    tip_->linearise(at, {}, X, none, nullptr);
    return X;
  }

  std::unique_ptr<TipModel> tip_;
  std::vector<int> sensors_;  // which of the robot's, in the order of the rows
  double variance_;
};

}  // namespace

std::unique_ptr<IdentificationModel> joint_sensor_model(std::unique_ptr<TipModel> tip, const MeasurementSpec& spec,
                                                        const ProblemFile& file) {
  return std::make_unique<JointSensorModel>(std::move(tip), spec, file);
}

}  // namespace posewright
