#include "posewright/model/identification_model.hpp"

#include <stdexcept>

namespace posewright {
namespace {

void require_size(std::size_t given, std::size_t expected, const char* what) {
  if (given != expected)
    throw std::invalid_argument(std::string(what) + ": " + std::to_string(given) + " values instead of " +
                                std::to_string(expected));
}

}  // namespace

bool IdentificationModel::linearise(std::span<const double> q, std::span<const double> correction,
                                    std::span<const int> selected, Linearisation& out) const {
  require_size(q.size(), coordinates_.size(), "configuration");
  if (!correction.empty()) require_size(correction.size(), parameters_.size(), "corrections");
  return do_linearise(q, correction, selected, out);
}

bool IdentificationModel::actuator_values(std::span<const double> q, std::span<double> values) const {
  require_size(q.size(), coordinates_.size(), "configuration");
  require_size(values.size(), actuators_.size(), "actuators");
  return do_actuator_values(q, values);
}

Eigen::Isometry3d IdentificationModel::tool_pose(std::span<const double> q) const {
  require_size(q.size(), coordinates_.size(), "configuration");
  return do_tool_pose(q);
}

bool IdentificationModel::do_actuator_values(std::span<const double>, std::span<double>) const { return true; }

}  // namespace posewright
