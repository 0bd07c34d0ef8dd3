#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "posewright/blocks/block_array.hpp"
#include "posewright/model/identification_model.hpp"
#include "posewright/support/monitor.hpp"
#include "posewright/workspace/workspace.hpp"

namespace posewright {

/// Feasible configurations that OMPL's samplers drew besides their results; counted among the rejected.
inline constexpr const char* passed_over_reason = "passed over by the sampler";

/// Position of a candidate in a user's list.
struct ListedRow {
  int index = 0;  ///< zero-based, repeated configurations counted once
  int id = 0;     ///< as the list calls it, or index + 1
  int line = 0;   ///< of its file, where it stands first; 0: not known
};

/// Feasible configurations and why others were not: drawn = feasible + Σ rejected.
struct Configurations {
  std::vector<double> values;  ///< count × dimension, one configuration after the other
  int dimension = 0;
  long drawn = 0;
  std::vector<std::pair<std::string, long>> rejected;  ///< per reason, in the workspace's order
  std::vector<ListedRow> rows{};                       ///< one for each of a user's list; empty: they were drawn

  /// Of a draw.
  static auto fields(auto& own) { return std::tie(own.dimension, own.values, own.drawn, own.rejected); }
  std::size_t count() const { return dimension == 0 ? 0 : values.size() / std::size_t(dimension); }
  std::span<const double> operator[](std::size_t i) const {
    return {values.data() + i * std::size_t(dimension), std::size_t(dimension)};
  }
};

struct SamplingOptions {
  std::size_t count = default_candidates;  ///< wanted
  std::uint64_t seed = 0;
  int threads = 0;
  /// Draws given up after, so that a workspace that is (almost) empty ends with a message.
  std::size_t draws_per_candidate = 400;
};

/// Half of the configurations fill the workspace evenly (Sobol points with Owen scrambling), half lie on its boundary:
/// corners, edges, faces of the box; where a constraint cuts those off, the last feasible point on the way from a
/// feasible one. Optimal poses lie there. Depends on the seed alone.
/// Throws CannotDo if nothing feasible is found, naming the constraint that rejects most. Fewer than wanted are
/// returned where the draws run out.
Configurations sample_configurations(const Workspace& workspace, const SamplingOptions& options,
                                     const Monitor& monitor);

/// Whitened raw blocks of the configurations for the columns `selected`, computed in parallel.
BlockArray build_blocks(const IdentificationModel& model, std::span<const int> selected,
                        const Configurations& configurations, int threads);

}  // namespace posewright
