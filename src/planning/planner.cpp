#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "posewright/criterion/determinant.hpp"
#include "posewright/planning/design_task.hpp"
#include "posewright/support/error.hpp"

namespace posewright {

namespace {

/// log det of the information of all columns, nuisance ones too.
class OfAllColumns : public DeterminantCriterion {
 public:
  explicit OfAllColumns(int columns) : DeterminantCriterion("o1", 0, columns) {}
  std::unique_ptr<DesignState> start(const CandidateView& view, std::vector<int> members) const override {
    CandidateView all = view;
    all.nuisance = 0;
    return DeterminantCriterion::start(all, std::move(members));
  }
};

/// The same criterion from starts that settle under the determinant of all columns first. Where nuisance columns are
/// eliminated, poses that alone tell some of them (of a second instrument) gain nothing while they are too few to tell
/// all: a search among sets that do not tell them does not find those that do.
class FromIdentifyingStarts : public Criterion {
 public:
  FromIdentifyingStarts(const Criterion& criterion, int columns) : criterion_(criterion), all_columns_(columns) {}
  std::string name() const override { return criterion_.name(); }
  const InformationFunction& function() const override { return criterion_.function(); }
  bool of_information_alone() const override { return criterion_.of_information_alone(); }
  std::unique_ptr<DesignState> start(const CandidateView& view, std::vector<int> members) const override {
    return criterion_.start(view, std::move(members));
  }
  const Criterion* smoother() const override { return &all_columns_; }

 private:
  const Criterion& criterion_;
  OfAllColumns all_columns_;
};

}  // namespace

Design Planner::plan(const DesignTask& task, const PlannerOptions& options, const Monitor& monitor) const {
  if (task.candidates.blocks == nullptr || task.criterion == nullptr)
    throw std::invalid_argument("design task: blocks and criterion are required");
  const long available = long(task.candidates.blocks->count()) * task.candidates.max_repeats;
  if (task.poses < 1 || task.poses > available)
    throw std::invalid_argument("design task: " + std::to_string(task.poses) + " poses from " +
                                std::to_string(available) + " choices");
  if (options.restarts < 1) throw std::invalid_argument("planner options: restarts must be at least 1");
  Design design = search(task, options, monitor);
  if (!std::isfinite(design.value) && !monitor.should_stop()) {
    const FromIdentifyingStarts identifying(*task.criterion, task.candidates.blocks->columns());
    DesignTask again = task;
    again.criterion = &identifying;
    // Candidates that the weights promise leave those poses out.
    again.approximate = nullptr;
    design = search(again, options, monitor);
  }
  if (!std::isfinite(design.value))
    throw NothingIdentifies("no set of " + std::to_string(task.poses) + " candidates was found that identifies all " +
                            std::to_string(task.candidates.blocks->columns()) +
                            " parameters: more poses, another method (exchange) or criterion (o1) may find one");
  std::sort(design.members.begin(), design.members.end());
  return design;
}

}  // namespace posewright
