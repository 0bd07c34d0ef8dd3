#pragma once

#include <string>
#include <vector>

#include "posewright/problem/problem.hpp"
#include "posewright/results/plan.hpp"

namespace posewright {

/// log det of the interest information of a variant at the given configurations, by LDLᵀ of the summed information and
/// of its nuisance block: another road than the product's QR of stacked rows.
double recomputed_log_det(const Problem& problem, const std::string& variant,
                          const std::vector<std::vector<double>>& poses);

/// The configurations of a plan as the model takes them: the written numbers, then load case and station by their
/// names.
std::vector<std::vector<double>> configurations_of(const Problem& problem, const Plan& plan);

/// What a reader of plan.json finds.
struct PlanFile {
  std::string variant;
  double log_det = 0, log_det_bound = 0, efficiency = 0;
  std::vector<std::vector<double>> poses;
  std::vector<int> candidates;
};
PlanFile read_back(const std::string& json);

/// The first `columns` numbers of every pose in poses.csv.
std::vector<std::vector<double>> read_back_csv(const std::string& csv, std::size_t columns);

}  // namespace posewright
