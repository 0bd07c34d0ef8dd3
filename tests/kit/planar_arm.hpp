#pragma once

/// A planar 2R arm as URDF text: links 1 m and 0.8 m, joints q1 and q2 within ±2 rad.
namespace posewright {

inline constexpr const char* planar_arm_urdf =
    "<robot name=\"arm\"><link name=\"l0\"/><link name=\"l1\"/><link name=\"l2\"/><link name=\"tip\"/>"
    "<joint name=\"q1\" type=\"revolute\"><parent link=\"l0\"/><child link=\"l1\"/><axis xyz=\"0 0 1\"/>"
    "<limit lower=\"-2\" upper=\"2\" effort=\"1\" velocity=\"1\"/></joint>"
    "<joint name=\"q2\" type=\"revolute\"><parent link=\"l1\"/><child link=\"l2\"/><origin xyz=\"1 0 0\"/>"
    "<axis xyz=\"0 0 1\"/><limit lower=\"-2\" upper=\"2\" effort=\"1\" velocity=\"1\"/></joint>"
    "<joint name=\"end\" type=\"fixed\"><parent link=\"l2\"/><child link=\"tip\"/><origin xyz=\"0.8 0 0\"/></joint>"
    "</robot>";

}  // namespace posewright
