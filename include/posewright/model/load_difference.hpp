#pragma once

#include <memory>
#include <span>
#include <vector>

#include "posewright/model/identification_model.hpp"

namespace posewright {

/// Loaded minus unloaded: what is measured at a configuration under its load case, less the same under the first load
/// case. Reading noise counts twice. What stays at a pose (robot repeatability, joint readings) is the same in both and
/// cancels: the model inside must be built without it.
class LoadDifference : public IdentificationModel {
 public:
  /// @param inside  a model with a coordinate `load_case`. Throws CannotDo if it has fewer than two load cases.
  explicit LoadDifference(std::unique_ptr<IdentificationModel> inside);

  /// Model of the readings under one load case.
  const IdentificationModel& inside() const { return *inside_; }
  /// This configuration under the first load case.
  std::vector<double> unloaded(std::span<const double> q) const;

 private:
  void do_take_loads_at(std::span<const double> correction) override;
  bool do_linearise(const Point& at, std::span<const int> selected, Linearisation& out) const override;
  bool do_pull_back(const Point& at, std::span<const int> selected, const Eigen::MatrixXd& by_G,
                    const Eigen::MatrixXd& by_covariance, std::span<double> gradient) const override;
  bool do_read(const Point& at, Eigen::VectorXd& y) const override;
  bool do_measurable(const Point& at) const override;
  Eigen::Isometry3d do_tool_pose(const Point& at) const override;

  std::unique_ptr<IdentificationModel> inside_;
  std::size_t load_ = 0;  ///< which coordinate is the load case
};

}  // namespace posewright
