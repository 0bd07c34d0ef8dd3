#include "posewright/model/measurement_factory.hpp"

#include <stdexcept>

#include "distance_pair_model.hpp"
#include "instruments.hpp"
#include "posewright/model/campaigns.hpp"
#include "posewright/model/explicit_model.hpp"

namespace posewright {
namespace {

using Measurement = std::unique_ptr<MeasurementModel>;

// These look at no single tip.
Measurement model_of(const JointsMeasurement&, const MeasurementSpec&) { return nullptr; }
// Of several instruments each has a model of its own (InstrumentChoice).
Measurement model_of(const InstrumentList&, const MeasurementSpec&) { return nullptr; }

/// Empty view for an instrument without one.
template <class Instrument>
InstrumentView view_of(const Instrument&) {
  return {};
}

/// Models without a view of one tip, made from the robot itself.
using Model = std::unique_ptr<IdentificationModel>;
template <class Instrument>
Model model_without_view(const Instrument&, std::unique_ptr<TipModel>, const MeasurementSpec&, const ProblemFile&) {
  return nullptr;
}
Model model_without_view(const DistanceMeasurement&, std::unique_ptr<TipModel> robot, const MeasurementSpec& spec,
                         const ProblemFile&) {
  return std::make_unique<DistancePairModel>(std::move(robot), spec);
}
Model model_without_view(const JointsMeasurement&, std::unique_ptr<TipModel> robot, const MeasurementSpec& spec,
                         const ProblemFile& file) {
  return joint_sensor_model(std::move(robot), spec, file);
}

Measurement looking(const MeasurementSpec& spec) {
  return std::visit([&](const auto& instrument) { return model_of(instrument, spec); }, spec.instrument);
}

}  // namespace

std::unique_ptr<MeasurementModel> make_measurement(const MeasurementSpec& spec) {
  Measurement measurement = looking(spec);
  if (measurement == nullptr) throw std::invalid_argument("this instrument does not look at one tip");
  return measurement;
}

std::unique_ptr<IdentificationModel> observe(std::unique_ptr<TipModel> robot, const MeasurementSpec& spec,
                                             const ProblemFile& file) {
  if (Measurement measurement = looking(spec))
    return std::make_unique<ExplicitModel>(std::move(robot), std::move(measurement), spec.repeatability);
  return std::visit(
      [&](const auto& instrument) { return model_without_view(instrument, std::move(robot), spec, file); },
      spec.instrument);
}

InstrumentView view_of(const MeasurementSpec& measurement) {
  InstrumentView view = std::visit([](const auto& instrument) { return view_of(instrument); }, measurement.instrument);
  if (measurement.name.empty()) return view;
  const auto in_list = [&](std::string& parameters) {
    if (!parameters.empty()) parameters = name_in(measurement.name, parameters);
  };
  in_list(view.points_parameters);
  for (InstrumentView::Point& point : view.points) in_list(point.parameters);
  for (InstrumentView::Place& place : view.places) {
    in_list(place.parameters);
    place.words = measurement.name;
  }
  return view;
}

}  // namespace posewright
