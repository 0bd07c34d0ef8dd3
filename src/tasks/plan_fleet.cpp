#include "posewright/tasks/plan_fleet.hpp"

#include "posewright/support/bytes.hpp"
#include "posewright/support/error.hpp"
#include "posewright/support/tasks.hpp"

namespace posewright {
std::vector<FleetPlan> plan_fleet(const std::vector<Problem>& problems, const RunOptions& run,
                                  const std::function<std::string(const Plan&, std::size_t index)>& render,
                                  const Monitor& monitor) {
  std::vector<FleetPlan> fleet(problems.size());
  for (FleetPlan& plan : fleet) plan.why_not = "not planned: stopped";
  const auto plan_one = [&](std::size_t i) {
    FleetPlan result;
    Monitor quiet;  // the stages of one plan would hide how many are done
    quiet.stop_with(monitor);
    try {
      const Plan plan = plan_problem(problems[i], run, quiet);
      result.variant = plan.variant;
      result.poses = int(plan.poses.size());
      result.log_det = plan.log_det;
      if (plan.certificate.proved) result.efficiency = plan.certificate.efficiency;
      result.expected = plan.expected;
      result.seconds = plan.statistics.seconds;
      result.rendered = render(plan, i);
    } catch (const InputError& error) {
      result.why_not = error.what();
    } catch (const CannotDo& error) {
      result.why_not = error.what();
    }
    return result;
  };
  // One at a time in each process: the parts of a plan keep its threads busy.
  run_tasks(
      {"plans", problems.size(), 1}, [&](std::size_t i, int) { return bytes_of(plan_one(i)); },
      [&](std::size_t i, std::string_view bytes) { fleet[i] = value_in<FleetPlan>(bytes); }, monitor);
  return fleet;
}

}  // namespace posewright
