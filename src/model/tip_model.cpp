#include "posewright/model/tip_model.hpp"

#include <algorithm>
#include <stdexcept>

namespace posewright {

HarmonicColumns TipModel::harmonic_columns(std::span<const int>, std::span<const double>) const {
  return {"columns of this robot that are no polynomials of the joints' cosines and sines", {}, {}, {}};
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
