#include "posewright/problem/problem.hpp"

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

void set_joint_noise(RobotSpec& robot, double sigma) { std::visit(SetJointNoise{sigma}, robot); }

}  // namespace posewright
