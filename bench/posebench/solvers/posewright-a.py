"""posewright by criterion a."""
import _posewright

_posewright.plan("a")
