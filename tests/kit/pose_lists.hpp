#pragma once

#include <vector>

#include "posewright/lists/read_poses.hpp"
#include "posewright/study/variant.hpp"
#include "posewright/study/written_plan.hpp"
#include "posewright/workspace/candidates.hpp"

namespace posewright {

/// Configurations evenly through the workspace.
inline std::vector<std::vector<double>> list_of(const Problem& problem, std::size_t count) {
  const Variant variant = make_variant(problem, {}, Monitor{});
  SamplingOptions sampling;
  sampling.count = count;
  sampling.seed = 7;
  const Configurations drawn = sample_configurations(*variant.workspace, sampling, Monitor{});
  std::vector<std::vector<double>> list;
  for (std::size_t i = 0; i < drawn.count(); ++i) list.emplace_back(drawn[i].begin(), drawn[i].end());
  return list;
}

/// Lists as a problem's first variant reads them.
inline PoseList poses_in(const Problem& problem, const std::filesystem::path& file) {
  return read_poses(file, pose_coordinates(problem));
}
inline PoseList given_poses(const Problem& problem, const std::vector<std::vector<double>>& configurations) {
  return poses_given(configurations, pose_coordinates(problem));
}
inline PoseList planned_poses(const Problem& problem, const Plan& plan) {
  return poses_of(plan, pose_coordinates(problem));
}

}  // namespace posewright
