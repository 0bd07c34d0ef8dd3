"""posewright by criterion test_pose."""
import _posewright

_posewright.plan("test_pose")
