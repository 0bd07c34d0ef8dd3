#include "posewright/model/tip_model.hpp"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "posewright/model/rotation_vector.hpp"

namespace posewright {

namespace {

// Step of the central differences in units of a coordinate's range: their error is about its square.
constexpr double tip_difference_step = 1e-5;

/// Spatial twist from one pose of the tip to another near it.
Twist twist_between(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to) {
  Twist twist;
  const Eigen::Vector3d turn = rotation_vector(to.linear() * from.linear().transpose());
  const Eigen::Vector3d middle = 0.5 * (from.translation() + to.translation());
  twist << to.translation() - from.translation() - turn.cross(middle), turn;
  return twist;
}

}  // namespace

bool TipModel::pull_back(const Point& at, std::span<const int> selected, const TipAdjoint& f,
                         std::span<double> gradient) const {
  static thread_local Twists twists[2], readings[2];
  const bool with_readings = f.reading_twists.cols() > 0;
  std::vector<double> q(at.q.begin(), at.q.end());
  Point near = at;
  near.q = q;
  for (std::size_t k = 0; k < coordinates_.size(); ++k) {
    if (coordinates_[k].choice()) continue;
    const double step = tip_difference_step * (coordinates_[k].upper - coordinates_[k].lower);
    if (!(step > 0)) continue;
    Eigen::Isometry3d X[2];
    for (const int side : {0, 1}) {
      q[k] = at.q[k] + (side == 0 ? -step : step);
      if (!linearise(near, selected, X[side], twists[side], with_readings ? &readings[side] : nullptr)) return false;
    }
    q[k] = at.q[k];
    double change = f.tip.dot(twist_between(X[0], X[1])) + f.twists.cwiseProduct(twists[1] - twists[0]).sum();
    if (with_readings) change += f.reading_twists.cwiseProduct(readings[1] - readings[0]).sum();
    gradient[k] += change / (2 * step);
  }
  return true;
}

HarmonicColumns TipModel::harmonic_columns(std::span<const int>, const Point&) const {
  return {"columns of this robot that are no polynomials of the joints' cosines and sines", {}, {}, {}};
}

bool TipModel::linearise_bent(const Point& at, double, std::span<const int> selected, Eigen::Isometry3d& X,
                              Twists& twists) const {
  return linearise(at, selected, X, twists, nullptr);
}

int TipModel::offset_of(int) const { return -1; }

bool TipModel::enclose_residual(std::span<const TaylorModel>, std::span<const double>, std::span<const int>,
                                EnclosedResidual&) const {
  return false;
}

void TipModel::take_loads_at(std::span<const double>) {}

bool TipModel::actuator_values(const Point&, std::span<double>) const { return true; }

std::vector<Polyline> TipModel::skeleton(std::span<const double>) const { return {}; }

bool TipModel::sensor_rows(const Point&, std::span<const int>, Eigen::MatrixXd&, Eigen::MatrixXd&) const {
  throw std::logic_error("this robot has no redundant joint sensors");
}

bool TipModel::sensor_values(const Point&, Eigen::VectorXd&) const {
  throw std::logic_error("this robot has no redundant joint sensors");
}

bool TipModel::configuration_at(std::span<const double>, const Point& start, std::span<double> q) const {
  std::copy(start.q.begin(), start.q.end(), q.begin());
  return true;
}

}  // namespace posewright
