from __future__ import annotations

from typing import Any

servers: dict[str, Any] = {}  # name of the action: the world's controller


class Future:
    def __init__(self, result: Any = None, done: bool = True) -> None:
        self._result, self._done = result, done

    def done(self) -> bool:
        return self._done

    def result(self) -> Any:
        return self._result

    def set_result(self, result: Any) -> None:
        self._result, self._done = result, True


class ActionClient:
    def __init__(self, node: Any, action_type: type, action_name: str) -> None:
        self.name = action_name

    def wait_for_server(self, timeout_sec: float | None = None) -> bool:
        return self.name in servers

    def send_goal_async(self, goal: Any) -> Future:
        return Future(servers[self.name].accept(goal))
