#include "posewright/model/tip_model.hpp"

#include <algorithm>
#include <stdexcept>

namespace posewright {

void TipModel::take_loads_at(std::span<const double>) {}

bool TipModel::actuator_values(std::span<const double>, std::span<const double>, std::span<double>) const {
  return true;
}

std::vector<Polyline> TipModel::skeleton(std::span<const double>) const { return {}; }

bool TipModel::sensor_rows(std::span<const double>, std::span<const double>, std::span<const int>, Eigen::MatrixXd&,
                           Eigen::MatrixXd&) const {
  throw std::logic_error("this robot has no redundant joint sensors");
}

bool TipModel::sensor_values(std::span<const double>, std::span<const double>, Eigen::VectorXd&) const {
  throw std::logic_error("this robot has no redundant joint sensors");
}

bool TipModel::configuration_at(std::span<const double>, std::span<const double> start, std::span<const double>,
                                std::span<double> q) const {
  std::copy(start.begin(), start.end(), q.begin());
  return true;
}

}  // namespace posewright
