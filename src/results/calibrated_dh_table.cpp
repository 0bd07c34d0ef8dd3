#include "posewright/results/calibrated_dh_table.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "posewright/model/variant_columns.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/table.hpp"

namespace posewright {
namespace {

using Json = nlohmann::ordered_json;

/// Six decimals, no negative zero.
std::string decimals(double value) { return fmt::format("{:.6f}", std::round(value * 1e6) / 1e6 + 0.0); }
std::string in_mm(double length) { return decimals(1e3 * length); }
std::string in_deg(double angle) { return decimals(angle * 180 / std::numbers::pi); }

std::string frame_text(const std::string& name, const Eigen::Isometry3d& X) {
  const Eigen::Matrix3d& R = X.linear();
  const Eigen::Vector3d rpy(std::atan2(R(2, 1), R(2, 2)), std::atan2(-R(2, 0), std::hypot(R(0, 0), R(1, 0))),
                            std::atan2(R(1, 0), R(0, 0)));
  const Eigen::Vector3d& p = X.translation();
  return fmt::format("{}: xyz {} {} {} mm, rpy {} {} {} deg\n", name, in_mm(p.x()), in_mm(p.y()), in_mm(p.z()),
                     in_deg(rpy.x()), in_deg(rpy.y()), in_deg(rpy.z()));
}

Json frame_json(const Eigen::Isometry3d& X) {
  const Eigen::Quaterniond q(X.linear());
  const Eigen::Vector3d p = X.translation();
  return {{"position", {p.x(), p.y(), p.z()}}, {"quaternion_xyzw", {q.x(), q.y(), q.z(), q.w()}}};
}

}  // namespace

std::vector<CalibratedValue> estimated_values(const Calibration& calibration) {
  std::vector<CalibratedValue> values;
  for (const EstimatedValue& estimated : calibration.values) values.push_back(estimated.value);
  return values;
}

std::optional<DhTable> dh_table_of(const Problem& problem, const Calibration& calibration,
                                   std::optional<DhConvention> convention) {
  if (!convention) return std::nullopt;
  const auto* arm = std::get_if<SerialArmSpec>(&problem.robot);
  if (arm == nullptr) throw InputError({}, "a Denavit-Hartenberg table is for serial arms", "robot: urdf");
  return dh_table(*arm, problem.at(arm->line), find_variant(problem, calibration.variant).convention,
                  estimated_values(calibration), *convention);
}

std::string dh_table_text(const DhTable& table) {
  std::string text = table.convention == DhConvention::distal
                         ? "Denavit–Hartenberg parameters (distal): Rz(theta) Tz(d) Tx(a) Rx(alpha) Ry(beta)\n"
                         : "Denavit–Hartenberg parameters (modified): Tx(a) Rx(alpha) Ry(beta) Rz(theta) Tz(d)\n";
  text += "The reading adds to theta, of a prismatic joint to d.\n";
  Table rows({"joint", "", "theta [deg]", "d [mm]", "a [mm]", "alpha [deg]", "beta [deg]"}, "llr");
  for (const DhRow& row : table.rows)
    rows.row({row.joint, row.prismatic ? "prismatic" : "", in_deg(row.theta), in_mm(row.d), in_mm(row.a),
              in_deg(row.alpha), row.beta ? in_deg(*row.beta) : ""});
  text += rows.text();
  text += frame_text("base link in the measurement frame", table.X_MeasureBase);
  text += frame_text("first axis in the base link", table.X_BaseFirst);
  text += frame_text("tip in the last frame", table.X_LastTip);
  for (const std::string& left_out : table.left_out) text += "Not in the table: " + left_out + "\n";
  return text;
}

Json dh_table_json(const DhTable& table) {
  Json json = {{"convention", table.convention == DhConvention::distal ? "dh" : "mdh"},
               {"base", frame_json(table.X_MeasureBase)},
               {"first_axis", frame_json(table.X_BaseFirst)},
               {"rows", Json::array()},
               {"tip", frame_json(table.X_LastTip)},
               {"left_out", table.left_out}};
  for (const DhRow& row : table.rows)
    json["rows"].push_back({{"joint", row.joint},
                            {"prismatic", row.prismatic},
                            {"theta", row.theta},
                            {"d", row.d},
                            {"a", row.a},
                            {"alpha", row.alpha},
                            {"beta", row.beta ? Json(*row.beta) : Json(nullptr)}});
  return json;
}

}  // namespace posewright
