#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

#include "posewright/results/plan.hpp"
#include "posewright/support/table.hpp"

namespace posewright {

/// "Nearest to each other: gun and table, 12 mm apart at pose 3." of poses or motions; empty if none has a distance.
/// @param where  what follows, of the entry where they are nearest
template <class Entry, class Where>
std::string nearest_text(const std::vector<Entry>& entries, const Where& where) {
  const Entry* nearest = nullptr;
  for (const Entry& entry : entries)
    if (entry.nearest && (nearest == nullptr || entry.nearest->distance < nearest->nearest->distance)) nearest = &entry;
  if (nearest == nullptr) return {};
  const BodyDistance& bodies = *nearest->nearest;
  return fmt::format("Nearest to each other: {} and {}, {} apart {}.\n", bodies.first, bodies.second,
                     shown_value(bodies.distance, "m"), where(*nearest));
}

}  // namespace posewright
