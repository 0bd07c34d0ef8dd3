#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "posewright/model/identification_model.hpp"

namespace posewright {

/// Configurations as a user lists them, with a weight where the file has one.
struct PoseList {
  std::vector<std::vector<double>> configurations;
  std::vector<double> weights;       ///< as many, or none
  std::vector<bool> measured{};      ///< of a plan: which poses were there before it
  std::vector<int> ids{};            ///< of a plan or route; else 1, 2, …
  std::vector<std::string> notes{};  ///< what the user must know of how the file was read
};

/// Reads poses.csv as `plan` writes it, any CSV with one column for each coordinate (header: names, maybe with unit, as
/// in `joint_1 [deg]`; other columns are passed over), plan.json, route.json, or a list in the named `format`
/// (outputs/pose_formats.hpp). Load case and station go by their labels.
/// Throws InputError with file and line: a column that is missing, a value that is no number, an unknown label, a
/// value outside `coordinates`, an unknown format.
PoseList read_poses(const std::filesystem::path& file, const std::vector<Coordinate>& coordinates,
                    const std::string& format = "");

}  // namespace posewright
