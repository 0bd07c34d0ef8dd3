"""posewright with its default criterion."""
import _posewright

_posewright.plan()
