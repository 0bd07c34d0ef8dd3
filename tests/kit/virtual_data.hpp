#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "posewright/calibration/fit.hpp"
#include "posewright/support/random.hpp"

/// Readings of a robot whose parameters are known, for tests.
namespace posewright {

inline std::vector<double> random_configuration(const IdentificationModel& model, Random& random) {
  std::vector<double> q;
  for (const Coordinate& c : model.coordinates())
    q.push_back(c.discrete() ? c.values[std::size_t(random.uniform(0, double(c.values.size())))]
                             : random.uniform(c.lower, c.upper));
  return q;
}

/// Of a parameter; the number of parameters if there is none of this name.
inline int parameter_index(const IdentificationModel& model, const std::string& name) {
  return int(std::ranges::find(model.parameters(), name, &Parameter::name) - model.parameters().begin());
}

/// Measurable random configurations with nothing read yet.
inline std::vector<MeasuredPose> random_poses(const IdentificationModel& model, int count, Random& random) {
  std::vector<MeasuredPose> poses;
  while (int(poses.size()) < count) {
    MeasuredPose pose;
    pose.q = random_configuration(model, random);
    Eigen::VectorXd y;
    std::vector<double> actuators(model.actuators().size());
    if (!model.measurable(pose.q) || !model.predict(pose.q, {}, y) || !model.actuator_values(pose.q, actuators))
      continue;
    bool inside = true;
    for (std::size_t i = 0; i < actuators.size(); ++i)
      inside = inside && actuators[i] >= model.actuators()[i].lower && actuators[i] <= model.actuators()[i].upper;
    if (!inside) continue;
    pose.id = int(poses.size()) + 1;
    poses.push_back(std::move(pose));
  }
  return poses;
}

/// Random corrections of the columns, `fraction` of a tolerance (1σ) each, as one of every parameter.
inline std::vector<double> random_truth(const IdentificationModel& model, const VariantColumns& columns,
                                        double fraction, Random& random) {
  std::vector<double> truth(model.parameters().size(), 0.0);
  for (std::size_t j = 0; j < columns.selected.size(); ++j)
    truth[std::size_t(columns.selected[j])] = fraction * columns.parameters[j].tolerance * random.normal();
  return truth;
}

/// Fills in what the instrument reads, with its noise times `noise`.
inline void read_poses_of(const IdentificationModel& model, const std::vector<double>& truth, double noise,
                          Random& random, std::vector<MeasuredPose>& poses) {
  Linearisation at;
  for (MeasuredPose& pose : poses) {
    ASSERT_TRUE(model.predict_and_linearise(pose.q, truth, {}, at, pose.y));
    Eigen::VectorXd z(pose.y.size());
    for (double& value : z) value = noise * random.normal();
    z = Eigen::LLT<Eigen::MatrixXd>(at.covariance).matrixL() * z;
    const Eigen::VectorXd exact = pose.y;
    model.shifted(exact, z, pose.y);
  }
}

}  // namespace posewright
