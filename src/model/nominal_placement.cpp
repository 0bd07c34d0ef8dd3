#include "posewright/model/nominal_placement.hpp"

#include <algorithm>

#include "displacement.hpp"

namespace posewright {
namespace {

double nominal_or(const std::vector<Parameter>& parameters, const std::string& name, double value) {
  const auto found = std::ranges::find(parameters, name, &Parameter::name);
  return found == parameters.end() ? value : found->nominal;
}

}  // namespace

Eigen::Isometry3d nominal_placement(const std::vector<Parameter>& parameters, const std::string& name,
                                    const Eigen::Isometry3d& X) {
  std::vector<Parameter> undisplaced;
  append_displacement(undisplaced, name, X, 0, 0);
  std::array<double, 6> change{};
  for (std::size_t k = 0; k < change.size(); ++k)
    change[k] = nominal_or(parameters, undisplaced[k].name, undisplaced[k].nominal) - undisplaced[k].nominal;
  Frame<double> frame = frame_of(X);
  displace(frame, change.data());
  return isometry_of(frame);
}

Eigen::Vector3d nominal_position(const std::vector<Parameter>& parameters, const std::string& name,
                                 const Eigen::Vector3d& p) {
  return {nominal_or(parameters, name + ".x", p.x()), nominal_or(parameters, name + ".y", p.y()),
          nominal_or(parameters, name + ".z", p.z())};
}

}  // namespace posewright
