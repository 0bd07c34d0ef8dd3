#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "posewright/planning/design_task.hpp"
#include "posewright/study/run_options.hpp"
#include "posewright/study/variant.hpp"
#include "posewright/workspace/candidates.hpp"

namespace posewright {

/// A problem's design and the options of a run, every name looked up and every list read once, before anything is
/// drawn.
struct Setup {
  const Problem* problem = nullptr;  ///< that must outlive it
  std::string criterion, method;
  bool criterion_automatic = false;  ///< criterion: auto; `criterion` is o1 until choose_criterion() takes another
  std::optional<int> poses;          ///< of the plan; none: the smallest number that suffices, or not known yet
  int candidates = 0;
  bool prior = false, reserve = false;
  Repeats repeats;
  Scaling scaling = Scaling::tolerance;
  PlannerOptions planner;
  bool candidates_alone = false;  ///< as RunOptions
  bool other_numbers = false;     ///< as RunOptions
  ProofLimits proof{};
  std::optional<RobustSpec> robust{};  ///< drawn robots; none where the purpose asks for none
  std::shared_ptr<const Cell> cell{};
  std::vector<Variant> variants{};     ///< at least one; no columns yet
  const VariantSpec* truth = nullptr;  ///< the variant that may be the case; null: none
  int truth_line = 0;                  ///< that names it
  Configurations measured{};
  Configurations fixed{};  ///< still to be measured, in any plan: known to the search beside the measured ones
  std::optional<PoseList> candidates_from{};  ///< none: candidates are drawn
  std::vector<std::string> fixed_notes{};     ///< on the reading of the list of fixed poses

  const Variant& first() const { return variants.front(); }
};

/// Use of a resolved problem, which decides the keys of the design that count.
enum class Purpose {
  plan,   ///< of a whole list: number of poses, fixed poses, drawn robots
  list,   ///< a list that is judged: drawn robots; it brings its own number of poses
  search  ///< searches and judgements for the nominal robot, by the number of poses if the design has one
};
/// Throws InputError with the line for contradictions, for lists that do not fit, for fixed poses that the workspace
/// forbids.
Setup resolve(const Problem& problem, const RunOptions& run, const Monitor& monitor, Purpose purpose = Purpose::search);

/// Throws InputError where the design has no number of poses, or auto without all that it needs.
void require_number_of_poses(const Problem& problem);

}  // namespace posewright
