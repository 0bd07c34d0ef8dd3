#include <algorithm>
#include <cmath>

#include "instruments.hpp"
#include "posewright/model/placement.hpp"

namespace posewright {
namespace {

/// Inclinometer on the tip: angle between each of its axes s and the horizontal plane, y = asin(sᵀu) for the upward
/// direction u of the measurement frame. Positions have no effect. No parameters of its own: tool.r* say how it is
/// mounted, and a constant offset is such a turn.
class InclinationModel : public MeasurementModel {
 public:
  explicit InclinationModel(const MeasurementSpec& spec)
      : spec_(std::get<InclinationMeasurement>(spec.instrument)),
        R_TipSensor_(isometry({Eigen::Vector3d::Zero(), spec_.rpy}).linear()),
        repeats_(spec.repeats) {
    rows_ = int(spec_.axes.size());
    unseen_reason_ = "the inclination is out of range";
    for (const int axis : spec_.axes) readings_.push_back({std::string("inclination.") + "xyz"[axis], "rad"});
  }

  void read(const Sighting& sighting, Eigen::Ref<Eigen::VectorXd> y) const override {
    for (Eigen::Index row = 0; row < rows_; ++row)
      y[row] = std::asin(std::clamp(axis(sighting, row).dot(spec_.up), -1.0, 1.0));
  }

  /// A turn ω takes s to ω × s, so sᵀu changes by ωᵀ(s × u).
  void rows_of_twists(const Sighting& sighting, const Eigen::Ref<const Twists>& twists,
                      Eigen::Ref<Eigen::MatrixXd> rows) const override {
    for (Eigen::Index row = 0; row < rows_; ++row)
      rows.row(row) = axis(sighting, row).cross(spec_.up).normalized().transpose() * twists.bottomRows<3>();
  }

  void covariance(const Sighting&, Eigen::Ref<Eigen::MatrixXd> covariance) const override {
    covariance = spec_.sigma * spec_.sigma / repeats_ * Eigen::MatrixXd::Identity(rows_, rows_);
  }

  /// The row is h = s × u of length 1, whose change is across h.
  Twist pull_back(const Sighting& sighting, const Adjoint& f) const override {
    Twist sum = Twist::Zero();
    for (Eigen::Index row = 0; row < rows_; ++row) {
      const Eigen::Vector3d s = axis(sighting, row), h = s.cross(spec_.up);
      const Eigen::Vector3d unit = h.normalized(), by_row = f.twist_rows.row(row).tail<3>().transpose();
      const Eigen::Vector3d by_h = (by_row - unit.dot(by_row) * unit) / h.norm();
      sum.tail<3>() += s.cross(Eigen::Vector3d(spec_.up.cross(by_h)));
    }
    return sum;
  }

  bool sees(const Sighting& sighting) const override {
    for (Eigen::Index row = 0; row < rows_; ++row)
      if (std::abs(axis(sighting, row).dot(spec_.up)) > std::sin(spec_.range)) return false;
    return true;
  }
  std::optional<int> margins() const override { return 2 * rows_; }

  void margins_at(const Sighting& sighting, std::span<double> out) const override {
    for (Eigen::Index row = 0; row < rows_; ++row) {
      const double share = axis(sighting, row).dot(spec_.up) / std::sin(spec_.range);
      out[std::size_t(2 * row)] = 1.0 + share;
      out[std::size_t(2 * row) + 1] = 1.0 - share;
    }
  }

 private:
  /// Axis of a reading, in M.
  Eigen::Vector3d axis(const Sighting& sighting, Eigen::Index row) const {
    return sighting.X_MeasureTip.linear() * R_TipSensor_.col(spec_.axes[std::size_t(row)]);
  }

  InclinationMeasurement spec_;
  Eigen::Matrix3d R_TipSensor_;
  double repeats_;
};

}  // namespace

std::unique_ptr<MeasurementModel> model_of(const InclinationMeasurement&, const MeasurementSpec& spec) {
  return std::make_unique<InclinationModel>(spec);
}

}  // namespace posewright
