#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "posewright/lists/pose_list.hpp"
#include "posewright/problem/problem.hpp"
#include "posewright/results/plan.hpp"

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
  std::optional<double> rho0{};  ///< predicted error at the test poses, m
  std::string problem_sha256;
  /// What other numbers of poses reach; none where the file does not say it, or says it of other poses than it has.
  std::optional<std::vector<CurvePoint>> other_numbers{};
  ParametersFile parameters_file;
  std::map<std::string, std::vector<std::string>> parameters{};  ///< names of the estimated ones, by variant
};

/// The problem with the design that the plan was made with.
Problem as_written(Problem problem, const WrittenPlan& plan);

/// The poses of a plan in memory. Throws InputError for a plan that has other coordinates.
PoseList poses_of(const Plan& plan, const std::vector<Coordinate>& coordinates);
/// Throws InputError if the file is not a plan of a robot.
WrittenPlan read_written_plan(const std::filesystem::path& file);

}  // namespace posewright
