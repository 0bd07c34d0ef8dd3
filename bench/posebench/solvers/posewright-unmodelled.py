"""posewright for a variant that has `unmodelled: auto`."""
import _posewright

_posewright.plan(variant="allowing")
