"""Forward kinematics of a URDF's chain by products of transforms."""
import xml.etree.ElementTree as xml

import numpy as np


def turn(axis, angle):
    """Rodrigues."""
    x, y, z = axis
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    T = np.eye(4)
    T[:3, :3] += np.sin(angle) * K + (1 - np.cos(angle)) * K @ K
    return T


def placed(x, y, z, roll, pitch, yaw):
    T = turn((0, 0, 1), yaw) @ turn((0, 1, 0), pitch) @ turn((1, 0, 0), roll)
    T[:3, 3] = x, y, z
    return T


def rigid(position, xyzw):
    x, y, z, w = xyzw
    sine = np.linalg.norm([x, y, z])
    T = turn(np.array([x, y, z]) / sine, 2 * np.arctan2(sine, w)) if sine > 0 else np.eye(4)
    T[:3, 3] = position
    return T


def chain_of(urdf, tip="tool0"):
    """Joints of a URDF from its root to the link `tip`: name, moves, origin, axis."""
    joints = {joint.find("child").get("link"): joint for joint in xml.fromstring(urdf.encode()).findall("joint")}
    link, chain = tip, []
    while link in joints:
        joint = joints[link]
        origin, axis = joint.find("origin"), joint.find("axis")
        numbers = lambda name: [float(v) for v in (origin.get(name) if origin is not None and origin.get(name) else "0 0 0").split()]
        chain.insert(0, (joint.get("name"), joint.get("type") != "fixed", placed(*numbers("xyz"), *numbers("rpy")),
                         [float(v) for v in axis.get("xyz").split()] if axis is not None else [1, 0, 0]))
        link = joint.find("parent").get("link")
    return chain


def forward(chain, q, off=None):
    """@param off  by joint: dx dy dz rx ry rz of its frame and its zero position"""
    T, angles = np.eye(4), iter(q)
    for name, moves, origin, axis in chain:
        T = T @ origin
        if not moves:
            continue
        d = off[name] if off else np.zeros(7)
        T = T @ placed(*d[:6]) @ turn(axis, next(angles) + d[6])
    return T
