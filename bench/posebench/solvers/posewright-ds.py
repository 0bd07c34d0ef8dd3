"""posewright by criterion ds."""
import _posewright

_posewright.plan("ds")
