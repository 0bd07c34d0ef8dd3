"""posewright by criterion o2."""
import _posewright

_posewright.plan("o2")
