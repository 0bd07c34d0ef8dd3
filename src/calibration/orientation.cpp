#include "posewright/calibration/orientation.hpp"

#include <array>

#include "posewright/model/placement.hpp"
#include "posewright/support/dense.hpp"

namespace posewright {

std::vector<CalibratedOrientation> orientations(const IdentificationModel& model, const VariantColumns& columns,
                                                const Fit& result, double stretch) {
  const auto parameter = [&](Eigen::Index j) -> const Parameter& {
    return model.parameters()[std::size_t(columns.selected[std::size_t(j)])];
  };
  const auto column = [&](const std::string& name) {
    Eigen::Index j = Eigen::Index(columns.selected.size()) - 1;
    while (j >= 0 && parameter(j).name != name) --j;
    return j;
  };
  std::vector<CalibratedOrientation> found;
  for (Eigen::Index j = 0; j < Eigen::Index(columns.selected.size()); ++j) {
    const std::string& name = parameter(j).name;
    if (!columns.parameters[std::size_t(j)].places || !name.ends_with(".rx")) continue;
    CalibratedOrientation o;
    o.frame = name.substr(0, name.size() - 3);
    const std::array<Eigen::Index, 3> at = {j, column(o.frame + ".ry"), column(o.frame + ".rz")};
    if (at[1] < 0 || at[2] < 0) continue;
    for (int k = 0; k < 3; ++k) o.angles[k] = parameter(at[std::size_t(k)]).nominal + result.change[at[std::size_t(k)]];
    // Small changes of rx, ry, rz turn about axes that the angles after them have turned.
    Eigen::Matrix3d axes;
    axes << rotation_of_rpy({0, o.angles[1], o.angles[2]}).col(0), rotation_of_rpy({0, 0, o.angles[2]}).col(1),
        Eigen::Vector3d::UnitZ();
    o.covariance = axes * result.covariance(at, at) * axes.transpose();
    o.half_width = stretch * o.covariance.diagonal().cwiseSqrt();
    found.push_back(std::move(o));
  }
  return found;
}

}  // namespace posewright
