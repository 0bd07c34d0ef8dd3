#include <numbers>

#include "displacement.hpp"
#include "instruments.hpp"
#include "pinhole.hpp"
#include "posewright/model/placement.hpp"
#include "posewright/support/dense.hpp"

namespace posewright {
namespace {

constexpr int poses = 12, lens_size = 9;  // camera.* and board.* displacements come first
constexpr int scale_at = poses + lens_size;
// 1σ: a board from an office printer.
constexpr double scale_tolerance = 5e-3;
constexpr std::array<const char*, lens_size> lens_names = {"fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3"};
// 1σ before calibration: a data sheet's focal length and centre, an ordinary lens.
constexpr std::array<double, lens_size> lens_tolerance = {10, 10, 10, 10, 0.1, 0.1, 0.01, 0.01, 0.1};

using Lens = std::array<double, lens_size>;
using Row23 = Eigen::Matrix<double, 2, 3>;

/// Derivative of project() by the point (2 × 3) and by the lens (2 × 9).
Row23 by_point(const Eigen::Vector3d& p, const Lens& lens) {
  const double x = p.x() / p.z(), y = p.y() / p.z(), s = x * x + y * y;
  const double radial = 1 + s * (lens[4] + s * (lens[5] + s * lens[8]));
  const double by_s = lens[4] + s * (2 * lens[5] + 3 * s * lens[8]);  // ∂radial/∂s
  Eigen::Matrix2d D;
  D(0, 0) = radial + 2 * x * x * by_s + 2 * lens[6] * y + 6 * lens[7] * x;
  D(0, 1) = 2 * x * y * by_s + 2 * lens[6] * x + 2 * lens[7] * y;
  D(1, 0) = 2 * x * y * by_s + 2 * lens[6] * x + 2 * lens[7] * y;
  D(1, 1) = radial + 2 * y * y * by_s + 6 * lens[6] * y + 2 * lens[7] * x;
  D.row(0) *= lens[0];
  D.row(1) *= lens[1];
  Row23 N;
  N << 1, 0, -x, 0, 1, -y;
  return D * N / p.z();
}

Eigen::Vector2d by_lens(const Eigen::Vector3d& p, const Lens& lens, int k) {
  const double x = p.x() / p.z(), y = p.y() / p.z(), s = x * x + y * y;
  Lens unit = lens;
  if (k < 2) unit[2] = unit[3] = 0;
  Eigen::Vector2d pixel;
  project(p.data(), unit.data(), pixel.data());
  const double fx = lens[0], fy = lens[1];
  switch (k) {
    case 0:
      return {pixel.x() / fx, 0};
    case 1:
      return {0, pixel.y() / fy};
    case 2:
      return {1, 0};
    case 3:
      return {0, 1};
    case 4:
      return {fx * x * s, fy * y * s};
    case 5:
      return {fx * x * s * s, fy * y * s * s};
    case 6:
      return {fx * 2 * x * y, fy * (s + 2 * y * y)};
    case 7:
      return {fx * (s + 2 * x * x), fy * 2 * x * y};
    default:
      return {fx * x * s * s * s, fy * y * s * s * s};
  }
}

Lens lens_of(const CameraMeasurement& camera) {
  Lens lens = {camera.fx, camera.fy, camera.cx, camera.cy};
  for (std::size_t k = 0; k < 5; ++k) lens[4 + k] = camera.distortion[k];
  return lens;
}

/// A camera and a board of known points, one on the tip, the other fixed. Rows: point by point, image coordinates u, v
/// (px). Own parameters: camera.{x,…,rz} and board.{x,…,rz}, displacements of their frames in what carries them (the
/// hand-eye transform and where the fixed one stands), camera.{fx, fy, cx, cy, k1, k2, p1, p2, k3}, and
/// pattern.scale, which multiplies the spacing of the points.
class CameraModel : public MeasurementModel {
 public:
  explicit CameraModel(const MeasurementSpec& spec)
      : spec_(std::get<CameraMeasurement>(spec.instrument)),
        X_CarrierCamera_(isometry(spec_.camera)),
        X_CarrierBoard_(isometry(spec_.board)),
        repeats_(spec.repeats) {
    for (int r = 0; r < spec_.rows; ++r)
      for (int c = 0; c < spec_.columns; ++c) points_.emplace_back(c * spec_.spacing, r * spec_.spacing, 0);
    for (std::size_t i = 1; i <= points_.size(); ++i)
      for (const char* axis : {".u", ".v"}) readings_.push_back({"point_" + std::to_string(i) + axis, "px"});
    rows_per_target_ = 2;
    rows_ = 2 * int(points_.size());
    replaces_tool_ = true;
    unseen_reason_ = "board not in the image or behind the camera";
    append_displacement(parameters_, "camera", X_CarrierCamera_, 5e-3, 1 * degree);
    append_displacement(parameters_, "board", X_CarrierBoard_, 5e-3, 1 * degree);
    // The one on the hand is the tool; the other one is fixed in the measurement frame, as the base is.
    for (int i = 0; i < poses; ++i) preferences_.push_back({i, (i < 6) == spec_.on_hand ? 1 : 0});
    const Lens nominal = lens_of(spec_);
    for (std::size_t k = 0; k < lens_size; ++k)
      parameters_.push_back(
          {std::string("camera.") + lens_names[k], k < 4 ? "px" : "1", nominal[k], lens_tolerance[k], Role::interest});
    parameters_.push_back({"pattern.scale", "1", 1.0, scale_tolerance, Role::interest});
  }

