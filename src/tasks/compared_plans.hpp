#pragma once

#include <string>
#include <vector>

#include "posewright/study/study.hpp"
#include "posewright/tasks/compare_problem.hpp"

namespace posewright {

/// The problem with the design of a comparison: each variant is planned for alone. Throws InputError.
Problem compared_problem(Problem problem, bool given);
/// All compared variants with their candidates. Throws InputError.
/// @param problem  by compared_problem()
Study comparison_study(const Problem& problem, const CompareOptions& options, const Monitor& monitor);

struct PlansToCompare {
  std::vector<ComparedPlan> plans;
  std::vector<Configurations> poses;  ///< of each, without those that the problem names as measured
  std::vector<std::string> notes;
  std::vector<std::string> not_planned{};  ///< variants whose plan was not done when the search was ended
};
/// The best plan for each variant that can be identified. CannotDo if the search is ended before one is done.
PlansToCompare searched_plans(const Study& study, const Monitor& monitor);
/// Lists as they are. Throws InputError if one cannot be read.
PlansToCompare given_plans(const Study& study, const std::vector<CompareOptions::List>& lists);

/// Request for a search or bound for one variant alone.
SearchRequest request_for(const Study& study, const Variant& variant, int poses);

/// Progress with a name before it.
class NamedMonitor {
 public:
  NamedMonitor(const Monitor& monitor, const std::string& name) {
    monitor_.interrupted = monitor.interrupted;
    monitor_.deadline = monitor.deadline;
    monitor_.on_progress = [&monitor, name](Progress progress) {
      progress.stage = name + ": " + progress.stage;
      monitor.report(progress);
    };
  }
  NamedMonitor(const NamedMonitor&) = delete;
  NamedMonitor& operator=(const NamedMonitor&) = delete;
  operator const Monitor&() const { return monitor_; }

 private:
  Monitor monitor_;
};

}  // namespace posewright
