#pragma once

#include <filesystem>
#include <string>

#include "posewright/lists/measured_data.hpp"
#include "posewright/model/model_factory.hpp"
#include "posewright/tasks/calibrate_problem.hpp"
#include "tests/kit/example_problems.hpp"
#include "tests/kit/temporary_folder.hpp"
#include "tests/kit/virtual_data.hpp"

namespace posewright {

/// Readings of an example's robot as a file.
struct VirtualFile {
  TemporaryFolder folder;
  Problem problem;
  std::unique_ptr<IdentificationModel> model;
  VariantColumns columns;
  std::vector<MeasuredPose> poses;
  std::vector<double> truth;
  Random random{5, 1};

  VirtualFile(const std::string& file, int count, double noise = 1.0) : problem(example(file)) {
    const VariantSpec& spec = find_variant(problem, "");
    model = make_model({problem, spec});
    columns = select_columns(*model, {problem, spec});
    poses = random_poses(*model, count, random);
    truth = random_truth(*model, columns, 0.3, random);
    read_poses_of(*model, truth, noise, random, poses);
  }
  std::filesystem::path write(const std::string& text) { return folder.write("data.csv", text); }
  std::filesystem::path write() { return write(measured_data_csv(*model, poses)); }
  CalibrateOptions options() {
    CalibrateOptions options;
    options.data = folder.path() / "data.csv";
    return options;
  }
};

}  // namespace posewright
