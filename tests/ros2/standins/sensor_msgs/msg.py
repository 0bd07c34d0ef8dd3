from dataclasses import dataclass, field


@dataclass(kw_only=True)
class JointState:
    name: list[str] = field(default_factory=list)
    position: list[float] = field(default_factory=list)
