#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "posewright/outputs/plan.hpp"
#include "posewright/problem/problem.hpp"

namespace posewright {

/// Settings in a plan.json, for repeating its search.
struct WrittenPlan {
  std::filesystem::path file;
  std::string text;  ///< as the file is
  int poses = 0;     ///< those that are new
  std::uint64_t seed = 0;
  /// Keys of the design that it was made with, as far as it says, and their values.
  std::vector<std::pair<std::string, std::string>> design;
  double log_det = 0.0;
  std::string problem_sha256;
  ParametersFile parameters_file;
};

/// The problem with the design that the plan was made with.
Problem as_written(Problem problem, const WrittenPlan& plan);

/// Throws InputError if the file is not a plan of a robot.
WrittenPlan read_written_plan(const std::filesystem::path& file);

}  // namespace posewright
