#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "posewright/blocks/read_blocks.hpp"
#include "posewright/planning/evaluate.hpp"
#include "posewright/problem/problem.hpp"
#include "posewright/results/plan.hpp"
#include "posewright/search/spread_search.hpp"
#include "posewright/support/monitor.hpp"
#include "posewright/support/workers.hpp"

namespace posewright {

struct SelectOptions {
  std::optional<int> rows;  ///< r; needed for CSV and two-dimensional arrays
  int poses = 0;
  std::string criterion = "o1", method = "exchange";
  int nuisance = 0;             ///< how many leading columns are nuisance
  std::optional<int> restarts;  ///< 10, or as many as a time limit allows
  Repeats repeats;
  /// Blocks that are in the plan whatever the search finds, `poses` counts them; and blocks that are measured already,
  /// to which `poses` more come. Neither is chosen again unless repeats are allowed.
  std::vector<int> fixed, measured;
  /// For branch_and_bound: it ends once no plan is better by more than this share; 0: proved to rounding.
  double gap = 0.0;
  bool reserve = false;  ///< optimise for the loss of the worst single block
  std::uint64_t seed = 0;
  int threads = 0;
};

/// Search on the user's whitened Jacobian blocks. Tolerances are unknown here, so parameters
/// have tolerance 1 and the indices are those of the blocks as they are.
/// Throws InputError for options that do not fit the blocks (fixed ones out of range, twice, or as many as poses) or
/// each other (a gap and another method), CannotDo for too few poses.
/// @param blocks  with the columns' names; `rows` of the options is not looked at
Plan select_blocks(BlockFile blocks, const SelectOptions& options, const Monitor& monitor);
/// Overload for a file.
Plan select_blocks(const std::filesystem::path& file, const SelectOptions& options, const Monitor& monitor);

/// Variant for a .npy file with blocks spread over processes, each with its share (search_spread()).
/// @param traffic  data sent between the processes
/// Throws InputError, on every process alike, for unsupported options: criteria other than o1 and ds, methods
/// other than exchange and greedy, nuisance columns, fixed or measured blocks, a reserve, restarts, as many poses as
/// candidates.
Plan select_spread(const std::filesystem::path& file, const SelectOptions& options, Workers& workers,
                   const Monitor& monitor, SpreadTraffic& traffic);

/// Value of chosen blocks by a criterion in its own terms (docs/plan-file.md).
/// @param evaluation  of the same blocks
/// @param nuisance    leading columns that are nuisance
/// @param scale       unit of every column for criteria that depend on it; empty: 1
/// @param prior       information that is there before, raw (m × m); empty: none
/// Throws InputError for a criterion that needs more than blocks.
double value_of_blocks(const std::string& criterion, const BlockArray& blocks, const Evaluation& evaluation,
                       int nuisance, const Eigen::VectorXd& scale = {}, const Eigen::MatrixXd& prior = {});

}  // namespace posewright
