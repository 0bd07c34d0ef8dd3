#include "posewright/problem/problem.hpp"

#include <algorithm>

#include "posewright/support/error.hpp"

namespace posewright {

Problem::Problem() = default;
Problem::Problem(const Problem&) = default;
Problem::Problem(Problem&&) noexcept = default;
Problem& Problem::operator=(const Problem&) = default;
Problem& Problem::operator=(Problem&&) noexcept = default;
Problem::~Problem() = default;

namespace {

struct SetJointNoise {
  double sigma;
  void operator()(SixLegsSpec& robot) const { robot.actuator_noise = sigma; }
  void operator()(GivenPosesSpec&) const {}
  void operator()(auto& robot) const { robot.encoder_noise = sigma; }
};

}  // namespace

namespace {

/// Each is set up, and the slowest is waited for.
InstrumentTimes times_together(const std::vector<MeasurementSpec>& members, const MotionSpec& motion) {
  InstrumentTimes all;
  for (const MeasurementSpec& member : members) {
    const InstrumentTimes one = times_of(member, motion);
    all.setup += one.setup;
    all.reading = std::max(all.reading, one.reading * one.in_turn);
  }
  return all;
}

}  // namespace

InstrumentTimes times_of(const MeasurementSpec& instrument, const MotionSpec& motion) {
  if (const std::vector<MeasurementSpec>* members = members_of(instrument)) {
    const InstrumentTimes all = times_together(*members, motion);
    return {instrument.setup.value_or(all.setup), instrument.reading.value_or(all.reading)};
  }
  InstrumentTimes times{instrument.setup.value_or(motion.station_change),
                        instrument.reading.value_or(motion.reading) * instrument.repeats};
  // A tracker follows one target after the other; what else there is reads all at once.
  const auto* points = std::get_if<PointsMeasurement>(&instrument.instrument);
  if (points != nullptr && std::holds_alternative<TrackerNoise>(points->noise))
    times.in_turn = int(points->targets.size());
  return times;
}

void require_one_instrument(const Problem& problem, const std::string& what) {
  if (instruments_of(problem.measurement) == nullptr) return;
  throw InputError(problem.at(problem.measurement.line), "measurement is a list of instruments",
                   what + " works with one alone");
}

void set_joint_noise(RobotSpec& robot, double sigma) { std::visit(SetJointNoise{sigma}, robot); }

}  // namespace posewright
