from __future__ import annotations

from typing import Any, Callable

given: dict[str, Any] = {}  # parameters of a launch file or --ros-args


class Parameter:
    def __init__(self, value: Any) -> None:
        self.value = value


class Logger:
    def info(self, text: str) -> None:
        print(text)


class Node:
    def __init__(self, node_name: str) -> None:
        self.topics: dict[str, tuple[type, Callable[[Any], None]]] = {}

    def declare_parameter(self, name: str, value: Any) -> Parameter:
        return Parameter(given.get(name, value))

    def create_subscription(self, msg_type: type, topic: str, callback: Callable[[Any], None], qos_profile: int) -> None:
        self.topics[topic] = (msg_type, callback)

    def get_logger(self) -> Logger:
        return Logger()
