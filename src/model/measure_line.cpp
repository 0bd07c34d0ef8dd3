#include <algorithm>
#include <array>

#include "displacement.hpp"
#include "instruments.hpp"
#include "posewright/model/placement.hpp"

namespace posewright {
namespace {

constexpr double sensor_tolerance = 5e-3, line_tolerance = 10e-3;  // m
// Sine of the angle below which the sensor's plane sees the line as a stroke, and not as a point.
constexpr double least_angle = 0.25;
enum LineOwn { line_u = 6, line_v, line_tilt_u, line_tilt_v };

/// Laser profiler on the tip that sees a straight edge or a wire: x and z of the point where the line meets the plane
/// y = 0 of the sensor's frame. Own parameters: sensor.{x, …, rz}, which stand for the tool; line.u and line.v, offsets
/// of the line across its direction d (m), line.tilt_u and line.tilt_v, its tilts about its point: d ∝ d₀ + t_u e_u +
/// t_v e_v. Axes e_u and e_v as those of a plane with the normal d₀ (PlaneModel).
class LineModel : public MeasurementModel {
 public:
  explicit LineModel(const MeasurementSpec& spec)
      : spec_(std::get<LineMeasurement>(spec.instrument)),
        X_TipSensor_(isometry(spec_.sensor)),
        across_(axes_across(spec_.direction)),
        repeats_(spec.repeats) {
    rows_ = 2;
    replaces_tool_ = true;
    unseen_reason_ = "the line is out of the profiler's range";
    readings_ = {{"line.x", "m"}, {"line.z", "m"}};
    append_displacement(parameters_, "sensor", X_TipSensor_, sensor_tolerance, 1 * degree);
    for (const char* name : {"line.u", "line.v"})
      parameters_.push_back({name, "m", 0.0, line_tolerance, Role::interest});
    for (const char* name : {"line.tilt_u", "line.tilt_v"})
      parameters_.push_back({name, "rad", 0.0, 1 * degree, Role::interest});
    // The line is fixed in the measurement frame, as the base is; the sensor is the tool.
    for (int i = 0; i < int(parameters_.size()); ++i) preferences_.push_back({i, i < line_u ? 1 : 0});
  }

  void read(const Sighting& sighting, Eigen::Ref<Eigen::VectorXd> y) const override { y = crossing(sighting).reading; }

  /// A sensor that moves sees the line move the other way.
  void rows_of_twists(const Sighting& sighting, const Eigen::Ref<const Twists>& twists,
                      Eigen::Ref<Eigen::MatrixXd> rows) const override {
    const Crossing at = crossing(sighting);
    Eigen::Matrix<double, 2, 6> along;
    along.leftCols<3>() = -at.rows;
    for (int k = 0; k < 2; ++k) along.row(k).tail<3>() = -at.place.cross(Eigen::Vector3d(at.rows.row(k))).transpose();
    rows.noalias() = along * twists;
  }

  bool motion(const Sighting& sighting, int index, Twist* twist) const override {
    if (index >= line_u) return false;
    if (twist != nullptr) *twist = crossing(sighting).sensor.twist(index);
    return true;
  }

  void own_column(const Sighting& sighting, int index, Eigen::Ref<Eigen::VectorXd> column) const override {
    const Crossing at = crossing(sighting);
    if (index < line_tilt_u) column = at.rows * across_.col(index - line_u);
    else column = at.along * (at.rows * across_.col(index - line_tilt_u));
  }

  void covariance(const Sighting&, Eigen::Ref<Eigen::MatrixXd> covariance) const override {
    covariance = spec_.sigma * spec_.sigma / repeats_ * Eigen::Matrix2d::Identity();
  }

  bool sees(const Sighting& sighting) const override {
    std::array<double, 5> margin{};
    margins_at(sighting, margin);
    return std::ranges::all_of(margin, [](double m) { return m >= 0; });
  }
  std::optional<int> margins() const override { return 5; }

  void margins_at(const Sighting& sighting, std::span<double> out) const override {
    const Crossing at = crossing(sighting);
    const double range = spec_.range_upper - spec_.range_lower, aside = 2 * at.reading.x() / spec_.width;
    const double end = 2 * at.along / spec_.length;
    out[0] = (at.reading.y() - spec_.range_lower) / range;
    out[1] = (spec_.range_upper - at.reading.y()) / range;
    out[2] = 1.0 - aside * aside;
    out[3] = 1.0 - end * end;
    out[4] = at.across * at.across - least_angle * least_angle;
  }

 private:
  struct Crossing {
    DisplacementAxes sensor;           ///< in M
    Eigen::Vector3d place;             ///< where the line meets the sensor's plane, in M, m
    double along = 0;                  ///< of that place, from the line's point, in units of the direction's length
    Eigen::Vector2d reading;           ///< x and z in the sensor's frame, m
    Eigen::Matrix<double, 2, 3> rows;  ///< by a small motion of the line's point there, M
    double across = 0;                 ///< sine of the angle between line and sensor's plane
  };

  /// With p and d in the sensor's frame the line meets y = 0 at r = p + s d, s = −p_y/d_y. If its point there moves by
  /// c, r changes by c − (c_y/d_y) d.
  Crossing crossing(const Sighting& sighting) const {
    const double* own = sighting.correction.empty() ? nullptr : sighting.correction.data();
    Eigen::Vector3d point = spec_.point, direction = spec_.direction;
    if (own != nullptr) {
      point += across_ * Eigen::Map<const Eigen::Vector2d>(own + line_u);
      direction += across_ * Eigen::Map<const Eigen::Vector2d>(own + line_tilt_u);
    }
    Frame<double> frame = frame_of(sighting.X_MeasureTip * X_TipSensor_);
    Crossing at;
    at.sensor = displace(frame, own);
    const Eigen::Isometry3d X_SensorMeasure = isometry_of(frame).inverse();
    const Eigen::Vector3d p = X_SensorMeasure * point, d = X_SensorMeasure.linear() * direction;
    at.along = -p.y() / d.y();
    at.place = point + at.along * direction;
    const Eigen::Vector3d r = p + at.along * d;
    at.reading = {r.x(), r.z()};
    const Eigen::Matrix3d& R = X_SensorMeasure.linear();
    at.rows << R.row(0) - d.x() / d.y() * R.row(1), R.row(2) - d.z() / d.y() * R.row(1);
    at.across = d.y() / d.norm();
    return at;
  }

  LineMeasurement spec_;
  Eigen::Isometry3d X_TipSensor_;
  Eigen::Matrix<double, 3, 2> across_;  ///< e_u, e_v
  double repeats_;
};

}  // namespace

InstrumentView view_of(const LineMeasurement& line) {
  InstrumentView view;
  view.targets = {{"sensor", line.sensor.position, 0}};
  return view;
}

std::unique_ptr<MeasurementModel> model_of(const LineMeasurement&, const MeasurementSpec& spec) {
  return std::make_unique<LineModel>(spec);
}

}  // namespace posewright
