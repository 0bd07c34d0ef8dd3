#pragma once

#include <vector>

#include "posewright/planning/design_task.hpp"

namespace posewright {

/// The task on promising candidates only: those whose sensitivity at the approximate optimum is near its price. Good
/// exact plans lie there almost always (all of the best known ones of our instances do), and it is a small
/// part of a large candidate set; a search that ends with passes over all candidates loses nothing by it.
class ReducedTask {
 public:
  /// Keeps the full task if there is no approximate optimum or little to save.
  /// @param also  candidates to keep whatever their sensitivity
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
  DesignTask task_;
  std::vector<int> kept_;
  BlockArray blocks_;
  ApproximateDesign approximate_;
  Spacing spacing_;
};

}  // namespace posewright
