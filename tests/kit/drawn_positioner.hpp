#pragma once

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "posewright/calibration/fit.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/study/columns.hpp"
#include "posewright/support/random.hpp"
#include "tests/kit/example_problems.hpp"

namespace posewright {

inline const double pi = std::acos(-1.0);

/// Two-axis positioner whose target's pose is read; where base and target stand is estimated, 12 parameters.
class DrawnPositioner : public testing::Test {
 protected:
  DrawnPositioner() : problem_(example("real_data/rosi_positioner/problem.yaml")), model_(make_model(problem_)) {
    VariantColumns all = select_columns(*model_, {problem_, find_variant(problem_, "everything")});
    std::vector<int> kept;
    for (int j = 0; j < int(all.parameters.size()); ++j)
      if (const std::string& name = all.parameters[std::size_t(j)].name;
          name.starts_with("base.") || name.starts_with("tool."))
        kept.push_back(j);
    columns_ = subset(all, kept);
  }

  /// The kernel as the definition has it.
  static double correlation(const std::vector<double>& p, const std::vector<double>& q, double length) {
    const double squares = 4 - 2 * std::cos(p[0] - q[0]) - 2 * std::cos(p[1] - q[1]);
    return std::exp(-squares / (2 * length * length));
  }

  /// Readings of the nominal robot with noise `noise` times the stated one and an effect of this size (m) and length.
  std::vector<MeasuredPose> drawn(int count, double size, double length, double noise, std::uint64_t seed) const {
    Random random(seed, 77);
    std::vector<MeasuredPose> poses(static_cast<std::size_t>(count));
    for (MeasuredPose& pose : poses)
      for (const Coordinate& c : model_->coordinates()) pose.q.push_back(random.uniform(c.lower, c.upper));
    Eigen::MatrixXd K(count, count);
    for (int i = 0; i < count; ++i)
      for (int j = 0; j < count; ++j)
        K(i, j) = correlation(poses[std::size_t(i)].q, poses[std::size_t(j)].q, length) + (i == j ? 1e-10 : 0);
    Eigen::MatrixXd white(count, 3);
    for (double& w : white.reshaped()) w = random.normal();
    const Eigen::MatrixXd effect = size * Eigen::MatrixXd(K.llt().matrixL()) * white;
    for (int i = 0; i < count; ++i) {
      MeasuredPose& pose = poses[std::size_t(i)];
      pose.id = i + 1;
      Eigen::VectorXd predicted;
      model_->predict(pose.q, {}, predicted);
      Eigen::VectorXd change(6);
      for (Eigen::Index k = 0; k < 6; ++k) change[k] = noise * (k < 3 ? 0.23e-3 : 0.5e-3) * random.normal();
      change.head<3>() += effect.row(i).transpose();
      model_->shifted(predicted, change, pose.y);
    }
    return poses;
  }

  Fit fitted(const std::vector<MeasuredPose>& poses, std::shared_ptr<const UnmodelledEffect> effect = nullptr) const {
    FitOptions options;
    options.effect = std::move(effect);
    return fit(*model_, columns_, poses, options);
  }

  Problem problem_;
  std::unique_ptr<IdentificationModel> model_;
  VariantColumns columns_;
};

}  // namespace posewright
