#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "posewright/tasks/place_stations.hpp"

namespace posewright {

/// Text for the terminal of ranked stations, best first, and the best as a problem file has it.
/// @param ranks  at least one
std::string stations_text(const std::vector<StationRank>& ranks);

/// JSON: schema posewright/stations/1.
nlohmann::ordered_json stations_json(const Problem& problem, const StationOptions& options,
                                     const std::vector<StationRank>& ranks);

}  // namespace posewright
