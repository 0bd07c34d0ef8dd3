#pragma once

#include <string>
#include <vector>

#include "posewright/formats/pose_formats.hpp"
#include "posewright/model/identification_model.hpp"

namespace posewright {

/// Adds columns robot.roll, robot.pitch, robot.yaw (GivenPoses) where a table has the orientations of a robot's poses
/// in another form (OrientationColumns). Other tables, and those of robots with joints, stay. Throws InputError with
/// file and line.
void add_pose_coordinates(PoseTable& table, const std::string& file, const std::vector<Coordinate>& coordinates);

}  // namespace posewright
