#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "posewright/workspace/candidates.hpp"

namespace posewright {

/// Name of a draw in a ResultStore, by all that decides it; empty: it is not known, or a draw takes no time.
std::string name_of_draw(const Workspace& workspace, const SamplingOptions& options);

std::string bytes_of(const Configurations& drawn);
/// What bytes_of() wrote; none where it cannot be a draw from this workspace.
std::optional<Configurations> kept_configurations(std::string_view bytes, const Workspace& workspace);

}  // namespace posewright
