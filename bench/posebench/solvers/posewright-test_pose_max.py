"""posewright by criterion test_pose_max."""
import _posewright

_posewright.plan("test_pose_max")
