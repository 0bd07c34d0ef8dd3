#include "posewright/model/measurement_factory.hpp"

#include <stdexcept>

#include "measure_camera.hpp"
#include "measure_distance.hpp"
#include "measure_points.hpp"
#include "measure_pose.hpp"

namespace posewright {
namespace {

/// One overload an instrument: a new one is one file and one row here.
struct ModelOfMeasurement {
  const MeasurementSpec& spec;
  std::unique_ptr<MeasurementModel> operator()(const PoseMeasurement&) const {
    return std::make_unique<PoseModel>(spec);
  }
  std::unique_ptr<MeasurementModel> operator()(const PointsMeasurement&) const {
    return std::make_unique<PointsModel>(spec);
  }
  std::unique_ptr<MeasurementModel> operator()(const DistanceMeasurement& distance) const {
    if (distance.anchors.empty())
      throw std::invalid_argument("a distance between configurations is not a view of one tip");
    return std::make_unique<DistanceModel>(spec);
  }
  std::unique_ptr<MeasurementModel> operator()(const CameraMeasurement&) const {
    return std::make_unique<CameraModel>(spec);
  }
  std::unique_ptr<MeasurementModel> operator()(const JointsMeasurement&) const {
    throw std::invalid_argument("joint sensors are no view of a tip");
  }
};

}  // namespace

std::unique_ptr<MeasurementModel> make_measurement(const MeasurementSpec& spec) {
  return std::visit(ModelOfMeasurement{spec}, spec.instrument);
}

}  // namespace posewright
