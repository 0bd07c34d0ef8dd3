#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "posewright/lists/pose_list.hpp"
#include "posewright/model/identification_model.hpp"
#include "posewright/support/error.hpp"

namespace posewright {

/// Reads poses.csv as `plan` writes it, any CSV with one column for each coordinate (header: names, maybe with unit, as
/// in `joint_1 [deg]`; other columns are passed over), plan.json, route.json, or a list in the named `format`
/// (formats/pose_formats.hpp). Load case and station go by their labels.
/// Throws InputError with file and line: a column that is missing, a value that is not a number, an unknown label, a
/// value outside `coordinates`, an unknown format.
PoseList read_poses(const std::filesystem::path& file, const std::vector<Coordinate>& coordinates,
                    const std::string& format = "");
/// Overload for text in memory; `name` is the file in messages.
PoseList read_poses_text(std::string text, const std::string& name, const std::vector<Coordinate>& coordinates,
                         const std::string& format = "");

/// Coordinates without limits: measured poses may exceed the limits.
std::vector<Coordinate> without_limits(std::vector<Coordinate> coordinates);

/// True if a value keeps the limits of c, up to rounding.
bool inside(double value, const Coordinate& c);
/// A value that is inside() as the workspace takes it: at a limit that it passes by a hair, at the listed position that
/// it means. What is neither stays.
double as_allowed(double value, const Coordinate& c);
/// Throws InputError for a value that is not inside().
void require_inside(double value, const Coordinate& c, const SourcePlace& place);

/// "FILE: 3 poses are nearer to a limit than proposed poses would be: 4, 9, 12".
std::string margin_note(const std::string& file, const std::vector<int>& ids);

}  // namespace posewright
