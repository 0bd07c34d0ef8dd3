from __future__ import annotations

from trajectory_msgs.msg import JointTrajectory


class _Goal:
    def __init__(self) -> None:
        self.trajectory = JointTrajectory()


class FollowJointTrajectory:
    Goal = _Goal
