#pragma once

#include <string>
#include <vector>

#include "posewright/study/study.hpp"
#include "posewright/tasks/compare_problem.hpp"

namespace posewright {

/// Plans of all compared variants, with the criterion of each. Throws InputError.
Settings comparison_settings(const Problem& problem, const CompareOptions& options);

struct PlansToCompare {
  std::vector<ComparedPlan> plans;
  std::vector<Configurations> poses;  ///< of each, without those that the problem names as measured
  std::vector<std::string> notes;
  std::vector<std::string> not_planned{};  ///< variants whose plan was not done when the search was ended
};
/// The best plan for each variant that can be identified. CannotDo if the search is ended before one is done.
PlansToCompare searched_plans(const Study& study, const Settings& settings, const Monitor& monitor);
/// Lists as they are. Throws InputError if one cannot be read.
PlansToCompare given_plans(const Problem& problem, const Study& study, const std::vector<CompareOptions::List>& lists);

/// Request for a search or bound for one variant alone.
SearchRequest request_for(const Study& study, const Variant& variant, const Settings& settings, int poses);

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
