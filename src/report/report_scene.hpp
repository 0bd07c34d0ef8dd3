#pragma once

#include <filesystem>
#include <map>
#include <vector>

#include "posewright/cell/drawing.hpp"
#include "posewright/report/report.hpp"

namespace posewright {

/// Fills what the report draws: bodies, stations, targets, and the robot at every pose and, along a route, between
/// them.
/// @param poses  configuration of each pose of the plan by its id
/// @param route_file  empty: there is no route
/// Throws InputError for a route that names poses or coordinates that are not there.
void fill_scene(Report& report, const Drawing& drawing, const std::vector<std::pair<int, std::vector<double>>>& poses,
                const std::vector<Coordinate>& coordinates, const std::filesystem::path& route_file);

/// Drawing of one configuration.
ReportKeyframe keyframe_at(const Drawing& drawing, std::span<const double> q);

/// u and v (px) of every point of a camera's board; empty where it does not read or they cannot be predicted.
/// @param instrument  the camera in a list; empty: it is the only instrument
/// @param count       points of its board
std::vector<Eigen::Vector2d> predicted_pixels(const IdentificationModel& model, const std::string& instrument,
                                              std::size_t count, std::span<const double> q);

}  // namespace posewright
