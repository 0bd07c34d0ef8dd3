#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "posewright/cell/cell.hpp"
#include "posewright/lists/pose_list.hpp"
#include "posewright/planning/workspace_bound.hpp"
#include "posewright/problem/design_specs.hpp"

namespace posewright {

/// Options of the command line that replace the problem file's design block.
struct PlanOptions {
  std::string variant, criterion, method;  ///< empty = as in the file
  std::string truth;                       ///< the variant that may be the case; empty = as in the file
  std::optional<int> poses, candidates, restarts;
  bool smallest = false;  ///< the smallest number of poses that reaches design: require
  std::optional<Repeats> repeats;
  std::optional<Scaling> scaling;
  std::optional<bool> prior;  ///< count tolerances as prior knowledge
  bool reserve = false;       ///< optimise for the loss of the worst single pose
  /// Nuisance parameters and an unmodelled effect count as those of interest do, with ds: poses whose readings are
  /// least certain.
  bool everything_counts = false;
  std::optional<PoseList> measured{};  ///< poses that are measured already; none: as in the file
  /// Poses that the plan has whatever its search finds: they are still to be measured and count among `poses`. Where a
  /// list marks some as fixed, those alone. None: as in the file; empty: none.
  std::optional<PoseList> fixed{};
  /// Candidates, in place of drawn ones, whatever the limits are; none: as in the file, unless `candidates` says how
  /// many to draw.
  std::optional<PoseList> candidates_from{};
  /// Without search and proof between the candidates: a comparison of plans needs neither.
  bool candidates_alone = false;
  /// A cell of the same robot with the same tool, of which only obstacles may stand elsewhere: what is known of the
  /// robot's own bodies is taken over. Null: none.
  std::shared_ptr<const Cell> same_robot{};
  ProofLimits proof{};                 ///< of the certificate over the workspace
  std::optional<RobustSpec> robust{};  ///< robots drawn from the tolerances; none: as in the file; 0 draws: no
  std::uint64_t seed = 0;
  int threads = 0;  ///< 0 = all
};

}  // namespace posewright
