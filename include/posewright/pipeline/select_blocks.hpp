#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "posewright/outputs/plan.hpp"
#include "posewright/problem/problem.hpp"
#include "posewright/support/monitor.hpp"

namespace posewright {

struct SelectOptions {
  std::optional<int> rows;  ///< r; needed for CSV and two-dimensional arrays
  int poses = 0;
  std::string criterion = "o1", method = "exchange";
  int nuisance = 0;  ///< how many leading columns are nuisance
  int restarts = 10;
  Repeats repeats;
  bool reserve = false;  ///< maximise what is left when the block that hurts most is lost
  std::uint64_t seed = 0;
  int threads = 0;
};

/// The same search on whitened Jacobian blocks that the user brings. Tolerances are unknown here, so parameters
/// have tolerance 1 and the indices are those of the blocks as they are.
Plan select_blocks(const std::filesystem::path& file, const SelectOptions& options, const Monitor& monitor);

}  // namespace posewright
