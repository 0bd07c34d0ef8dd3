"""A route and its trajectory as one trajectory for each motion, from stop to stop. Knows nothing of ROS."""
from __future__ import annotations

import json
from dataclasses import dataclass

import yaml

SAME = 1e-9  # rad or m: the two files state the same numbers


@dataclass(frozen=True)
class Motion:
    """What is sent to the controller at once."""

    pose: int  # id in the plan; 0: home
    points: list[list[float]]  # rad or m, from where it begins to where it ends
    times: list[float]  # s from its begin; the robot is at rest at every point


@dataclass(frozen=True)
class Route:
    names: list[str]
    motions: list[Motion]


def read_route(route_file: str, trajectory_file: str) -> Route:
    """Motions with their times. ValueError says where the two files do not belong together."""
    with open(route_file) as file:
        route = json.load(file)
    if route.get("schema") != "posewright/route/1":
        raise ValueError(f"{route_file} is no route of posewright")
    if not route["from_home"]:
        raise ValueError(f"{route_file} does not begin at home: make it with --from-home")
    with open(trajectory_file) as file:
        trajectory = yaml.safe_load(file)
    names = trajectory["joint_names"]
    if names != route["names"]:
        raise ValueError(f"{trajectory_file} moves {', '.join(names)}, {route_file} moves {', '.join(route['names'])}")
    points = [point["positions"] for point in trajectory["points"]]
    times = [point["time_from_start"]["sec"] + 1e-9 * point["time_from_start"]["nanosec"] for point in trajectory["points"]]
    motions, at = [], 0
    for planned in route["motions"]:
        count = len(planned["points"])
        if not _same(points[at : at + count], planned["points"]):
            raise ValueError(f"{trajectory_file}: point {at + 1} is not where the motion to pose {planned['to']} of {route_file} begins")
        motions.append(Motion(planned["to"], planned["points"], [time - times[at] for time in times[at : at + count]]))
        at += count  # a stop is two points: its begin, which ends a motion, and its end, which begins the next one
    return Route(names, motions)


def _same(points: list[list[float]], planned: list[list[float]]) -> bool:
    return len(points) == len(planned) and all(
        abs(a - b) <= SAME for p, q in zip(points, planned) for a, b in zip(p, q, strict=True))


def farthest(joints: dict[str, float], names: list[str], point: list[float]) -> tuple[str, float]:
    """(joint, distance) of the joint that is farthest from where the point has it; a joint that is not read is infinitely far."""
    return max(((name, abs(joints.get(name, float("inf")) - value)) for name, value in zip(names, point)), key=lambda pair: pair[1])
