// Plans a problem file: 1_plan PROBLEM PLAN.json. Prints the table that the command line prints.
#include <iostream>
#include <posewright/problem/design_keys.hpp>
#include <posewright/problem/read_problem.hpp>
#include <posewright/results/plan.hpp>
#include <posewright/support/error.hpp>
#include <posewright/support/file.hpp>
#include <posewright/tasks/plan_problem.hpp>

int main(int count, char** words) {
  if (count != 3) {
    std::cerr << "1_plan PROBLEM PLAN.json\n";
    return 2;
  }
  try {
    posewright::Problem problem = posewright::read_problem(words[1]);
    posewright::set(problem, "design.candidates", "1000", "candidates");  // any key of the design
    posewright::set(problem, "design.restarts", "2", "restarts");
    const posewright::Plan plan = posewright::plan_problem(problem, {}, posewright::Monitor{});
    posewright::write_file_atomically(words[2], posewright::plan_json(plan));
    std::cout << posewright::plan_summary(plan);
  } catch (const posewright::InputError& error) {  // names file and line
    std::cerr << error.what() << "\n";
    return 2;
  } catch (const posewright::CannotDo& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
