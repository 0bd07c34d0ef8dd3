#pragma once

#include <string>
#include <vector>

#include "posewright/calibration/fit.hpp"
#include "posewright/calibration/orientation_form.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

/// A convention that the file does not keep, as one of a table of hypotheses.
struct Convention {
  std::string condition;  ///< hypothesis: "joint_5 counts the other way"
  std::string remedy;     ///< line for the problem file or the readings' file
  double left = 0.0;      ///< residual with base and tool alone, m
};

/// Residuals of a robot's poses and its instrument's readings with base and tool alone fitted.
struct ConventionSearch {
  double left = 0.0;              ///< root mean square distance as the file is read, m
  std::vector<Convention> found;  ///< empty: no convention explains it
};

/// Fits hand_eye() under each hypothesis. Named are those that leave less than a tenth, and less than
/// twice as much as the best; of several with one remedy the first of the table. Poses and points in space and pictures
/// of a board are judged, of one station and one campaign; of other instruments nothing is found.
/// @param form  how the file of readings wrote its orientations
ConventionSearch find_conventions(const Problem& problem, const IdentificationModel& model,
                                  const std::vector<MeasuredPose>& poses, const OrientationForm& form);

}  // namespace posewright
