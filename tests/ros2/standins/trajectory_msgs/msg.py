from __future__ import annotations

from dataclasses import dataclass, field

from builtin_interfaces.msg import Duration


@dataclass(kw_only=True)
class JointTrajectoryPoint:
    positions: list[float] = field(default_factory=list)
    velocities: list[float] = field(default_factory=list)
    time_from_start: Duration = field(default_factory=lambda: Duration())


@dataclass(kw_only=True)
class JointTrajectory:
    joint_names: list[str] = field(default_factory=list)
    points: list[JointTrajectoryPoint] = field(default_factory=list)