  void read(const Sighting& sighting, Eigen::Ref<Eigen::VectorXd> y) const override {
    const Scene s = scene(sighting);
    const Eigen::Isometry3d X_CameraBoard = s.X_MeasureCamera.inverse() * s.X_MeasureBoard;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Eigen::Vector3d p = X_CameraBoard * (s.scale * points_[i]);
      project(p.data(), s.lens.data(), y.data() + 2 * i);
    }
  }

  void rows_of_twists(const Sighting& sighting, const Eigen::Ref<const Twists>& twists,
                      Eigen::Ref<Eigen::MatrixXd> rows) const override {
    const Scene s = scene(sighting);
    const Eigen::Matrix3d R = s.X_MeasureCamera.linear().transpose();
    const double sign = spec_.on_hand ? -1 : 1;  // a camera that moves sees the board move the other way
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Eigen::Vector3d p = s.X_MeasureBoard * (s.scale * points_[i]);
      const Row23 P = sign * by_point(R * (p - s.X_MeasureCamera.translation()), s.lens) * R;
      Eigen::Matrix<double, 2, 6> along;
      along.leftCols<3>() = P;
      for (int k = 0; k < 2; ++k) along.row(k).tail<3>() = p.cross(Eigen::Vector3d(P.row(k))).transpose();
      rows.middleRows<2>(2 * Eigen::Index(i)).noalias() = along * twists;
    }
  }

  bool motion(const Sighting& sighting, int index, Twist* twist) const override {
    if (index >= poses) return false;
    if (twist != nullptr) {
      const Scene s = scene(sighting);
      const bool camera = index < 6;
      *twist = (camera ? s.camera : s.board).twist(index % 6);
      // What is on the tip moves with it; the fixed one moves against it.
      if (camera != spec_.on_hand) *twist = -*twist;
    }
    return true;
  }

