#pragma once

#include <vector>

#include "posewright/search/search.hpp"

namespace posewright {

/// Designs of other numbers of poses, for the figures that so many reach: no bound, and each a local optimum. The one
/// of the next size begins with the poses of the one before, less those that Φ misses least or with the best more, and
/// takes swaps of one pose as long as they gain.
/// @param request  of the given design; its method, kicks and restarts do not count, its spacing is that of the parts
/// @param members  of the given design: indices into the parts' blocks
/// @param sizes    numbers of poses ≥ 1
/// @return for each size the indices of its poses, ascending; none where they determine not all parameters, where so
///         many do not fit, or after a stop
std::vector<std::vector<int>> designs_of_sizes(std::vector<SearchPart> parts, const SearchRequest& request,
                                               const std::vector<int>& members, const std::vector<int>& sizes,
                                               const Monitor& monitor);

}  // namespace posewright
