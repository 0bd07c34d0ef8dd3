#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "posewright/calibration/fit.hpp"
#include "posewright/study/expected_error.hpp"
#include "posewright/study/forecast.hpp"
#include "posewright/study/study.hpp"
#include "posewright/tasks/calibrate_problem.hpp"
#include "posewright/tasks/next_poses.hpp"

namespace posewright {

/// Estimate of a robot from the measured poses.
struct NextFit {
  Problem problem;  ///< at the estimated values, with the effect that the residuals show
  std::vector<MeasuredPose> poses;
  std::vector<int> lines;  ///< of the file, of each pose
  int readings = 0;        ///< single ones that were read
  bool fitted = false;     ///< else at nominal values
  ForecastNoise noise;
  FittedResiduals residuals;
  double scale = 1.0, freedom = 0.0;  ///< of the residuals, in units of the stated noise
  std::optional<CalibratedEffect> effect{};
  std::vector<EstimatedValue> estimates{};
  std::vector<std::string> notes{};
};

/// Throws InputError with the file's line for what cannot be read, and for a pose that is so far from where the fit of
/// those before it says that it is no reading of this robot.
NextFit fit_so_far(const Problem& problem, const NextOptions& options, const Monitor& monitor);

/// All that searches and forecasts of next poses begin with: the fit so far, and the study at its values. At nominal
/// values if the readings do not tell all parameters.
class KnownSoFar {
 public:
  /// `problem` and `options` must outlive it. Throws as next_poses().
  KnownSoFar(const Problem& problem, const NextOptions& options, const Monitor& monitor);

  const NextFit& fit() const { return fit_; }
  /// With test points, unless the robot has no tip.
  const Study& study() const { return study_; }
  const Variant& variant() const { return study_.first(); }
  /// As problem or options state it; o1 where nobody does, or until the readings let another be chosen.
  const std::string& criterion() const { return criterion_; }
  bool criterion_automatic() const { return automatic_; }
  const std::vector<PoseRows>& rows() const { return rows_; }
  /// Null if a list of candidates was given.
  const std::shared_ptr<const KeptCandidates>& kept() const { return kept_; }
  /// True if the test points are the problem's.
  bool places_stated() const { return places_stated_; }
  int columns() const { return int(study_.first().columns.selected.size()); }
  /// Number of columns that the readings determine without tolerances.
  int told() const { return told_; }
  bool determined() const { return told_ == columns(); }

 private:
  void prepare();
  void name_criterion();
  Study made();
  void reuse_candidates(const Setup& setup);
  Study with_places(Study study);
  int rank_of_readings() const;
  const VariantSpec& nominal_spec() const { return find_variant(nominal_, options_.variant); }

  const Problem& nominal_;
  const NextOptions& options_;
  const Monitor& monitor_;
  NextFit fit_;
  std::string criterion_;
  bool automatic_ = false;
  Study study_;
  std::shared_ptr<const KeptCandidates> kept_;
  std::vector<PoseRows> rows_;
  int told_ = 0;
  bool places_stated_ = false;
};

}  // namespace posewright
