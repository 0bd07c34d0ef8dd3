#include <algorithm>
#include <optional>

#include "displacement.hpp"
#include "instruments.hpp"
#include "posewright/model/rotation_vector.hpp"

namespace posewright {
namespace {

/// The points of a photogrammetric pose, measured once.
std::unique_ptr<MeasurementModel> points_of(const PoseMeasurement& pose) {
  if (pose.photogrammetry.empty()) return nullptr;
  PointsMeasurement points;
  points.targets = pose.photogrammetry;
  points.noise = GaussianNoise{pose.point_sigma * pose.point_sigma * Eigen::Matrix3d::Identity()};
  MeasurementSpec spec;
  spec.instrument = points;
  return model_of(points, spec);
}

/// Full or partial pose of the tip. Rows: the chosen components of (position of the tip origin in M, rotation as a
/// spatial rotation vector in M): v + ω × p and ω of a twist. Readings pose.{x,…,rz}: the position and the rotation
/// vector of the tip's orientation in M; if rx, ry, rz are not all measured, components of the small rotation from the
/// nominal orientation. No parameters of its own. With photogrammetry the
/// covariance is that of the rigid fit to the points.
///
/// An instrument on the hand reads the pose of M in the tip, X⁻¹ for the tip's pose X = (R, p): rows −Rᵀ v and −Rᵀ ω.
class PoseModel : public MeasurementModel {
 public:
  explicit PoseModel(const MeasurementSpec& spec)
      : spec_(std::get<PoseMeasurement>(spec.instrument)), points_(points_of(spec_)), repeats_(spec.repeats) {
    rows_ = int(spec_.components.size());
    for (const int c : spec_.components)
      readings_.push_back({std::string("pose.") + displacement_names[std::size_t(c)], c < 3 ? "m" : "rad"});
    if (points_ != nullptr) fitted_ = fitted_pose_covariance(*points_, Eigen::Isometry3d::Identity());
    turns_ = int(std::count_if(spec_.components.begin(), spec_.components.end(), [](int c) { return c > 2; }));
  }

  void read(const Sighting& sighting, Eigen::Ref<Eigen::VectorXd> y) const override {
    const Eigen::Isometry3d X = seen(sighting.X_MeasureTip);
    Eigen::Matrix3d from = Eigen::Matrix3d::Identity();
    if (reads_from_nominal()) from = seen(*sighting.X_MeasureTipNominal).linear();
    const Eigen::Vector3d turn = rotation_vector(X.linear() * from.transpose());
    for (Eigen::Index i = 0; i < rows_; ++i) {
      const int c = spec_.components[std::size_t(i)];
      y[i] = c < 3 ? X.translation()[c] : turn[c - 3];
    }
  }
  bool reads_from_nominal() const override { return turns_ == 1 || turns_ == 2; }

  void difference(const Eigen::VectorXd& measured, const Eigen::VectorXd& predicted,
                  Eigen::VectorXd& out) const override {
    out = measured - predicted;
    // Components ascend, so the three of an orientation are the last.
    if (turns_ == 3)
      out.tail<3>() = rotation_vector(rotation_by(measured.tail<3>()) * rotation_by(predicted.tail<3>()).transpose());
  }

  void shifted(const Eigen::VectorXd& predicted, const Eigen::VectorXd& change, Eigen::VectorXd& out) const override {
    out = predicted + change;
    if (turns_ == 3) out.tail<3>() = rotation_vector(rotation_by(change.tail<3>()) * rotation_by(predicted.tail<3>()));
  }

  void rows_of_twists(const Sighting& sighting, const Eigen::Ref<const Twists>& twists,
                      Eigen::Ref<Eigen::MatrixXd> rows) const override {
    if (spec_.on_hand) {
      const Eigen::Matrix3d R = sighting.X_MeasureTip.linear();
      for (Eigen::Index i = 0; i < rows_; ++i) {
        const int c = spec_.components[std::size_t(i)], part = c < 3 ? 0 : 3;
        rows.row(i) = -R.col(c - part).transpose() * twists.middleRows(part, 3);
      }
      return;
    }
    const Eigen::Vector3d p = sighting.X_MeasureTip.translation();
    Eigen::Index row = 0;
    for (const int c : spec_.components) {
      const int a = (c + 1) % 3, b = (c + 2) % 3;
      for (Eigen::Index j = 0; j < twists.cols(); ++j)
        rows(row, j) = c < 3 ? twists(c, j) + twists(3 + a, j) * p[b] - twists(3 + b, j) * p[a] : twists(c, j);
      ++row;
    }
  }

