#include "posewright/calibration/hand_eye.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "posewright/model/rotation_vector.hpp"
#include "posewright/support/dense.hpp"

namespace posewright {
namespace {

constexpr int most_steps = 10;
constexpr double settled = 1e-6;
// Of the diagonal: directions that nothing tells stay where they are.
constexpr double ridge = 1e-11;

/// One point seen once.
struct Sight {
  const Eigen::Isometry3d* tip;
  Eigen::Vector3d seen;
  Eigen::Index point;
};

/// Least squares with a ridge that keeps what is not determined at zero.
Eigen::VectorXd solve(const Eigen::MatrixXd& rows, const Eigen::VectorXd& right) {
  Eigen::MatrixXd normal = rows.transpose() * rows;
  normal.diagonal().array() += ridge * normal.diagonal().maxCoeff();
  return normal.llt().solve(rows.transpose() * right);
}

class Problem3d {
 public:
  explicit Problem3d(const std::vector<SeenPoints>& seen) {
    for (const SeenPoints& pose : seen)
      for (Eigen::Index k = 0; k < pose.points.cols(); ++k)
        if (pose.points.col(k).allFinite()) sights_.push_back({&pose.tip, pose.points.col(k), k});
    for (const Sight& sight : sights_) points_ = std::max(points_, sight.point + 1);
  }

  HandEye fit(bool free_scale) {
    // The linear start has 12 unknowns besides the points.
    if (3 * sights_.size() < std::size_t(15 + 3 * points_)) return {.rms = std::numeric_limits<double>::infinity()};
    start(free_scale);
    Eigen::VectorXd left = residual();
    for (int step = 0; step < most_steps; ++step) {
      advance(left, free_scale);
      const Eigen::VectorXd next = residual();
      const bool done = std::abs(next.norm() - left.norm()) <= settled * left.norm();
      left = next;
      if (done) break;
    }
    HandEye result{left.norm() / std::sqrt(double(sights_.size())), scale_};
    result.X_BaseInstrument.linear() = A_;
    result.X_BaseInstrument.translation() = -places_.head<3>();
    result.points = places_.tail(3 * points_).reshaped(3, points_);
    return result;
  }

 private:
  Eigen::Index rows() const { return 3 * Eigen::Index(sights_.size()); }

  /// Columns of c and of the points from `first` on.
  void add_places(Eigen::MatrixXd& J, Eigen::Index first) const {
    for (std::size_t i = 0; i < sights_.size(); ++i) {
      const auto row = 3 * Eigen::Index(i);
      J.block<3, 3>(row, first) = -Eigen::Matrix3d::Identity();
      J.block<3, 3>(row, first + 3 + 3 * sights_[i].point) = -sights_[i].tip->linear();
    }
  }

  void start(bool free_scale) {
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(rows(), 12 + 3 * points_);
    Eigen::VectorXd right(rows());
    for (std::size_t i = 0; i < sights_.size(); ++i) {
      const auto row = 3 * Eigen::Index(i);
      for (int a = 0; a < 3; ++a) J.block<1, 3>(row + a, 3 * a) = sights_[i].seen.transpose();
      right.segment<3>(row) = sights_[i].tip->translation();
    }
    add_places(J, 9);
    const Eigen::VectorXd x = solve(J, right);
    Eigen::MatrixXd A(3, 3);
    A << x.segment<3>(0).transpose(), x.segment<3>(3).transpose(), x.segment<3>(6).transpose();
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(A, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Matrix3d U = svd.matrixU();
    const Eigen::Matrix3d V = svd.matrixV();
    if (U.determinant() * V.determinant() < 0) U.col(2) = -U.col(2);
    A_ = U * V.transpose();
    if (free_scale) scale_ = std::max(svd.singularValues()[0], std::numeric_limits<double>::min());
    places_ = x.tail(3 + 3 * points_);
  }

  /// s A p − R t − c − o.
  Eigen::VectorXd residual() const {
    Eigen::VectorXd r(rows());
    for (std::size_t i = 0; i < sights_.size(); ++i) {
      const Sight& sight = sights_[i];
      r.segment<3>(3 * Eigen::Index(i)) = scale_ * (A_ * sight.seen) -
                                          sight.tip->linear() * places_.segment<3>(3 + 3 * sight.point) -
                                          places_.head<3>() - sight.tip->translation();
    }
    return r;
  }

  void advance(const Eigen::VectorXd& left, bool free_scale) {
    const Eigen::Index first = free_scale ? 4 : 3;
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(rows(), first + 3 + 3 * points_);
    for (std::size_t i = 0; i < sights_.size(); ++i) {
      const auto row = 3 * Eigen::Index(i);
      const Eigen::Vector3d turned = scale_ * (A_ * sights_[i].seen);
      for (int k = 0; k < 3; ++k) J.block<3, 1>(row, k) = Eigen::Vector3d::Unit(k).cross(turned);
      if (free_scale) J.block<3, 1>(row, 3) = turned;
    }
    add_places(J, first);
    const Eigen::VectorXd step = solve(J, -left);
    A_ = rotation_by(step.head<3>()) * A_;
    if (free_scale) scale_ *= std::exp(std::clamp(step[3], -1.0, 1.0));
    places_ += step.tail(3 + 3 * points_);
  }

  std::vector<Sight> sights_;
  Eigen::Index points_ = 0;
  Eigen::Matrix3d A_ = Eigen::Matrix3d::Identity();
  double scale_ = 1.0;
  Eigen::VectorXd places_;  ///< c, then the points on the tip
};

}  // namespace

HandEye hand_eye(const std::vector<SeenPoints>& seen, bool free_scale) { return Problem3d(seen).fit(free_scale); }

}  // namespace posewright
