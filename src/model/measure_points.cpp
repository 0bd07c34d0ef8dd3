
#include <cmath>
#include <numbers>

#include "displacement.hpp"
#include "instruments.hpp"
#include "point_noise.hpp"
#include "posewright/model/placement.hpp"
#include "posewright/problem/problem.hpp"
#include "posewright/support/dense.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

// An instrument is put down by eye: what is known of its place before the fit.
constexpr double station_length_tolerance = 10e-3, station_angle_tolerance = std::numbers::pi / 180;  // m, rad

const double* station_part(std::span<const double> correction, int station) {
  return correction.empty() ? nullptr : correction.data() + 6 * station;
}

/// Places an instrument stands at, each with parameters station.NAME.{x,…,rz} (displacement of its frame).
class Stations {
 public:
  explicit Stations(const std::vector<StationSpec>& specs) {
    for (const StationSpec& spec : specs) {
      X_MeasureStation_.push_back(isometry(spec.placement));
      names_.push_back(spec.name);
    }
  }

  bool empty() const { return X_MeasureStation_.empty(); }

  void append(std::vector<Parameter>& parameters) const {
    for (std::size_t i = 0; i < names_.size(); ++i)
      append_displacement(parameters, "station." + names_[i], X_MeasureStation_[i], station_length_tolerance,
                          station_angle_tolerance);
  }
  const std::vector<std::string>& names() const { return names_; }

  /// Pose of a station with the corrections (of all stations, or empty); identity if there are no stations.
  Eigen::Isometry3d pose(int station, std::span<const double> correction) const {
    if (empty()) return Eigen::Isometry3d::Identity();
    if (correction.empty()) return X_MeasureStation_[std::size_t(station)];
    Frame<double> frame = frame_of(X_MeasureStation_[std::size_t(station)]);
    displace(frame, station_part(correction, station));
    return isometry_of(frame);
  }
  /// Twist of the tip that looks the same as moving along station parameter `index`: zero for the others' parameters.
  Twist apparent_motion(int station, std::span<const double> correction, int index) const {
    if (index / 6 != station) return Twist::Zero();
    Frame<double> frame = frame_of(X_MeasureStation_[std::size_t(station)]);
    return -displace(frame, station_part(correction, station)).twist(index % 6);
  }

 private:
  std::vector<Eigen::Isometry3d> X_MeasureStation_;
  std::vector<std::string> names_;
};

/// Positions of targets fixed to the tip. Rows: target by target, the chosen components of its position in the frame of
/// the station that looks (the measurement frame if there are no stations). Own parameters: target.NAME.{x,y,z} in
/// the tip frame (m), station.NAME.{x,…,rz}.
class PointsModel : public MeasurementModel {
 public:
  explicit PointsModel(const MeasurementSpec& spec)
      : spec_(std::get<PointsMeasurement>(spec.instrument)), places_(spec_.stations), repeats_(spec.repeats) {
    rows_per_target_ = int(spec_.components.size());
    rows_ = int(spec_.targets.size() * spec_.components.size());
    stations_ = places_.names();
    replaces_tool_ = true;
    for (const TargetSpec& target : spec_.targets)
      for (int k = 0; k < 3; ++k)
        parameters_.push_back({"target." + target.name + "." + "xyz"[k], "m", target.position[k],
                               default_target_tolerance, Role::interest});
    for (const TargetSpec& target : spec_.targets)
      for (const int c : spec_.components) readings_.push_back({target.name + "." + "xyz"[c], "m"});
    const int targets = int(parameters_.size());
    places_.append(parameters_);
    for (int i = 0; i < targets; ++i) preferences_.push_back({i, 1});
    // base.* says where the robot stands before the first station; further stations have a place of their own.
    for (int i = targets + 6; i < int(parameters_.size()); ++i) preferences_.push_back({i, 0});
  }

  void read(const Sighting& sighting, Eigen::Ref<Eigen::VectorXd> y) const override {
    const Eigen::Isometry3d X_StationMeasure =
        places_.pose(sighting.station, station_part(sighting.correction)).inverse();
    Eigen::Index row = 0;
    for (std::size_t t = 0; t < spec_.targets.size(); ++t) {
      const Eigen::Vector3d p = X_StationMeasure * target(sighting, t);
      for (const int c : spec_.components) y[row++] = p[c];
    }
  }

