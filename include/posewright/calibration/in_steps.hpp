#pragma once

#include <string>
#include <vector>

#include "posewright/calibration/fit.hpp"

namespace posewright {

/// One step of an identification in steps.
struct IdentificationStep {
  std::string name;    ///< "base and tool", "geometry", "stiffness"
  int columns = 0;     ///< estimated in it
  double scale = 0.0;  ///< √(χ²/readings) after it: residuals in units of the stated noise
};

/// Successive estimates, each with the earlier ones held fixed.
struct StepwiseFit {
  std::vector<IdentificationStep> steps;
  std::vector<double> correction;  ///< of all parameters of the model, after the last step
  int rounds = 0;                  ///< how often the steps were gone through
  bool settled = false;            ///< another round changes nothing worth mentioning
};

/// Groups of parameters: base, tool, targets and nuisance, then geometry, then stiffness (compliances,
/// stiffnesses): Klimchik et al. (2013), section III, gone through again until no parameter moves by more than a
/// thousandth of its σ in the joint fit. Steps without columns are left out.
/// @param columns  columns of the joint fit
/// Throws CannotDo if one step cannot be estimated.
StepwiseFit fit_in_steps(const IdentificationModel& model, const VariantColumns& columns,
                         const std::vector<MeasuredPose>& poses, const FitOptions& options, const Fit& joint);

}  // namespace posewright
