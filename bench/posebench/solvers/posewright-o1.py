"""posewright by criterion o1."""
import _posewright

_posewright.plan("o1")
