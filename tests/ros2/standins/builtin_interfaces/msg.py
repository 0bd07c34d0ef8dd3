from dataclasses import dataclass


@dataclass(kw_only=True)
class Duration:
    sec: int = 0
    nanosec: int = 0

    def __post_init__(self) -> None:
        # As the generated message: int32 and uint32 of less than a second.
        assert isinstance(self.sec, int) and isinstance(self.nanosec, int) and 0 <= self.nanosec < 10**9
