#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "posewright/criterion/criterion.hpp"
#include "posewright/planning/approximate_design.hpp"
#include "posewright/planning/configuration_space.hpp"
#include "posewright/planning/workspace_bound.hpp"
#include "posewright/support/monitor.hpp"

namespace posewright {

/// Input of planners: candidates, criterion, budget; no robots.
struct DesignTask {
  CandidateView candidates;
  const Criterion* criterion = nullptr;
  int poses = 0;  ///< N, at most what the repeat policy allows
  /// May be null; a source of good starts, and of promising candidates where its sensitivities are there.
  const ApproximateDesign* approximate = nullptr;
  std::optional<double> bound{};  ///< no design exceeds it (Φ, whitened coordinates)
  /// May be null: then there is nothing beyond the candidates.
  const ConfigurationSpace* space = nullptr;
  /// May be null; its support are configurations worth having.
  const WorkspaceBound* workspace = nullptr;
};

struct PlannerOptions {
  int restarts = 10;  ///< ≥ 1
  int kicks = 50;     ///< ≥ 0: perturbations of each restart's local optimum (iterated local search)
  std::uint64_t seed = 0;
  int threads = 0;           ///< 0 = all
  bool use_all_time = true;  ///< a search goes on until the monitor's deadline, if there is one
  /// ≥ 0: branch_and_bound ends once no design of these candidates is better by more than this share of e^{Φ/h}, h
  /// being Φ's degree. 0: once it is proved to 1e-9 of Φ.
  double gap = 0.0;
  /// Somebody wants so many starts and no more; `auto` takes more than one round of them all the same.
  bool restarts_stated = false;
};

/// Result of a part of a search.
struct SearchStage {
  std::string name;
  double value = 0.0;  ///< Φ of the best design so far, whitened coordinates
  double seconds = 0.0;
};

/// The best exact design found.
struct Design {
  /// N candidate indices, ascending; equal ones only if repeats are allowed. Indices from the number of candidates
  /// on are those of `added`.
  std::vector<int> members;
  std::vector<std::vector<double>> added{};  ///< configurations that were not candidates
  double value = 0.0;                        ///< Φ from a fresh factorisation, whitened coordinates
  int restarts = 0;                          ///< carried out
  long exchanges = 0;                        ///< accepted over all restarts
  bool stopped = false;                      ///< by the monitor, before all was done
  bool optimal = false;                      ///< proved: no design of these candidates is better by more than 1e-9
  /// No design of these candidates exceeds it, by the planner's own proof; none where it proves nothing.
  std::optional<double> bound{};
  std::vector<SearchStage> stages{};
};

/// A search algorithm over sets of N candidates. Works for every criterion.
struct Planner {
  std::string name;  ///< that users write
  std::string summary;
  Design (*search)(const DesignTask& task, const PlannerOptions& options, const Monitor& monitor);

  /// Checks the task, runs the search. At least one start is carried out however early the monitor stops.
  /// Throws std::invalid_argument on a task that contradicts itself, CannotDo if every start stays singular.
  Design plan(const DesignTask& task, const PlannerOptions& options, const Monitor& monitor) const;
};

}  // namespace posewright
