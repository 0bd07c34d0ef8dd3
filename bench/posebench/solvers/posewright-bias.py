"""posewright by criterion bias."""
import _posewright

_posewright.plan("bias")
