#pragma once

#include <nlohmann/json.hpp>

#include "posewright/problem/problem.hpp"

namespace posewright {

/// Nominal position of the robot's base in the measurement frame, x, y, z in m; null for a robot without one.
nlohmann::ordered_json base_json(const Problem& problem);

/// Obstacles as a map needs them: name and the points whose convex hull the body is, m, measurement frame; no points
/// for planes and meshes. Bodies of the instruments themselves are left out: they stand where the map is asked for.
nlohmann::ordered_json obstacles_json(const Problem& problem);

}  // namespace posewright
