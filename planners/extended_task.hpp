#pragma once

#include <span>
#include <vector>

#include "continuous.hpp"
#include "posewright/planning/design_task.hpp"

namespace posewright {

/// Candidates of a smaller pool together with configurations that are none, with optimal weights over the workspace
/// for starts: the first of the configurations are those of its support.
class ExtendedTask {
 public:
  /// @param task  with a space and a workspace bound
  /// @param kept  candidates that take part, ascending
  ExtendedTask(const DesignTask& task, std::vector<int> kept, std::vector<std::vector<double>> added);

  const DesignTask& task() const { return task_; }
  /// Poses of the whole task from members of this one.
  PoseSet pose_set(const DesignTask& whole, const std::vector<int>& members) const;

 private:
  std::span<const double> configuration(const ConfigurationSpace& space, int i) const;
  void weigh(const WorkspaceBound& workspace);

  DesignTask task_;
  std::vector<int> kept_;
  ApproximateDesign approximate_;
  std::vector<std::vector<double>> added_;
  BlockArray blocks_;
  Spacing spacing_;
};

}  // namespace posewright
