#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "posewright/problem/read_problem.hpp"
#include "posewright/tasks/calibrate_problem.hpp"
#include "tests/kit/planar_arm.hpp"
#include "tests/kit/temporary_folder.hpp"

namespace posewright {

inline constexpr const char* planar_problem = R"(posewright: 1
robot: {urdf: arm.urdf}
measurement:
  - {name: tracker, type: position, target: [0.05, 0.02, 0], components: [x, y], device: {type: isotropic, noise: 20 um}, repeatability: 30 um}
  - {name: gauge, type: distance, targets: {T: [0.1, 0, 0]}, anchors: {A: [2, 1.5, 0]}, device: {type: isotropic, noise: 10 um}}
variants:
  arm: {parameters: [q1.offset, q2.offset, q2.x]}
design: {criterion: o1, poses: 8, candidates: 300, restarts: 2, method: exchange}
)";

/// A planar arm in a folder of its own.
struct Planar {
  TemporaryFolder folder;
  Problem problem;

  explicit Planar(const std::string& text = planar_problem)
      : problem((folder.write("arm.urdf", planar_arm_urdf), read_problem(folder.write("p.yaml", text)))) {}
};

inline std::string replaced_once(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

/// Readings of a planar arm whose errors are known, by formulas of this test.
class PlanarReadings {
 public:
  static Eigen::Vector2d point(const Eigen::Vector3d& x, double q1, double q2, const Eigen::Vector2d& on_tip) {
    const Eigen::Vector2d reach = Eigen::Vector2d(0.8, 0) + on_tip;
    return Eigen::Rotation2Dd(q1 + x[0]) * (Eigen::Vector2d(1 + x[2], 0) + Eigen::Rotation2Dd(q2 + x[1]) * reach);
  }
  /// Two rows of the tracker or one of the gauge, in units of their noise.
  static Eigen::VectorXd rows(const Eigen::Vector3d& x, double q1, double q2, int instrument) {
    if (instrument == 0) return point(x, q1, q2, {0.05, 0.02}) / std::hypot(20e-6, 30e-6);
    return Eigen::VectorXd::Constant(1, (point(x, q1, q2, {0.1, 0}) - Eigen::Vector2d(2, 1.5)).norm() / 10e-6);
  }

  /// @param gauge_noise   in units of the stated one
  /// @param gauge_effect  amplitude of an error of the gauge that is smooth over the joints, in the same units
  explicit PlanarReadings(unsigned seed, double gauge_noise = 1.0, double gauge_effect = 0.0) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> angle(-1.8, 1.8);
    csv = "id,q1,q2,instrument,tracker.target.x [m],tracker.target.y [m],gauge.A-T [m]\n";
    for (int i = 0; i < 60; ++i) {
      q1.push_back(angle(random));
      q2.push_back(angle(random));
      instrument.push_back(i % 3 == 0 ? 0 : 1);
      Eigen::VectorXd row = rows({2e-3, -1e-3, 4e-4}, q1.back(), q2.back(), instrument.back());
      for (double& value : row) value += (instrument.back() == 0 ? 1.0 : gauge_noise) * normal(random);
      if (instrument.back() == 1) row[0] += gauge_effect * std::cos(1.3 * q1.back() + 0.9 * q2.back() + 0.4);
      z.push_back(row);
      const auto cell = [](double value) { return std::to_string(value * 1e9) + "e-9"; };
      csv += std::to_string(i + 1) + "," + cell(q1.back()) + "," + cell(q2.back());
      if (instrument.back() == 0)
        csv += ",tracker," + cell(row[0] * std::hypot(20e-6, 30e-6)) + "," + cell(row[1] * std::hypot(20e-6, 30e-6)) +
               ",\n";
      else csv += ",gauge,,," + cell(row[0] * 10e-6) + "\n";
    }
  }

  /// Rows and their derivatives by central differences, one pose below the other.
  void stack(const Eigen::Vector3d& x, Eigen::VectorXd& r, Eigen::MatrixXd& J, std::vector<int>& of) const {
    std::vector<double> rs;
    std::vector<Eigen::RowVector3d> Js;
    of.clear();
    for (std::size_t i = 0; i < q1.size(); ++i) {
      const Eigen::VectorXd at = rows(x, q1[i], q2[i], instrument[i]);
      Eigen::MatrixXd D(at.size(), 3);
      for (int k = 0; k < 3; ++k) {
        const Eigen::Vector3d h = 1e-6 * Eigen::Vector3d::Unit(k);
        D.col(k) = (rows(x + h, q1[i], q2[i], instrument[i]) - rows(x - h, q1[i], q2[i], instrument[i])) / 2e-6;
      }
      for (Eigen::Index row = 0; row < at.size(); ++row) {
        rs.push_back(z[i][row] - at[row]);
        Js.emplace_back(D.row(row));
        of.push_back(instrument[i]);
      }
    }
    r = Eigen::Map<Eigen::VectorXd>(rs.data(), Eigen::Index(rs.size()));
    J.resize(r.size(), 3);
    for (Eigen::Index row = 0; row < r.size(); ++row) J.row(row) = Js[std::size_t(row)];
  }

  std::vector<double> q1, q2;
  std::vector<int> instrument;
  std::vector<Eigen::VectorXd> z;
  std::string csv;
};

inline Calibration calibrated(const Planar& planar, const std::string& csv) {
  CalibrateOptions options;
  options.data = planar.folder.write("data.csv", csv);
  options.prior = Prior::none;
  return calibrate_problem(planar.problem, options, Monitor{});
}

}  // namespace posewright
