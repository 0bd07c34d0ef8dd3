#include <numbers>

#include "displacement.hpp"
#include "instruments.hpp"

namespace posewright {
namespace {

constexpr double probe_tolerance = 1e-3;                   // m
constexpr double offset_tolerance = 10e-3;                 // m, of what was placed by hand
constexpr double tilt_tolerance = std::numbers::pi / 180;  // rad
enum Own { probe_x, offset = 3, tilt_u, tilt_v };

/// Distance of one probe on the tip from a plane in the measurement frame, along the normal n: d = nᵀ(p − o) − offset.
/// A touch reads zero. Own parameters: target.probe.{x,y,z} (tip frame), plane.offset (m), plane.u and plane.v (tilts
/// of the normal: n ∝ n₀ + u e_u + v e_v; e_u is along the projection of the axis of the measurement frame that is most
/// across n₀, the first of equal ones; e_v = n₀ × e_u).
class PlaneModel : public MeasurementModel {
 public:
  explicit PlaneModel(const MeasurementSpec& spec)
      : spec_(std::get<PlaneMeasurement>(spec.instrument)), repeats_(spec.repeats) {
    rows_ = 1;
    rows_per_target_ = 1;
    replaces_tool_ = true;
    unseen_reason_ = "the probe is too far from the plane or beside it";
    readings_ = {{"plane.distance", "m"}};
    in_plane_ = axes_across(spec_.normal);
    for (int k = 0; k < 3; ++k)
      parameters_.push_back({"target." + spec_.probe.name + "." + "xyz"[k], "m", spec_.probe.position[k],
                             probe_tolerance, Role::interest});
    parameters_.push_back({"plane.offset", "m", 0.0, offset_tolerance, Role::interest});
    parameters_.push_back({"plane.u", "rad", 0.0, tilt_tolerance, Role::interest});
    parameters_.push_back({"plane.v", "rad", 0.0, tilt_tolerance, Role::interest});
    // Where the plane is comes first: nobody knows it, and the place of the robot's base says the same.
    for (int i = 0; i < int(parameters_.size()); ++i) preferences_.push_back({i, i < offset ? 1 : 0});
  }

  void read(const Sighting& sighting, Eigen::Ref<Eigen::VectorXd> y) const override { y[0] = touch(sighting).distance; }

  void rows_of_twists(const Sighting& sighting, const Eigen::Ref<const Twists>& twists,
                      Eigen::Ref<Eigen::MatrixXd> rows) const override {
    const Touch at = touch(sighting);
    Twist along;
    along << at.normal, at.probe.cross(at.normal);
    rows.row(0) = along.transpose() * twists;
  }

  void own_column(const Sighting& sighting, int index, Eigen::Ref<Eigen::VectorXd> column) const override {
    const Touch at = touch(sighting);
    if (index < offset) column[0] = at.normal.dot(sighting.X_MeasureTip.linear().col(index));
    else if (index == offset) column[0] = -1.0;
    else
      column[0] = (at.from - at.normal.dot(at.from) * at.normal).dot(in_plane_.col(index - tilt_u)) / at.tilted.norm();
  }

  void covariance(const Sighting&, Eigen::Ref<Eigen::MatrixXd> covariance) const override {
    covariance(0, 0) = spec_.sigma * spec_.sigma / repeats_;
  }

  /// The row is (n, p × n), the probe's columns Rᵀn, a tilt's Pe/‖·‖ with P across n.
  Twist pull_back(const Sighting& sighting, const Adjoint& f) const override {
    const Touch at = touch(sighting);
    const Twist row = f.twist_rows.row(0).transpose();
    Eigen::Vector3d by_point = at.normal.cross(Eigen::Vector3d(row.tail<3>())), by_turn = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < f.own.size(); ++i) {
      const double slope = f.own_columns(0, Eigen::Index(i));
      if (f.own[i] < offset) {
        by_turn += slope * Eigen::Vector3d(sighting.X_MeasureTip.linear().col(f.own[i])).cross(at.normal);
      } else if (f.own[i] > offset) {
        const Eigen::Vector3d e = in_plane_.col(f.own[i] - tilt_u);
        by_point += slope / at.tilted.norm() * (e - at.normal.dot(e) * at.normal);
      }
    }
    return change_by_motion(at.probe, by_point, by_turn);
  }

  bool sees(const Sighting& sighting) const override {
    const Touch at = touch(sighting);
    return at.distance >= spec_.range_lower && at.distance <= spec_.range_upper && at.beside <= spec_.radius;
  }
  std::optional<int> margins() const override { return 3; }

  void margins_at(const Sighting& sighting, std::span<double> out) const override {
    const Touch at = touch(sighting);
    const double range = spec_.range_upper - spec_.range_lower;
    out[0] = (at.distance - spec_.range_lower) / range;
    out[1] = (spec_.range_upper - at.distance) / range;
    out[2] =
        1.0 - (at.beside / spec_.radius) * (at.beside / spec_.radius);  // smooth also where the probe meets the point
  }

 private:
  struct Touch {
    Eigen::Vector3d probe;   ///< in M
    Eigen::Vector3d from;    ///< from the plane's point to the probe
    Eigen::Vector3d tilted;  ///< n₀ + u e_u + v e_v
    Eigen::Vector3d normal;  ///< of length 1
    double distance = 0;     ///< reading, m
    double beside = 0;       ///< distance from the plane's point in the plane, m
  };

  Touch touch(const Sighting& sighting) const {
    Eigen::Vector3d p_TipProbe = spec_.probe.position;
    Touch touch;
    touch.tilted = spec_.normal;
    double shift = 0.0;
    if (!sighting.correction.empty()) {
      p_TipProbe += Eigen::Map<const Eigen::Vector3d>(sighting.correction.data() + probe_x);
      shift = sighting.correction[offset];
      touch.tilted += in_plane_ * Eigen::Map<const Eigen::Vector2d>(sighting.correction.data() + tilt_u);
    }
    touch.normal = touch.tilted.normalized();
    touch.probe = sighting.X_MeasureTip * p_TipProbe;
    touch.from = touch.probe - spec_.point;
    const double above = touch.normal.dot(touch.from);
    touch.distance = above - shift;
    touch.beside = (touch.from - above * touch.normal).norm();
    return touch;
  }

  PlaneMeasurement spec_;
  Eigen::Matrix<double, 3, 2> in_plane_;  ///< e_u, e_v
  double repeats_;
};

}  // namespace

InstrumentView view_of(const PlaneMeasurement& plane) {
  InstrumentView view;
  view.targets = {plane.probe};
  return view;
}

std::unique_ptr<MeasurementModel> model_of(const PlaneMeasurement&, const MeasurementSpec& spec) {
  return std::make_unique<PlaneModel>(spec);
}

}  // namespace posewright
