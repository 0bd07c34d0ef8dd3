#include "orientation_columns.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "posewright/model/rotation_vector.hpp"

namespace posewright {
namespace {

// Printed quaternions have few digits; anything farther from one is something else.
constexpr double unit_slack = 1e-3;

std::vector<std::string> columns_of(const std::string& prefix, std::initializer_list<const char*> ends) {
  std::vector<std::string> columns;
  for (const char* end : ends) columns.push_back(prefix + "." + end);
  return columns;
}

}  // namespace

Eigen::Matrix3d rotation_of_quaternion(const Eigen::Vector4d& quaternion, const SourcePlace& place) {
  if (std::abs(quaternion.norm() - 1) > unit_slack)
    throw InputError(place, fmt::format("the quaternion has length {:.6g}", quaternion.norm()), "1 is expected");
  return Eigen::Quaterniond(Eigen::Vector4d(quaternion.normalized())).toRotationMatrix();
}

OrientationColumns::OrientationColumns(const std::string& prefix, const std::vector<std::string>& names,
                                       const SourcePlace& header) {
  const auto has = [&](const std::string& name) { return std::find(names.begin(), names.end(), name) != names.end(); };
  const auto consider = [&](const OrientationForm& form, std::vector<std::string> columns) {
    if (!std::all_of(columns.begin(), columns.end(), has)) return;
    if (found())
      throw InputError(header, "has an orientation twice, " + columns_.front() + " and " + columns.front(),
                       "one of them");
    form_ = form;
    columns_ = std::move(columns);
  };
  consider({OrientationForm::vector}, columns_of(prefix, {"rx", "ry", "rz"}));
  consider({OrientationForm::quaternion}, columns_of(prefix, {"qx", "qy", "qz", "qw"}));
  for (const bool moving : {false, true})
    for (int code = 0; code < 27; ++code) {
      const EulerTurns turns{moving, {code / 9, code / 3 % 3, code % 3}};
      if (turns.axes[0] == turns.axes[1] || turns.axes[1] == turns.axes[2]) continue;
      consider({OrientationForm::angles, turns}, columns_of(prefix + "." + turns.name(), {"1", "2", "3"}));
    }
}

std::optional<Eigen::Matrix3d> OrientationColumns::rotation(
    const std::function<double(const std::string&, const std::string&)>& value, const SourcePlace& row) const {
  const bool quaternion = form_.kind == OrientationForm::quaternion;
  Eigen::VectorXd v(Eigen::Index(columns_.size()));
  for (std::size_t k = 0; k < columns_.size(); ++k) v[Eigen::Index(k)] = value(columns_[k], quaternion ? "1" : "rad");
  if (!v.allFinite()) return std::nullopt;
  if (form_.kind == OrientationForm::angles) return form_.turns.rotation(v);
  if (!quaternion) return rotation_by(v);
  return rotation_of_quaternion(v, row);
}

}  // namespace posewright
