#pragma once

#include <optional>
#include <string>
#include <vector>

#include "posewright/results/calibration.hpp"
#include "posewright/tasks/calibrate_problem.hpp"

namespace posewright {

/// The poses of a calibration and what they are judged at.
struct CalibratedPoses {
  const MeasurementSpec& measurement;
  const IdentificationModel& model;
  const VariantColumns& columns;
  const std::vector<MeasuredPose>&fitted, &held_back;
  const std::vector<double>& placed;  ///< corrections with base, tool and nuisance alone
};

/// Residuals by unit and by axis with nominal, placed and calibrated parameters, pose by pose, and for poses that were
/// not fitted what the covariance of the estimate had predicted. Fills `residuals`, `axes`, `pose_residuals`.
void fill_accuracy(const CalibratedPoses& poses, const RequirementSpec& require, Calibration& result);

/// The compensator's constants from the listed compliances and their covariance; nothing, with a note, if one of them
/// was not estimated.
void fill_compensator(const ElastostaticSpec& spec, Calibration& result);

/// Says whether the estimate is to be used: fills verdict and refusals, adds a note where no gain is shown.
void judge_calibration(const CalibratedPoses& poses, Calibration& result);

/// A frame that moved while its poses were read; empty without one.
std::string note_of_step(const std::optional<FrameStep>& step);

/// Displacements of every visit that the estimate counts though nobody stated them; empty without.
std::string note_of_visits(const std::optional<VisitErrors>& visits);

/// A stated repeatability that the readings contradict, with what they show.
std::string note_of_contradiction(const VisitErrors& visits);

/// Instruments that count with a larger noise than stated, and those whose readings make predictions of the others'
/// poses worse; empty without.
std::string note_of_instruments(const std::vector<InstrumentResiduals>& instruments);

}  // namespace posewright
