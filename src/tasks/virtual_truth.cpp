#include "virtual_truth.hpp"

#include <algorithm>

#include "posewright/study/accuracy_configurations.hpp"
#include "posewright/study/accuracy_points.hpp"
#include "posewright/support/error.hpp"

namespace posewright {
namespace {

void require_same_coordinates(const IdentificationModel& a, const IdentificationModel& b) {
  const auto same = [](const auto& x, const auto& y, const auto& equal) {
    return std::equal(x.begin(), x.end(), y.begin(), y.end(), equal);
  };
  const auto coordinate = [](const Coordinate& c, const Coordinate& d) {
    return c.name == d.name && c.labels == d.labels;
  };
  const auto reading = [](const Reading& r, const Reading& s) { return r.name == s.name && r.unit == s.unit; };
  if (!same(a.coordinates(), b.coordinates(), coordinate) || !same(a.actuators(), b.actuators(), coordinate) ||
      !same(a.readings(), b.readings(), reading))
    throw CannotDo("the two variants differ in their coordinates, actuators or readings and cannot be exchanged");
}

/// Coordinates of the measurement alone do not move the robot.
std::vector<int> robot_parameters(const IdentificationModel& seen, const IdentificationModel& measured,
                                  const VariantColumns& columns) {
  std::vector<int> from;
  for (const Parameter& p : seen.parameters()) {
    const auto& all = measured.parameters();
    const auto at = std::find_if(all.begin(), all.end(), [&](const Parameter& q) { return q.name == p.name; });
    int index = at == all.end() ? -1 : int(at - all.begin());
    const auto nuisance = columns.selected.begin() + columns.nuisance;
    if (std::find(columns.selected.begin(), nuisance, index) != nuisance) index = -1;
    from.push_back(index);
  }
  return from;
}

/// Joints of a serial arm may be of either kind.
void require_unit_of_joints(const Measured& noise, const RobotSpec& robot) {
  if (std::holds_alternative<GivenPosesSpec>(robot))
    throw InputError({}, "the true robot's joints are not known",
                     "robot: poses; its error is measurement: repeatability");
  if (std::holds_alternative<SerialArmSpec>(robot) || !(noise.value > 0)) return;
  const Quantity quantity = std::holds_alternative<SixLegsSpec>(robot) ? Quantity::length : Quantity::angle;
  if (noise.quantity != quantity)
    throw InputError({}, "the noise of the true robot's joints has the wrong unit",
                     "allowed: " + allowed_units({quantity}));
}

}  // namespace

Problem with_truth_noise(Problem problem, const TruthNoise& noise) {
  for_each_instrument(problem.measurement, [&](MeasurementSpec& instrument) {
    Repeatability& repeatability = instrument.repeatability;
    // A length that is stated anew says how the tip stands off; what the problem says of its turning stays.
    repeatability.translation = noise.repeatability.value_or(repeatability.translation);
    repeatability.independent = noise.independent.value_or(0.0);
  });
  if (noise.joints) {
    require_unit_of_joints(*noise.joints, problem.robot);
    set_joint_noise(problem.robot, noise.joints->value);
  }
  return problem;
}

std::vector<std::vector<double>> same_actuators(const IdentificationModel& from, const IdentificationModel& to,
                                                const std::vector<std::vector<double>>& configurations) {
  require_same_coordinates(from, to);
  std::vector<std::vector<double>> result;
  std::vector<double> actuators(from.actuators().size());
  for (const std::vector<double>& q : configurations) {
    result.push_back(q);
    if (actuators.empty()) continue;
    if (!from.actuator_values(q, actuators) || !to.configuration_at(actuators, q, result.back()))
      throw CannotDo("configuration " + std::to_string(result.size()) +
                     ": the true robot has no pose with these actuator positions");
  }
  return result;
}

std::unique_ptr<PlacesToCheck> places_to_check(const Variant& fitted, const Variant& truth, const VariantColumns& drawn,
                                               std::uint64_t seed) {
  const Problem& problem = *fitted.problem;
  if (!problem.design.test_poses || std::holds_alternative<CompensatorGeometrySpec>(problem.robot)) return nullptr;
  auto result = std::make_unique<PlacesToCheck>();
  result->fitted = make_pose_seen(fitted);
  result->truth = make_pose_seen(truth);
  result->points = test_points_of(fitted, fitted.columns, seed);
  CheckPlaces& places = result->places;
  places.fitted = result->fitted.get();
  places.truth = result->truth.get();
  TestConfigurations found = test_configurations(fitted, *result->fitted, seed);
  places.fitted_q = std::move(found.configurations);
  places.truth_q = same_actuators(*places.fitted, *places.truth, places.fitted_q);
  places.weights = found.weights.empty() ? std::vector<double>(places.fitted_q.size(), 1.0) : std::move(found.weights);
  places.fitted_from = robot_parameters(*places.fitted, *fitted.model, fitted.columns);
  places.truth_from = robot_parameters(*places.truth, *truth.model, drawn);
  places.point = problem.design.test_poses->point;
  return result;
}

}  // namespace posewright
