#pragma once

#include <memory>

#include "posewright/model/instrument_view.hpp"
#include "posewright/model/measurement_model.hpp"
#include "posewright/model/tip_model.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

// One row an instrument: its model of a tip that is looked at. A new one is one file and one row.
std::unique_ptr<MeasurementModel> model_of(const PoseMeasurement& pose, const MeasurementSpec& spec);
std::unique_ptr<MeasurementModel> model_of(const PointsMeasurement& points, const MeasurementSpec& spec);
/// Null without anchors: no single tip is looked at (DistancePairModel).
std::unique_ptr<MeasurementModel> model_of(const DistanceMeasurement& distance, const MeasurementSpec& spec);
std::unique_ptr<MeasurementModel> model_of(const PlaneMeasurement& plane, const MeasurementSpec& spec);
std::unique_ptr<MeasurementModel> model_of(const LineMeasurement& line, const MeasurementSpec& spec);
std::unique_ptr<MeasurementModel> model_of(const InclinationMeasurement& inclination, const MeasurementSpec& spec);
std::unique_ptr<MeasurementModel> model_of(const CameraMeasurement& camera, const MeasurementSpec& spec);
/// @param spec  members have targets that stand for the tool, all or none
std::unique_ptr<MeasurementModel> model_of(const TogetherMeasurement& together, const MeasurementSpec& spec);

/// The instrument of a robot whose redundant joint sensors are read. Throws CannotDo for a robot without them,
/// InputError for a sensor that it has not.
std::unique_ptr<IdentificationModel> joint_sensor_model(std::unique_ptr<TipModel> tip, const MeasurementSpec& spec,
                                                        const ProblemFile& file);

// What it looks at, for those that have targets or places.
InstrumentView view_of(const PoseMeasurement& pose);
InstrumentView view_of(const PointsMeasurement& points);
InstrumentView view_of(const DistanceMeasurement& distance);
InstrumentView view_of(const PlaneMeasurement& plane);
InstrumentView view_of(const LineMeasurement& line);
InstrumentView view_of(const CameraMeasurement& camera);

/// Variance of one distance reading d: (sigma + sigma_per_m d)²/repeats.
double distance_variance(const DistanceMeasurement& spec, double d, double repeats);
/// True if the instrument can span d; distances under a micrometre have no direction.
bool spans(const DistanceMeasurement& spec, double d);
/// Margins of one distance's range: their number, and values (IdentificationModel::measurable_margins()).
int span_margins(const DistanceMeasurement& spec);
void span_margins_at(const DistanceMeasurement& spec, double d, std::span<double> out);

/// Line of sight (z = 1) whose image is the pixel, by Newton's iteration from where it would be without distortion;
/// what is beyond the reach of the lens's polynomial stays there.
Eigen::Vector3d line_of_sight(const CameraMeasurement& camera, const Eigen::Vector2d& pixel);

}  // namespace posewright
