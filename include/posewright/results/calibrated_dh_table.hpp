#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "posewright/model/dh_table.hpp"
#include "posewright/results/calibration.hpp"

namespace posewright {

std::vector<CalibratedValue> estimated_values(const Calibration& calibration);
/// The table of a calibrated serial arm; none without a convention.
std::optional<DhTable> dh_table_of(const Problem& problem, const Calibration& calibration,
                                   std::optional<DhConvention> convention);

/// The table as a person reads it, mm and degrees to 1e-6: order of the motions, rows, frames at both ends, what has no
/// place in it.
std::string dh_table_text(const DhTable& table);

/// JSON in SI to the last digit. Frames as position and quaternion (x, y, z, w); `beta` null if there is none.
nlohmann::ordered_json dh_table_json(const DhTable& table);

}  // namespace posewright
