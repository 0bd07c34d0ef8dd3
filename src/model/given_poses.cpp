#include "posewright/model/given_poses.hpp"

#include "displacement.hpp"
#include "posewright/model/placement.hpp"

namespace posewright {
namespace {

// Widest range: more than any robot reaches, m; turns as they may be written, rad.
constexpr double far = 10.0;

constexpr std::array<const char*, 6> coordinate_names = {"robot.x",    "robot.y",     "robot.z",
                                                         "robot.roll", "robot.pitch", "robot.yaw"};

}  // namespace

GivenPoses::GivenPoses(const GivenPosesSpec& spec, const std::vector<CoordinateLimits>& pose_limits)
    : X_MeasureBase_(isometry(spec.placement)), X_TipTool_(isometry(spec.tool)) {
  append_displacement(parameters_, "base", X_MeasureBase_, 10e-3, 1 * degree);
  append_displacement(parameters_, "tool", X_TipTool_, 5e-3, 1 * degree);
  for (int i = 0; i < 12; ++i) geometric_.push_back({i, i < 6 ? 0 : 1});
  for (std::size_t k = 0; k < 6; ++k) {
    const double reach = k < 3 ? far : k == 4 ? std::numbers::pi : 2 * std::numbers::pi;
    coordinates_.push_back(pose_coordinate(coordinate_names[k], k, reach, pose_limits));
  }
}

bool GivenPoses::linearise(const Point& at, std::span<const int> selected, Eigen::Isometry3d& X_MeasureTip,
                           Twists& twists, Twists* reading_twists) const {
  const double* d = at.correction.empty() ? nullptr : at.correction.data();
  // Corrections may end before tool.*.
  const double* t = at.correction.size() < 12 ? nullptr : d + 6;
  Frame<double> frame = frame_of(X_MeasureBase_);
  const DisplacementAxes base = displace(frame, d);
  displace(frame, at.q.data());
  frame.then(X_TipTool_);
  const DisplacementAxes tool = displace(frame, t);
  X_MeasureTip = isometry_of(frame);
  twists.resize(6, Eigen::Index(selected.size()));
  for (std::size_t j = 0; j < selected.size(); ++j) {
    const int i = selected[j];
    auto column = twists.col(Eigen::Index(j));
    if (i < 6) column = base.twist(i);
    else if (i < 12) column = tool.twist(i - 6);
    else column.setZero();
  }
  if (reading_twists != nullptr) reading_twists->resize(6, 0);
  return true;
}

}  // namespace posewright
