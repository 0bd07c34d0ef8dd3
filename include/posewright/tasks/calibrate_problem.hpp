#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "posewright/problem/problem.hpp"
#include "posewright/results/calibration.hpp"
#include "posewright/support/monitor.hpp"

namespace posewright {

/// Parameters whose intervals are by profile (posewright::Profile): those that the curvature names, none, or those that
/// these names and globs match.
struct ProfileChoice {
  enum Choice { automatic, none, named };
  Choice choice = automatic;
  std::vector<std::string> names{};
};
/// From what a user wrote: auto, none, all, or names and globs with commas between them. Throws InputError for an empty
/// name.
ProfileChoice profile_choice(const std::string& text);

/// Frame that moved before each further campaign: the base (where the instrument stands), the tool (all that the tip
/// carries: tool, targets, a camera or board), both, or nothing. automatic: the base, and the tool if the residuals ask
/// for it.
enum class Moved { automatic, base, tool, both, nothing };
/// By its word: auto, base, tool, both, nothing. Throws InputError for another one.
Moved moved_between(const std::string& text);

struct CalibrateOptions : MeasuredFiles {
  std::optional<std::string> text{};  ///< of `data`, if the file is not to be read: it holds more than counts
  Moved moved = Moved::automatic;     ///< between campaigns
  std::string variant;                ///< empty: as in the file
  Weighting weighting = Weighting::weighted;
  /// Use of manufacturing and stated tolerances as prior knowledge; none: plain least squares.
  Prior prior = Prior::manufactured;
  std::filesystem::path validate;  ///< more data that are not fitted; empty: none
  int hold_back = 0;               ///< every so many-th pose is not fitted; 0: none
  bool in_steps = false;           ///< identify base and tool, geometry, stiffness one after the other, too
  bool estimate_alone = false;     ///< the estimate and the smooth effect that the residuals show, no other judgement
  ProfileChoice profile{};
  bool interpolate = false;  ///< add interpolated residuals to predictions: a variant with `unmodelled`
  int threads = 0;           ///< 0: all
};

/// Estimates the parameters of a variant from measured data. Columns that the data do not determine stay at their
/// nominal values and are listed. Throws InputError (files) and CannotDo (nothing can be estimated).
Calibration calibrate_problem(const Problem& problem, const CalibrateOptions& options, const Monitor& monitor);

}  // namespace posewright
