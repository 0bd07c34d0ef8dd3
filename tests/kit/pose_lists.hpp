#pragma once

#include <vector>

#include "posewright/study/variant.hpp"
#include "posewright/workspace/candidates.hpp"

namespace posewright {

/// Configurations evenly through the workspace.
inline std::vector<std::vector<double>> list_of(const Problem& problem, std::size_t count) {
  const Variant variant = make_variant(problem, {}, Monitor{});
  SamplingOptions sampling;
  sampling.count = count;
  sampling.seed = 7;
  const Configurations drawn = sample_configurations(*variant.workspace, sampling, Monitor{});
  std::vector<std::vector<double>> list;
  for (std::size_t i = 0; i < drawn.count(); ++i) list.emplace_back(drawn[i].begin(), drawn[i].end());
  return list;
}

}  // namespace posewright
