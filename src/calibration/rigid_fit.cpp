#include "posewright/calibration/rigid_fit.hpp"

#include <cmath>
#include <stdexcept>

#include "posewright/support/dense.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

// Second largest spread of the points over the largest: below this they are in a line.
constexpr double flat = 1e-6;

Eigen::Matrix3Xd columns_of(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Matrix3Xd columns(3, Eigen::Index(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) columns.col(Eigen::Index(i)) = points[i];
  return columns;
}

}  // namespace

RigidFit rigid_fit(const std::vector<Eigen::Vector3d>& body, const std::vector<Eigen::Vector3d>& measured) {
  if (body.size() != measured.size()) throw std::invalid_argument("rigid_fit: as many points on both sides");
  const Eigen::Matrix3Xd from = columns_of(body), to = columns_of(measured);
  const Eigen::Matrix3Xd centred = from.colwise() - Eigen::Vector3d(from.rowwise().mean());
  const Eigen::JacobiSVD<Eigen::MatrixXd> spread(centred);
  if (body.size() < 3 || !(spread.singularValues()[1] > flat * spread.singularValues()[0]))
    throw CannotDo("a pose needs three points that are not in a line");
  RigidFit fit;
  // As matrices of any size, which are decomposed elsewhere already.
  fit.X.matrix() = Eigen::umeyama(Eigen::MatrixXd(from), Eigen::MatrixXd(to), false);
  const Eigen::Matrix3Xd placed = (fit.X.linear() * from).colwise() + fit.X.translation();
  fit.rms = std::sqrt((to - placed).colwise().squaredNorm().mean());
  // A twist (v, ω) about the body's origin moves a point at lever l by v + ω × l.
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
  for (const Eigen::Vector3d& point : body) {
    const Eigen::Vector3d l = fit.X.linear() * point;
    Eigen::Matrix<double, 3, 6> rows;
    rows << Eigen::Matrix3d::Identity(),
        (Eigen::Matrix3d() << 0, l.z(), -l.y(), -l.z(), 0, l.x(), l.y(), -l.x(), 0).finished();
    information += rows.transpose() * rows;
  }
  fit.covariance = information.llt().solve(Eigen::Matrix<double, 6, 6>::Identity());
  return fit;
}

}  // namespace posewright
