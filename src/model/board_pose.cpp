#include "posewright/model/board_pose.hpp"

#include <vector>

#include "instruments.hpp"
#include "posewright/support/dense.hpp"

namespace posewright {
namespace {

/// A plane's point and the line of sight (z = 1) on which it is seen.
struct PlanePoint {
  Eigen::Vector2d at, seen;
};

std::vector<PlanePoint> points_read(const CameraMeasurement& camera, const Eigen::VectorXd& pixels) {
  std::vector<PlanePoint> points;
  for (int i = 0; i < camera.rows * camera.columns; ++i) {
    const Eigen::Vector2d pixel = pixels.segment<2>(2 * i);
    if (!pixel.allFinite()) continue;
    const Eigen::Vector2d at = camera.spacing * Eigen::Vector2d(i % camera.columns, i / camera.columns);
    points.push_back({at, line_of_sight(camera, pixel).head<2>()});
  }
  return points;
}

/// seen ~ H (x, y, 1), by the direct linear transformation.
Eigen::Matrix3d homography(const std::vector<PlanePoint>& points, double unit) {
  Eigen::MatrixXd rows(2 * Eigen::Index(points.size()), 9);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::RowVector3d p(points[i].at.x() / unit, points[i].at.y() / unit, 1);
    const Eigen::RowVector3d none = Eigen::RowVector3d::Zero();
    rows.row(2 * Eigen::Index(i)) << p, none, -points[i].seen.x() * p;
    rows.row(2 * Eigen::Index(i) + 1) << none, p, -points[i].seen.y() * p;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(Eigen::MatrixXd(rows.transpose() * rows));
  const Eigen::VectorXd h = solver.eigenvectors().col(0);
  Eigen::Matrix3d H;
  H << h[0], h[1], h[2], h[3], h[4], h[5], h[6], h[7], h[8];
  H.leftCols<2>() /= unit;
  return H;
}

}  // namespace

std::optional<Eigen::Isometry3d> board_pose(const CameraMeasurement& camera, const Eigen::VectorXd& pixels) {
  const std::vector<PlanePoint> points = points_read(camera, pixels);
  if (points.size() < 4) return std::nullopt;
  Eigen::Matrix3d H = homography(points, camera.spacing);
  H /= 0.5 * (H.col(0).norm() + H.col(1).norm());
  if (H(2, 2) < 0) H = -H;  // in front of the camera
  Eigen::Matrix3d R;
  R << H.col(0), H.col(1), H.col(0).cross(H.col(1));
  if (!R.allFinite()) return std::nullopt;
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(Eigen::MatrixXd(R), Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() = svd.matrixU() * svd.matrixV().transpose();
  X.translation() = H.col(2);
  return X;
}

}  // namespace posewright