  HarmonicNoise harmonic_noise() const override {
    HarmonicNoise noise;
    if (spec_.on_hand) return noise;
    noise.kind = HarmonicNoise::Kind::constant;
    if (points_ == nullptr) return noise;
    // A pose fitted to points tells what the points tell; a part of it does not.
    if (rows_ < 6) return {};
    noise.instead = points_.get();
    noise.repeats = repeats_;
    return noise;
  }

  std::optional<Eigen::Matrix<double, 6, 6>> tip_covariance() const override {
    if (rows_ != 6 || spec_.on_hand) return std::nullopt;
    std::optional<Eigen::Matrix<double, 6, 6>> C = points_ != nullptr ? points_->tip_covariance() : spec_.covariance;
    if (!C) return std::nullopt;
    if (points_ == nullptr) {
      // Given along the axes of M; the same along those of the tip if no direction is better than another.
      Eigen::Matrix<double, 6, 1> alike;
      alike << (*C)(0, 0), (*C)(0, 0), (*C)(0, 0), (*C)(3, 3), (*C)(3, 3), (*C)(3, 3);
      if (*C != Eigen::Matrix<double, 6, 6>(alike.asDiagonal())) return std::nullopt;
    }
    *C /= repeats_;
    return C;
  }

  void covariance(const Sighting& sighting, Eigen::Ref<Eigen::MatrixXd> covariance) const override {
    const Eigen::Matrix<double, 6, 6> full =
        points_ == nullptr ? spec_.covariance : fitted_covariance(sighting.X_MeasureTip.linear());
    for (Eigen::Index i = 0; i < rows_; ++i)
      for (Eigen::Index j = 0; j < rows_; ++j)
        covariance(i, j) = full(spec_.components[std::size_t(i)], spec_.components[std::size_t(j)]) / repeats_;
  }

  Twist pull_back(const Sighting& sighting, const Adjoint& f) const override {
    if (spec_.on_hand) return MeasurementModel::pull_back(sighting, f);
    Eigen::Vector3d by_point = Eigen::Vector3d::Zero(), by_turn = Eigen::Vector3d::Zero();
    for (Eigen::Index i = 0; i < rows_; ++i)
      if (const int c = spec_.components[std::size_t(i)]; c < 3)
        by_point += Eigen::Vector3d::Unit(c).cross(Eigen::Vector3d(f.twist_rows.row(i).tail<3>()));
    if (points_ != nullptr) {
      // The covariance turns with the tip: its change is Ω Σ + Σ Ωᵀ.
      Eigen::Matrix<double, 6, 6> slope = Eigen::Matrix<double, 6, 6>::Zero();
      for (Eigen::Index i = 0; i < rows_; ++i)
        for (Eigen::Index j = 0; j < rows_; ++j)
          slope(spec_.components[std::size_t(i)], spec_.components[std::size_t(j)]) = f.covariance(i, j) / repeats_;
      const Eigen::Matrix<double, 6, 6> product = 2 * slope * fitted_covariance(sighting.X_MeasureTip.linear());
      for (const int b : {0, 3})
        by_turn += Eigen::Vector3d(product(b + 2, b + 1) - product(b + 1, b + 2), product(b, b + 2) - product(b + 2, b),
                                   product(b + 1, b) - product(b, b + 1));
    }
    return change_by_motion(sighting.X_MeasureTip.translation(), by_point, by_turn);
  }

 private:
  Eigen::Isometry3d seen(const Eigen::Isometry3d& X_MeasureTip) const {
    return spec_.on_hand ? X_MeasureTip.inverse() : X_MeasureTip;
  }
  /// Noise of points without direction: at the measurement frame's own axes, turned.
  Eigen::Matrix<double, 6, 6> fitted_covariance(const Eigen::Matrix3d& R) const {
    Eigen::Matrix<double, 6, 6> turned;
    for (const int i : {0, 3})
      for (const int j : {0, 3}) turned.block<3, 3>(i, j) = R * fitted_.block<3, 3>(i, j) * R.transpose();
    return turned;
  }

  PoseMeasurement spec_;
  std::unique_ptr<MeasurementModel> points_;  // of photogrammetry
  Eigen::Matrix<double, 6, 6> fitted_ = Eigen::Matrix<double, 6, 6>::Zero();
  double repeats_;
  int turns_ = 0;  // how many of rx, ry, rz are read
};

}  // namespace

InstrumentView view_of(const PoseMeasurement& pose) {
  InstrumentView view;
  view.targets = pose.photogrammetry;
  view.fits_pose = true;
  view.point_noise = pose.point_sigma;
  view.all_places = true;
  for (const TargetSpec& t : view.targets) view.points.push_back({t.name, t.position, {}});
  return view;
}

std::unique_ptr<MeasurementModel> model_of(const PoseMeasurement&, const MeasurementSpec& spec) {
  return std::make_unique<PoseModel>(spec);
}

}  // namespace posewright
