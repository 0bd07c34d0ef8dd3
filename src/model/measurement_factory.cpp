#include "posewright/model/measurement_factory.hpp"

#include "posewright/model/measure_points.hpp"
#include "posewright/model/measure_pose.hpp"

namespace posewright {
namespace {

struct Make {
  const MeasurementSpec& spec;
  std::unique_ptr<MeasurementModel> operator()(const PoseMeasurement&) const {
    return std::make_unique<PoseModel>(spec);
  }
  std::unique_ptr<MeasurementModel> operator()(const PointsMeasurement&) const {
    return std::make_unique<PointsModel>(spec);
  }
};

}  // namespace

std::unique_ptr<MeasurementModel> make_measurement(const MeasurementSpec& spec) {
  return std::visit(Make{spec}, spec.instrument);
}

}  // namespace posewright
