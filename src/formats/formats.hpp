#pragma once

#include "posewright/formats/pose_formats.hpp"

/// One function a format; the table is in registry.cpp.
namespace posewright::formats {

PoseFormat kuka_krl();
PoseFormat abb_rapid();
PoseFormat fanuc_tp();
PoseFormat urscript();
PoseFormat yaskawa_inform();
PoseFormat staubli_val3();
PoseFormat hexapod_gcs();
PoseFormat robot_calibration();
PoseFormat figaroh();
PoseFormat figaroh_csv();
PoseFormat pybotics_npy();
PoseFormat pybotics_csv();
PoseFormat moveit();
PoseFormat industrial_calibration();
PoseFormat industrial_hand_eye();
PoseFormat easy_handeye2();
PoseFormat easy_handeye2_on_base();
PoseFormat delmia();
PoseFormat robodk_csv();
PoseFormat joint_trajectory();
PoseFormat srdf();
PoseFormat plain_csv();
PoseFormat plain_json();
PoseFormat targets_csv();
PoseFormat spatial_analyzer();
PoseFormat powerinspect();

}  // namespace posewright::formats
