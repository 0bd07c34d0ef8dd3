// Calibrates: 4_calibrate PROBLEM PLAN.json. Measures the plan on a virtual robot, estimates its parameters, writes
// measured.csv, calibration.json and parameters.yaml.
#include <iostream>
#include <posewright/lists/parameters_file.hpp>
#include <posewright/lists/read_poses.hpp>
#include <posewright/model/variant_columns.hpp>
#include <posewright/problem/read_problem.hpp>
#include <posewright/results/calibration.hpp>
#include <posewright/study/variant.hpp>
#include <posewright/support/error.hpp>
#include <posewright/support/file.hpp>
#include <posewright/support/json.hpp>
#include <posewright/tasks/calibrate_problem.hpp>
#include <posewright/tasks/simulate_problem.hpp>

int main(int count, char** words) {
  if (count != 3) {
    std::cerr << "4_calibrate PROBLEM PLAN.json\n";
    return 2;
  }
  try {
    const posewright::Problem problem = posewright::read_problem(words[1]);
    posewright::SimulateOptions simulate;
    simulate.experiment.draws = 2;
    const posewright::PoseList poses = posewright::read_poses(words[2], posewright::pose_coordinates(problem));
    const posewright::Simulation virtual_robot =
        posewright::simulate_problem(problem, poses, simulate, posewright::Monitor{});
    posewright::write_file_atomically("measured.csv", virtual_robot.first_readings);

    posewright::CalibrateOptions options;
    options.data = "measured.csv";
    const posewright::Calibration found = posewright::calibrate_problem(problem, options, posewright::Monitor{});
    std::cout << posewright::calibration_text(found);
    posewright::write_file_atomically("calibration.json",
                                      posewright::json_text(posewright::calibration_json(problem, options, found)));
    const posewright::VariantSpec& variant = posewright::find_variant(problem, found.variant);
    posewright::write_file_atomically("parameters.yaml", posewright::parameters_yaml({problem, variant}, found.values));
    return found.fit.converged ? 0 : 1;
  } catch (const std::runtime_error& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