  void rows_of_twists(const Sighting& sighting, const Eigen::Ref<const Twists>& twists,
                      Eigen::Ref<Eigen::MatrixXd> rows) const override {
    const auto width = Eigen::Index(spec_.components.size());
    if (places_.empty()) {
      Eigen::Index row = 0;
      for (std::size_t t = 0; t < spec_.targets.size(); ++t) {
        const Eigen::Vector3d p = target(sighting, t);
        for (const int c : spec_.components) {
          // Component c of v + ω × p.
          const int a = (c + 1) % 3, b = (c + 2) % 3;
          for (Eigen::Index j = 0; j < twists.cols(); ++j)
            rows(row, j) = twists(c, j) + twists(3 + a, j) * p[b] - twists(3 + b, j) * p[a];
          ++row;
        }
      }
      return;
    }
    const Eigen::Matrix3d R = places_.pose(sighting.station, station_part(sighting.correction)).linear().transpose();
    for (std::size_t t = 0; t < spec_.targets.size(); ++t) {
      const Eigen::Vector3d p = target(sighting, t);
      for (Eigen::Index j = 0; j < twists.cols(); ++j) {
        const Eigen::Vector3d moved = R * (twists.col(j).head<3>() + Eigen::Vector3d(twists.col(j).tail<3>()).cross(p));
        for (Eigen::Index c = 0; c < width; ++c)
          rows(Eigen::Index(t) * width + c, j) = moved[spec_.components[std::size_t(c)]];
      }
    }
  }

  bool motion(const Sighting& sighting, int index, Twist* twist) const override {
    const int station_parameter = index - 3 * int(spec_.targets.size());
    if (station_parameter < 0) return false;
    if (twist != nullptr)
      *twist = places_.apparent_motion(sighting.station, station_part(sighting.correction), station_parameter);
    return true;
  }

  void own_column(const Sighting& sighting, int index, Eigen::Ref<Eigen::VectorXd> column) const override {
    column.setZero();
    const auto width = Eigen::Index(spec_.components.size());
    Eigen::Vector3d moved = sighting.X_MeasureTip.linear().col(index % 3);
    if (!places_.empty())
      moved = places_.pose(sighting.station, station_part(sighting.correction)).linear().transpose() * moved;
    for (Eigen::Index c = 0; c < width; ++c) column[index / 3 * width + c] = moved[spec_.components[std::size_t(c)]];
  }

  HarmonicNoise harmonic_noise() const override {
    HarmonicNoise noise;
    const auto* tracker = std::get_if<TrackerNoise>(&spec_.noise);
    if (tracker == nullptr) {
      noise.kind = HarmonicNoise::Kind::constant;
    } else if (spec_.components.size() == 3) {
      noise.kind = HarmonicNoise::Kind::beams;
      noise.along = squared(tracker->range, tracker->range_per_m, repeats_);
      noise.across = squared(tracker->transverse, tracker->angle, repeats_);
    }
    return noise;
  }

  std::optional<Eigen::Matrix<double, 6, 6>> tip_covariance() const override {
    const auto* noise = std::get_if<GaussianNoise>(&spec_.noise);
    if (noise == nullptr || spec_.components.size() != 3 || !places_.empty()) return std::nullopt;
    const Eigen::Matrix3d& C = noise->covariance;
    // Points that are as good in all directions turn with the tip.
    if (C != C(0, 0) * Eigen::Matrix3d::Identity()) return std::nullopt;
    try {
      return fitted_pose_covariance(*this, Eigen::Isometry3d::Identity());
    } catch (const CannotDo&) {
      return std::nullopt;
    }
  }

