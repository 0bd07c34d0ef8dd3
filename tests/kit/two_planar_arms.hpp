#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "posewright/model/five_bar.hpp"
#include "posewright/model/measurement_factory.hpp"

/// A five-bar as two planar arms of two joints each, whose tips meet.
namespace posewright {

/// URDF with the joints rho1, elbow1, rho2, elbow2 and the links tip1, tip2; lengths with six decimals.
inline std::string two_planar_arms(const FiveBarSpec& spec) {
  const auto number = [](double value) { return std::to_string(value); };
  std::string text = "<robot name=\"arms\"><link name=\"root\"/>";
  const auto joint = [&](const std::string& name, const std::string& parent, const std::string& child, double x,
                         double y, const std::string& kind) {
    text += "<link name=\"" + child + "\"/><joint name=\"" + name + "\" type=\"" + kind + "\"><parent link=\"" +
            parent + "\"/><child link=\"" + child + "\"/><origin xyz=\"" + number(x) + " " + number(y) +
            " 0\"/><axis xyz=\"0 0 1\"/><limit lower=\"-7\" upper=\"7\" effort=\"1\" velocity=\"1\"/></joint>";
  };
  for (int i = 0; i < 2; ++i) {
    const FiveBarSpec::Leg& leg = spec.legs[std::size_t(i)];
    const std::string k = std::to_string(i + 1);
    joint("rho" + k, "root", "proximal" + k, leg.base.x(), leg.base.y(), "revolute");
    joint("elbow" + k, "proximal" + k, "distal" + k, leg.proximal, 0, "revolute");
    joint("end" + k, "distal" + k, "tip" + k, leg.distal, 0, "fixed");
  }
  return text + "</robot>";
}

inline std::unique_ptr<IdentificationModel> five_bar_with_elbow_sensors(const FiveBarSpec& spec, double sigma) {
  JointsMeasurement sensors;
  sensors.sigma = sigma;
  MeasurementSpec measurement;
  measurement.instrument = sensors;
  return observe(std::make_unique<FiveBar>(spec), measurement, {});
}

/// Where the tips of the arms meet at the point `at` of the five-bar; further coordinates are 0.
inline std::vector<double> closed_configuration(const IdentificationModel& arms, const IdentificationModel& chain,
                                                const std::vector<double>& at) {
  std::vector<double> rho(2), q;
  Eigen::VectorXd elbows;
  if (!chain.actuator_values(at, rho) || !chain.predict(at, {}, elbows)) throw std::runtime_error("out of reach");
  for (const Coordinate& c : arms.coordinates()) {
    const auto k = std::size_t(c.name.back() - '1');
    q.push_back(c.name.starts_with("rho") ? rho[k] : c.name.starts_with("elbow") ? elbows[Eigen::Index(k)] : 0.0);
  }
  return q;
}

}  // namespace posewright
