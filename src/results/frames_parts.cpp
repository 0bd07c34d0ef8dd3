#include <fmt/format.h>

#include "calibration_parts.hpp"
#include "posewright/outputs/table.hpp"

namespace posewright {
namespace {

/// Quaternion of a rotation with qw ≥ 0.
Eigen::Quaterniond quaternion_of(const Eigen::Isometry3d& X) {
  Eigen::Quaterniond q(X.linear());
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  return q;
}

}  // namespace

std::string frames_text(const Calibration& c) {
  if (c.frames.empty()) return "";
  using A = Table::Align;
  Table table({"frame", "in the frame of", "x [mm]", "y [mm]", "z [mm]", "qx", "qy", "qz", "qw"},
              {A::left, A::left, A::right, A::right, A::right, A::right, A::right, A::right, A::right});
  for (const PlacedFrame& frame : c.frames) {
    const Eigen::Quaterniond q = quaternion_of(frame.X);
    std::vector<std::string> cells = {frame.name, frame.on_tip ? "the tip" : "the measurement"};
    for (const double p : frame.X.translation()) cells.push_back(fmt::format("{:.4f}", 1e3 * p));
    for (const double part : {q.x(), q.y(), q.z(), q.w()}) cells.push_back(fmt::format("{:.8f}", part));
    table.row(cells);
  }
  return "\nEstimated position and orientation of frames\n" + table.text();
}

nlohmann::ordered_json frames_json(const Calibration& c) {
  auto list = nlohmann::ordered_json::array();
  for (const PlacedFrame& frame : c.frames) {
    const Eigen::Vector3d p = frame.X.translation();
    const Eigen::Quaterniond q = quaternion_of(frame.X);
    list.push_back({{"name", frame.name},
                    {"in", frame.on_tip ? "tip" : "measurement"},
                    {"position", {p.x(), p.y(), p.z()}},
                    {"quaternion_xyzw", {q.x(), q.y(), q.z(), q.w()}}});
  }
  return list;
}

}  // namespace posewright
