#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "posewright/tasks/next_poses.hpp"
#include "posewright/tasks/next_state.hpp"

namespace posewright {

/// Text for the terminal: state of the calibration, verdict, the next poses in deg and mm.
std::string next_text(const NextPoses& result);
/// Verdict and reason, in a sentence or two.
std::string next_reason(const NextPoses& result);
/// "reached", …
std::string verdict_name(NextVerdict verdict);

/// Schema posewright/next/1, SI.
/// @param history  earlier verdicts with their numbers of poses; empty: none
nlohmann::ordered_json next_json(const Problem& problem, const NextOptions& options, const NextPoses& result,
                                 const std::vector<NextPoint>& history = {});

/// One line for each pose, as a plan's pose list.
std::string next_csv(const NextPoses& result);

}  // namespace posewright
