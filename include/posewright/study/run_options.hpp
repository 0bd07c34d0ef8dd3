#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "posewright/cell/cell.hpp"
#include "posewright/lists/pose_list.hpp"
#include "posewright/planning/workspace_bound.hpp"

namespace posewright {

/// Options of one run, beside the problem whose design is planned or judged.
struct RunOptions {
  std::optional<PoseList> measured{};  ///< poses that are measured already; none: as in the problem
  /// Poses that the plan has whatever its search finds: they are still to be measured and count among its number. Where
  /// a list marks some as fixed, those alone. None: as in the problem; empty: none.
  std::optional<PoseList> fixed{};
  /// Candidates, in place of drawn ones, whatever the limits are; none: as in the problem.
  std::optional<PoseList> candidates_from{};
  std::vector<std::string> variants{};  ///< to prepare, by name; empty: those of the criterion
  /// Parameters by variant that a variant with `auto` keeps before any others, by name: those that a plan estimates.
  /// Among few candidates others of a dependent group may have the largest columns.
  std::map<std::string, std::vector<std::string>> kept_parameters{};
  /// Nuisance parameters and an unmodelled effect count as those of interest do, with ds: poses whose readings are
  /// least certain.
  bool nuisance_counts = false;
  /// Without search and proof between the candidates: a comparison of plans needs neither.
  bool candidates_alone = false;
  /// Whether the plan says what other numbers of poses reach, unless its search is a quick one (fewer restarts than by
  /// default): for files that people look at.
  bool other_numbers = false;
  /// A cell of the same robot with the same tool, of which only obstacles may stand elsewhere: what is known of the
  /// robot's own bodies is taken over. Null: none.
  std::shared_ptr<const Cell> same_robot{};
  ProofLimits proof{};  ///< of the certificate over the workspace
  std::uint64_t seed = 0;
  int threads = 0;  ///< 0 = all
};

}  // namespace posewright
