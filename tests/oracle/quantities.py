"""Values with units, places, rotations and derivatives: what robots and instruments of a problem file have in common.

Lengths in m, angles in rad, forces in N; frames are 4 × 4 matrices."""
import fnmatch
import functools
import math
import re

import numpy as np

from arm import AXES, UNITS, frame

ALL_UNITS = UNITS | {"": 1.0, "nm": 1e-9, "urad": 1e-6, "N": 1.0, "kN": 1e3, "rad/Nm": 1.0, "urad/Nm": 1e-6,
                     "N/m": 1.0, "N/mm": 1e3, "N/um": 1e6}


IDENTITY = np.eye(4)


def si(value):
    """A number, or a text such as "1.3 mm"; YAML takes 1e-3 for a text, too."""
    if not isinstance(value, str):
        return float(value)
    number, unit = re.fullmatch(r"\s*([-+]?[\d.]+(?:[eE][-+]?\d+)?)\s*(\S*)\s*", value).groups()
    return float(number) * ALL_UNITS[unit]


def vector(values):
    return np.array([si(value) for value in values])


def turn(axis, angle):
    """Rotation about a unit axis: R = cos I + sin [axis]× + (1 - cos) axis axisᵀ."""
    x, y, z = axis
    c, s = math.cos(angle), math.sin(angle)
    d = 1 - c
    return np.array([[c + d * x * x, d * x * y - s * z, d * x * z + s * y],
                     [d * x * y + s * z, c + d * y * y, d * y * z - s * x],
                     [d * x * z - s * y, d * y * z + s * x, c + d * z * z]])


def turn_rpy(roll, pitch, yaw):
    """About the fixed axes x, y, z in turn, as in URDF."""
    return turn((0, 0, 1), yaw) @ turn((0, 1, 0), pitch) @ turn((1, 0, 0), roll)


def placement(spec):
    """A frame from {position, rpy}, from a position alone, or from nothing."""
    if spec is None:
        return np.eye(4)
    if isinstance(spec, dict):
        return frame(vector(spec.get("position", [0, 0, 0])), turn_rpy(*vector(spec.get("rpy", [0, 0, 0]))))
    return frame(vector(spec))


@functools.cache
def axes_of(name):
    return tuple(f"{name}.{axis}" for axis in AXES)


def displacement(values, name):
    """The small displacement NAME.{x, y, z, rx, ry, rz} of a frame in its own axes: Trans(x, y, z) Rz Ry Rx."""
    amounts = [values[axis] for axis in axes_of(name)]
    return frame(amounts[:3], turn_rpy(*amounts[3:])) if any(amounts) else IDENTITY


def six(name):
    """The names of a displacement with their nominal value: none."""
    return {axis: 0.0 for axis in axes_of(name)}


def stands_at(name, X):
    """Where a frame stands, along its own axes: a plan's nominal values count displacements from there."""
    return dict(zip(axes_of(name)[:3], X[:3, :3].T @ X[:3, 3]))


def point(X, p):
    return X[:3, :3] @ p + X[:3, 3]


def rotation_vector(R):
    """Axis times angle of a small rotation."""
    v = np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]]) / 2
    sine = np.linalg.norm(v)
    return v if sine == 0 else v * (np.arctan2(sine, (np.trace(R) - 1) / 2) / sine)


def slope(f, step):
    """Derivative of f at 0 by central differences over one and two steps, so that the error is of the step's fourth power."""
    return (8 * (f(step) - f(-step)) - (f(2 * step) - f(-2 * step))) / (12 * step)


def fine_slope(f, step):
    """The same with the error of the step's sixth power, for steps that are not small (Richardson)."""
    return (16 * slope(f, step) - slope(f, 2 * step)) / 15


def slopes(f, size, step=2e-4):
    """Derivative of f by each of its `size` arguments, as columns."""
    return np.array([slope(lambda h: f(h * direction), step) for direction in np.eye(size)]).T


def matching(names, pattern):
    """Those that a glob of * and ? matches."""
    pattern = pattern.replace("[", "[[]")
    return [name for name in names if fnmatch.fnmatchcase(name, pattern)]