  void own_column(const Sighting& sighting, int index, Eigen::Ref<Eigen::VectorXd> column) const override {
    const Scene s = scene(sighting);
    const Eigen::Isometry3d X_CameraBoard = s.X_MeasureCamera.inverse() * s.X_MeasureBoard;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Eigen::Vector3d p = X_CameraBoard * (s.scale * points_[i]);
      column.segment<2>(2 * Eigen::Index(i)) =
          index == scale_at ? Eigen::Vector2d(by_point(p, s.lens) * (X_CameraBoard.linear() * points_[i]))
                            : by_lens(p, s.lens, index - poses);
    }
  }

  void covariance(const Sighting&, Eigen::Ref<Eigen::MatrixXd> covariance) const override {
    covariance.setZero();
    covariance.diagonal().array() += spec_.sigma * spec_.sigma / repeats_;
  }
  /// All points in front of the camera and in the image.
  bool sees(const Sighting& sighting) const override {
    const Scene s = scene(sighting);
    const Eigen::Isometry3d X_CameraBoard = s.X_MeasureCamera.inverse() * s.X_MeasureBoard;
    for (const Eigen::Vector3d& point : points_) {
      const Eigen::Vector3d p = X_CameraBoard * (s.scale * point);
      if (!(p.z() > 0)) return false;
      Eigen::Vector2d pixel;
      project(p.data(), s.lens.data(), pixel.data());
      if (!(pixel.x() >= 0 && pixel.x() <= spec_.width && pixel.y() >= 0 && pixel.y() <= spec_.height)) return false;
    }
    return true;
  }

 private:
  /// Camera and board in M with their corrections, and the axes of these.
  struct Scene {
    Eigen::Isometry3d X_MeasureCamera, X_MeasureBoard;
    DisplacementAxes camera, board;
    Lens lens;
    double scale = 1.0;  ///< of the board's points
  };

  Scene scene(const Sighting& sighting) const {
    const auto& correction = sighting.correction;
    Scene s;
    const auto place = [&](const Eigen::Isometry3d& X_Carrier, bool on_tip, std::size_t first, DisplacementAxes& axes) {
      Frame<double> frame = frame_of(on_tip ? Eigen::Isometry3d(sighting.X_MeasureTip * X_Carrier) : X_Carrier);
      axes = displace(frame, correction.empty() ? nullptr : correction.data() + first);
      return isometry_of(frame);
    };
    s.X_MeasureCamera = place(X_CarrierCamera_, spec_.on_hand, 0, s.camera);
    s.X_MeasureBoard = place(X_CarrierBoard_, !spec_.on_hand, 6, s.board);
    const auto value = [&](std::size_t i) {
      return parameters_[i].nominal + (correction.empty() ? 0.0 : correction[i]);
    };
    for (std::size_t k = 0; k < lens_size; ++k) s.lens[k] = value(poses + k);
    s.scale = value(scale_at);
    return s;
  }

  CameraMeasurement spec_;
  Eigen::Isometry3d X_CarrierCamera_, X_CarrierBoard_;
  std::vector<Eigen::Vector3d> points_;  // board frame
  double repeats_;
};

}  // namespace

Eigen::Vector3d line_of_sight(const CameraMeasurement& camera, const Eigen::Vector2d& pixel) {
  const Lens lens = lens_of(camera);
  const Eigen::Vector3d straight((pixel.x() - lens[2]) / lens[0], (pixel.y() - lens[3]) / lens[1], 1);
  Eigen::Vector3d p = straight;
  Eigen::Vector2d found;
  for (int step = 0; step < 20; ++step) {
    project(p.data(), lens.data(), found.data());
    if ((found - pixel).norm() < 1e-9) return p;
    p.head<2>() += by_point(p, lens).leftCols<2>().fullPivLu().solve(pixel - found);
  }
  project(p.data(), lens.data(), found.data());
  return p.allFinite() && (found - pixel).norm() < 1e-6 ? p : straight;
}

InstrumentView view_of(const CameraMeasurement& camera) {
  InstrumentView view;
  view.image = InstrumentView::Image{camera.width, camera.height, {}};
  for (const Eigen::Vector2d& corner :
       {Eigen::Vector2d(0, 0), Eigen::Vector2d(camera.width, 0), Eigen::Vector2d(camera.width, camera.height),
        Eigen::Vector2d(0, camera.height)})
    view.image->corners.push_back(line_of_sight(camera, corner));
  view.has_places = true;
  view.places = {{{"camera", camera.camera}, "camera", "the camera"}};
  view.places_on_tip = camera.on_hand;
  view.points_on_tip = !camera.on_hand;
  view.points_at = camera.board;
  view.points_parameters = "board";
  view.axis = Eigen::Vector3d::UnitZ();
  view.half_angle = std::atan(0.5 * std::min(camera.width / camera.fx, camera.height / camera.fy));
  for (int r = 0; r < camera.rows; ++r)
    for (int c = 0; c < camera.columns; ++c)
      view.points.push_back({"point " + std::to_string(r + 1) + "," + std::to_string(c + 1),
                             {c * camera.spacing, r * camera.spacing, 0},
                             {}});
  return view;
}

std::unique_ptr<MeasurementModel> model_of(const CameraMeasurement&, const MeasurementSpec& spec) {
  return std::make_unique<CameraModel>(spec);
}

}  // namespace posewright
