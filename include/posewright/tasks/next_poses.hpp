#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "posewright/lists/pose_list.hpp"
#include "posewright/problem/problem.hpp"
#include "posewright/results/next.hpp"
#include "posewright/support/monitor.hpp"
#include "posewright/workspace/candidates.hpp"

namespace posewright {

/// Candidates that were drawn for an earlier call, so that a later one need not draw them.
struct KeptCandidates {
  Configurations configurations;
  int asked = 0;            ///< how many were to be drawn
  bool calibrated = false;  ///< drawn after a fit, where the robot really stands
};

struct NextOptions {
  std::filesystem::path data;         ///< names `text` in messages
  std::optional<std::string> text{};  ///< measured data, whole lines; none: nothing yet
  std::string measured_file() const { return text ? data.string() : std::string(); }
  std::string variant, criterion;     ///< empty: as in the problem; criterion: see NextPoses::criterion
  int poses = 1;                      ///< wanted
  std::optional<double> required{};   ///< error at the test poses, m; none: design: require: accuracy
  Prior prior = Prior::manufactured;  ///< tolerances that count, as in a calibration
  std::optional<int> candidates{};
  std::optional<PoseList> candidates_from{};  ///< choose among these; none: as in the problem
  std::shared_ptr<const KeptCandidates> kept{};
  std::uint64_t seed = 0;
  int threads = 0;
};

inline constexpr int poses_looked_ahead = 3;

/// Estimates the parameters from the measured data, then chooses the poses that add most to them, at the estimated
/// values and with the smooth effect of the residuals; reports their gain and whether they are needed.
/// Data that do not suffice for an estimate count by its poses alone, at the nominal values.
/// Throws InputError as the reading of problem, data and lists does, and for rows that are far from where a fit of the
/// rows before them says; CannotDo as make_study().
NextPoses next_poses(const Problem& problem, const NextOptions& options, const Monitor& monitor);

}  // namespace posewright
