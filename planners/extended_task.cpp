#include "extended_task.hpp"

#include <algorithm>

namespace posewright {

ExtendedTask::ExtendedTask(const DesignTask& task, std::vector<int> kept, std::vector<std::vector<double>> added)
    : task_(task), kept_(std::move(kept)), added_(std::move(added)), spacing_(task.space->spacing()) {
  const BlockArray part = task.candidates.blocks->subset(kept_);
  blocks_ = BlockArray(kept_.size() + added_.size(), part.rows(), part.columns());
  std::copy_n(part.data(), part.count() * std::size_t(part.rows() * part.stride()), blocks_.data());
  const auto probe = task.space->probe();
  for (std::size_t i = 0; i < added_.size(); ++i)
    probe->block(added_[i], blocks_.row(kept_.size() + i, 0), blocks_.stride());
  task_.candidates.blocks = &blocks_;
  weigh(*task.workspace);
  task_.approximate = &approximate_;
  task_.space = nullptr;
  task_.workspace = nullptr;
  if (!spacing_.keeps_distance() && spacing_.most.empty()) return;
  spacing_.points.resize(Eigen::Index(blocks_.count()), Eigen::Index(configuration(*task.space, 0).size()));
  for (std::size_t i = 0; i < blocks_.count(); ++i) {
    const auto q = configuration(*task.space, int(i));
    std::copy(q.begin(), q.end(), spacing_.points.row(Eigen::Index(i)).data());
  }
  task_.candidates.spacing = &spacing_;
}

void ExtendedTask::weigh(const WorkspaceBound& workspace) {
  for (std::size_t i = 0; i < workspace.candidates.size(); ++i) {
    const auto at = std::lower_bound(kept_.begin(), kept_.end(), workspace.candidates[i]);
    if (at == kept_.end() || *at != workspace.candidates[i]) continue;
    approximate_.support.push_back(int(at - kept_.begin()));
    approximate_.weights.push_back(workspace.candidate_weights[i]);
  }
  for (std::size_t i = 0; i < workspace.support.size(); ++i) {
    approximate_.support.push_back(int(kept_.size() + i));
    approximate_.weights.push_back(workspace.weights[i]);
  }
}

PoseSet ExtendedTask::pose_set(const DesignTask& whole, const std::vector<int>& members) const {
  PoseSet poses;
  poses.blocks = blocks_.subset(members);
  for (const int i : members) {
    const auto q = configuration(*whole.space, i);
    poses.configurations.emplace_back(q.begin(), q.end());
    poses.candidates.push_back(std::size_t(i) < kept_.size() ? kept_[std::size_t(i)] : -1);
  }
  poses.value = value_of_blocks(whole, poses.blocks);
  return poses;
}

std::span<const double> ExtendedTask::configuration(const ConfigurationSpace& space, int i) const {
  const auto at = std::size_t(i);
  return at < kept_.size() ? space.candidate(kept_[at]) : std::span<const double>(added_[at - kept_.size()]);
}

}  // namespace posewright