  void covariance(const Sighting& sighting, Eigen::Ref<Eigen::MatrixXd> covariance) const override {
    covariance.setZero();
    const auto width = Eigen::Index(spec_.components.size());
    const Eigen::Isometry3d X_MeasureStation = places_.pose(sighting.station, station_part(sighting.correction));
    for (std::size_t t = 0; t < spec_.targets.size(); ++t) {
      const Eigen::Vector3d from = target(sighting, t) - X_MeasureStation.translation();
      const Eigen::Matrix3d point =
          point_covariance(spec_.noise, X_MeasureStation.linear().transpose() * from) / repeats_;
      const Eigen::Index first = Eigen::Index(t) * width;
      for (Eigen::Index i = 0; i < width; ++i)
        for (Eigen::Index j = 0; j < width; ++j)
          covariance(first + i, first + j) = point(spec_.components[std::size_t(i)], spec_.components[std::size_t(j)]);
    }
  }

  Twist pull_back(const Sighting& sighting, const Adjoint& f) const override {
    const auto width = Eigen::Index(spec_.components.size());
    const Eigen::Isometry3d X_MeasureStation = places_.pose(sighting.station, station_part(sighting.correction));
    const Eigen::Matrix3d& R = X_MeasureStation.linear();
    Twist sum = Twist::Zero();
    for (std::size_t t = 0; t < spec_.targets.size(); ++t) {
      const Eigen::Vector3d p = target(sighting, t);
      const Eigen::Index first = Eigen::Index(t) * width;
      Eigen::Vector3d by_point = Eigen::Vector3d::Zero();
      // A turn about axis k moves the point by e_k × p.
      Eigen::Matrix3d turns = Eigen::Matrix3d::Zero(), noise = Eigen::Matrix3d::Zero();
      for (Eigen::Index i = 0; i < width; ++i) {
        const int c = spec_.components[std::size_t(i)];
        turns += R.col(c) * f.twist_rows.row(first + i).tail<3>();
        for (Eigen::Index j = 0; j < width; ++j)
          noise(c, spec_.components[std::size_t(j)]) = f.covariance(first + i, first + j) / repeats_;
      }
      for (int k = 0; k < 3; ++k) by_point += turns.col(k).cross(Eigen::Vector3d::Unit(k));
      const Eigen::Vector3d p_Station = R.transpose() * (p - X_MeasureStation.translation());
      by_point += R * point_covariance_change(spec_.noise, p_Station, noise);
      sum += change_by_motion(p, by_point, Eigen::Vector3d::Zero());
    }
    for (std::size_t i = 0; i < f.own.size(); ++i) {
      if (f.own[i] >= 3 * int(spec_.targets.size())) continue;  // a station stays where it is
      Eigen::Vector3d along = Eigen::Vector3d::Zero();
      for (Eigen::Index c = 0; c < width; ++c)
        along += f.own_columns(f.own[i] / 3 * width + c, Eigen::Index(i)) * R.col(spec_.components[std::size_t(c)]);
      sum.tail<3>() += sighting.X_MeasureTip.linear().col(f.own[i] % 3).cross(along);
    }
    return sum;
  }

 private:
  std::span<const double> station_part(std::span<const double> correction) const {
    return correction.empty() ? correction : correction.subspan(3 * spec_.targets.size());
  }

  Eigen::Vector3d target(const Sighting& sighting, std::size_t index) const {
    Eigen::Vector3d p_TipTarget = spec_.targets[index].position;
    if (!sighting.correction.empty())
      p_TipTarget += Eigen::Map<const Eigen::Vector3d>(sighting.correction.data() + 3 * index);
    return sighting.X_MeasureTip * p_TipTarget;
  }

  PointsMeasurement spec_;
  Stations places_;
  double repeats_;
};

}  // namespace

InstrumentView view_of(const PointsMeasurement& points) {
  InstrumentView view;
  view.targets = points.targets;
  const auto* noise = std::get_if<GaussianNoise>(&points.noise);
  if (noise != nullptr && points.components.size() == 3) view.point_noise = std::sqrt(noise->covariance.trace() / 3);
  view.has_places = true;
  for (const StationSpec& station : points.stations)
    view.places.push_back({station, "station." + station.name, "station " + station.name});
  for (const TargetSpec& t : points.targets) view.points.push_back({t.name, t.position, "target." + t.name});
  return view;
}

std::unique_ptr<MeasurementModel> model_of(const PointsMeasurement&, const MeasurementSpec& spec) {
  return std::make_unique<PointsModel>(spec);
}

}  // namespace posewright
