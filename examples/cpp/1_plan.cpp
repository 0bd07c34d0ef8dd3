// Plans a problem file: 1_plan PROBLEM PLAN.json. Prints the table that the command line prints.
#include <iostream>
#include <posewright/outputs/write_plan.hpp>
#include <posewright/problem/read_problem.hpp>
#include <posewright/support/error.hpp>
#include <posewright/support/file.hpp>
#include <posewright/tasks/plan_problem.hpp>

int main(int count, char** words) {
  if (count != 3) {
    std::cerr << "1_plan PROBLEM PLAN.json\n";
    return 2;
  }
  try {
    const posewright::Problem problem = posewright::read_problem(words[1]);
    posewright::PlanOptions options;  // what is not said is as in the problem
    options.candidates = 1000;
    options.restarts = 2;
    const posewright::Plan plan = posewright::plan_problem(problem, options, posewright::Monitor{});
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
