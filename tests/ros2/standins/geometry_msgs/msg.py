from dataclasses import dataclass, field


@dataclass(kw_only=True)
class Point:
    x: float = 0.0
    y: float = 0.0
    z: float = 0.0


@dataclass(kw_only=True)
class PointStamped:
    point: Point = field(default_factory=Point)
