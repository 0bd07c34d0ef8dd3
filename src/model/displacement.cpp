#include "displacement.hpp"

namespace posewright {

Twist revolute(const Eigen::Vector3d& axis, const Eigen::Vector3d& origin) {
  Twist twist;
  twist << origin.cross(axis), axis;
  return twist;
}

Twist prismatic(const Eigen::Vector3d& axis) {
  Twist twist;
  twist << axis, Eigen::Vector3d::Zero();
  return twist;
}

Twist DisplacementAxes::twist(int component) const {
  return component < 3 ? prismatic(translation.col(component)) : revolute(rotation.col(component - 3), origin);
}

DisplacementAxes displace(Frame<double>& frame, const double* d) {
  DisplacementAxes axes;
  axes.translation = frame.R;
  axes.rotation = frame.R;
  if (d != nullptr) {
    frame.then_translate({d[0], d[1], d[2]});
    frame.then_rotate(Eigen::Vector3d::UnitZ(), d[5]);
    axes.rotation.col(1) = frame.R.col(1);
    frame.then_rotate(Eigen::Vector3d::UnitY(), d[4]);
    axes.rotation.col(0) = frame.R.col(0);
    frame.then_rotate(Eigen::Vector3d::UnitX(), d[3]);
  }
  axes.origin = frame.p;
  return axes;
}

Frame<double> frame_of(const Eigen::Isometry3d& X) {
  Frame<double> frame;
  frame.R = X.linear();
  frame.p = X.translation();
  return frame;
}

Eigen::Isometry3d isometry_of(const Frame<double>& frame) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() = frame.R;
  X.translation() = frame.p;
  return X;
}

void change_frame(const Eigen::Isometry3d& X_AB, Eigen::Ref<Twists> twists) {
  for (Eigen::Index j = 0; j < twists.cols(); ++j) {
    const Eigen::Vector3d w = X_AB.linear() * twists.col(j).tail<3>();
    twists.col(j).head<3>() = X_AB.linear() * twists.col(j).head<3>() + X_AB.translation().cross(w);
    twists.col(j).tail<3>() = w;
  }
}

void append_displacement(std::vector<Parameter>& parameters, const std::string& name, const Eigen::Isometry3d& X,
                         double length_tolerance, double angle_tolerance) {
  const Eigen::Vector3d nominal = X.linear().transpose() * X.translation();
  for (int k = 0; k < 6; ++k)
    parameters.push_back({name + "." + displacement_names[std::size_t(k)], k < 3 ? "m" : "rad",
                          k < 3 ? nominal[k] : 0.0, k < 3 ? length_tolerance : angle_tolerance, Role::interest});
}

}  // namespace posewright
