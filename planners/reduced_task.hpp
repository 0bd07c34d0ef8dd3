#pragma once

#include <vector>

#include "posewright/planning/design_task.hpp"

namespace posewright {

/// True where Φ has no bound and there are no weights, but many candidates: the promising ones of a reduced task are
/// those with the largest derivative of Φ at given members, and without members some of all.
bool promises_by_members(const DesignTask& task);

/// The task on promising candidates only: those whose sensitivity at the approximate optimum is near its price. Good
/// exact plans lie there almost always (all of the best known ones of our instances do), and it is a small
/// part of a large candidate set; a search that ends with passes over all candidates loses nothing by it.
class ReducedTask {
 public:
  /// Keeps the full task if there is no approximate optimum or little to save (but see promises_by_members).
  /// @param also  members, to be kept whatever their sensitivity
  explicit ReducedTask(const DesignTask& task, const std::vector<int>& also = {});
  ReducedTask(const ReducedTask&) = delete;
  ReducedTask& operator=(const ReducedTask&) = delete;

  const DesignTask& task() const { return task_; }
  bool is_smaller() const { return !kept_.empty(); }
  /// Indices of the full task for indices of the reduced one.
  std::vector<int> original(const std::vector<int>& members) const;
  /// The other way about; all must be in the reduced task.
  std::vector<int> reduced(const std::vector<int>& members) const;

 private:
  void keep(const DesignTask& task, std::vector<int> kept);
  void take_weights(const ApproximateDesign& whole);

  DesignTask task_;
  std::vector<int> kept_;
  BlockArray blocks_;
  ApproximateDesign approximate_;
  Spacing spacing_;
};

}  // namespace posewright
