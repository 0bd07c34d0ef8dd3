#pragma once

#include <filesystem>
#include <string>

#include "posewright/study/plan_options.hpp"

namespace posewright {

/// Settings in a plan.json, for repeating its search.
struct WrittenPlan {
  std::filesystem::path file;
  std::string text;     ///< as the file is
  PlanOptions options;  ///< what it was made with, as far as it says; poses: those that are new
  double log_det = 0.0;
  std::string problem_sha256;
  ParametersFile parameters_file;
};

/// Throws InputError if the file is not a plan of a robot.
WrittenPlan read_written_plan(const std::filesystem::path& file);

}  // namespace posewright
