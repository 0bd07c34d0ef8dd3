"""As much of rclpy as the example's node calls, in one process and one thread; the test's world turns while it spins.

The names and their order are those of rclpy's documentation (Humble). That the real ones do the same is not tested."""
from __future__ import annotations

from typing import Any, Callable

worlds: list[Callable[[Any], None]] = []  # each is called with the node at every turn


def init(*, signal_handler_options: Any = None) -> None: ...
def try_shutdown() -> None: ...


def spin_once(node: Any, *, timeout_sec: float | None = None) -> None:
    for world in worlds:
        world(node)


def spin_until_future_complete(node: Any, future: Any, timeout_sec: float | None = None) -> None:
    for _ in range(20):
        if future.done():
            return
        spin_once(node)
