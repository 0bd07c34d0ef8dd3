#pragma once

#include <optional>
#include <string>
#include <vector>

#include "posewright/planning/evaluate.hpp"
#include "preparation.hpp"

namespace posewright {

/// What a list of configurations is worth, from nothing but the list: the same for a plan and for a user's poses.
struct Judgement {
  std::vector<Evaluation> evaluations;           ///< of every variant; contributions in the order measured, then poses
  std::optional<double> rho0;                    ///< first variant, m
  std::vector<double> test_errors;               ///< m
  std::optional<Discrimination> discrimination;  ///< where a truth is named
  double squared_bias = 0.0;                     ///< of what `bias` counts, by all effects
};

/// @param poses  come to those that are measured already
/// Throws CannotDo where they do not identify all parameters.
Judgement judge(const Preparation& prepared, const Configurations& poses, const Settings& settings);

/// Φ of a criterion (docs/theory.md) and the criterion in its own terms (docs/plan-file.md).
struct CriterionValue {
  double phi = 0.0;
  double shown = 0.0;
};
/// @param references  of every variant, for criteria over several
CriterionValue criterion_value(const std::string& criterion, const Judgement& judgement, const Preparation& prepared,
                               const std::vector<double>& references);

/// The same for criteria that need one variant and no test poses.
/// @param scale  unit of every column; empty: 1
CriterionValue criterion_value(const std::string& criterion, const Evaluation& evaluation, int nuisance,
                               const Eigen::VectorXd& scale = {});

/// ln of each variant's efficiency against its reference.
std::vector<double> log_efficiencies(const Judgement& judgement, const Preparation& prepared,
                                     const std::vector<double>& references);

}  // namespace posewright
