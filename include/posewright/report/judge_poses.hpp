#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "posewright/problem/problem.hpp"
#include "posewright/report/report.hpp"
#include "posewright/support/monitor.hpp"

namespace posewright {

/// A pose that a reader has moved, as the page of the plan shows its poses.
struct JudgedPose {
  PlannedPose pose;                     ///< id: 1, 2, … in the list
  std::string reason;                   ///< that forbids it; empty: feasible
  ReportKeyframe drawn;                 ///< empty for a robot that is not drawn
  Eigen::MatrixXd information;          ///< JᵀJ, as ReportInformation::poses; empty: the robot cannot stand there
  std::vector<Eigen::Vector2d> pixels;  ///< as ReportCamera::pictures; empty without a camera
};

/// Poses of a list, and between which values a reader may move them.
struct JudgedPoses {
  struct Range {
    int index = 0;  ///< among the coordinates that are written of a pose
    double lower = 0.0, upper = 0.0;
  };
  std::vector<Range> ranges;  ///< of continuous coordinates
  std::vector<JudgedPose> poses;
};

/// Judges each pose of a list by itself: the checks of `evaluate`, clearance, sights, picture, and the information on
/// the columns of the plan's first variant. Draws no candidates.
/// @param plan  written plan of this problem
/// @param list  as read_poses() reads it
/// Throws InputError for a plan or list that does not fit the problem, CannotDo where the monitor stops it.
JudgedPoses judge_poses(const Problem& problem, const std::filesystem::path& plan, const std::filesystem::path& list,
                        const Monitor& monitor);

/// Schema posewright/judged-poses/1 (docs/report.md).
std::string report_json(const JudgedPoses& judged);
/// A line a pose.
std::string judged_text(const JudgedPoses& judged);

}  // namespace posewright
