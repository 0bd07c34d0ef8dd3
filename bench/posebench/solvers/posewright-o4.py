"""posewright by criterion o4."""
import _posewright

_posewright.plan("o4")
