"""posewright by criterion o3."""
import _posewright

_posewright.plan("o3")
