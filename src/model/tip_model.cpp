#include "posewright/model/tip_model.hpp"

#include <stdexcept>

namespace posewright {

bool TipModel::actuator_values(std::span<const double>, std::span<const double>, std::span<double>) const {
  return true;
}

std::vector<Polyline> TipModel::skeleton(std::span<const double>) const { return {}; }

bool TipModel::sensor_rows(std::span<const double>, std::span<const double>, std::span<const int>, Eigen::MatrixXd&,
                           Eigen::MatrixXd&) const {
  throw std::logic_error("this robot has no redundant joint sensors");
}

}  // namespace posewright
