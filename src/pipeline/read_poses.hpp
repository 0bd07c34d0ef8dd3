#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "posewright/model/identification_model.hpp"

namespace posewright {

/// Configurations as a user lists them, with a weight where the file has one.
struct PoseList {
  std::vector<std::vector<double>> configurations;
  std::vector<double> weights;   ///< as many, or none
  std::vector<bool> measured{};  ///< of a plan: which poses were there before it; empty for CSV
};

/// Reads poses.csv as `plan` writes it, any CSV with one column for each coordinate (header: names, maybe with unit, as
/// in `joint_1 [deg]`; other columns are passed over), or plan.json. Load case and station go by their labels.
/// Throws InputError with file and line: a column that is missing, a value that is no number, an unknown label, a
/// value outside `coordinates`.
PoseList read_poses(const std::filesystem::path& file, const std::vector<Coordinate>& coordinates);

/// Cells of a CSV line (RFC 4180 quotes).
std::vector<std::string> csv_cells(const std::string& line);

}  // namespace posewright
