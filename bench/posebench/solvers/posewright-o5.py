"""posewright by criterion o5."""
import _posewright

_posewright.plan("o5")
