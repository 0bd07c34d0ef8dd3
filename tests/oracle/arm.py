"""A serial arm and what its reflectors read, by definition alone: forward kinematics multiplied out, differences, covariances.

Nothing here is taken from the program. Lengths in m, angles in rad, frames as 4 × 4 matrices."""
import xml.etree.ElementTree

import numpy as np

UNITS = {"mm": 1e-3, "um": 1e-6, "m": 1.0, "deg": np.pi / 180, "mrad": 1e-3, "rad": 1.0}


def si(value):
    if not isinstance(value, str):
        return float(value)
    number, unit = value.split()
    return float(number) * UNITS[unit]


def rotation(axis, angle):
    x, y, z = np.asarray(axis, float) / np.linalg.norm(axis)
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K


def frame(xyz=(0, 0, 0), R=np.eye(3)):
    X = np.eye(4)
    X[:3, :3], X[:3, 3] = R, xyz
    return X


def rpy(r, p, y):
    return rotation((0, 0, 1), y) @ rotation((0, 1, 0), p) @ rotation((1, 0, 0), r)


def displaced(values):
    """A small displacement (x, y, z, rx, ry, rz) of a frame, in its own axes."""
    return frame(values[:3], rpy(*values[3:]))


def joints_of(urdf, tip, base=None):
    """From base (default: the root) to tip: name, frame in its parent, axis (None where it is fixed), whether it is passed
    from its child to its parent."""
    by_child = {j.find("child").get("link"): j for j in xml.etree.ElementTree.parse(urdf).getroot().iter("joint")}

    def to_root(link):
        found = []
        while link in by_child:
            found.append(by_child[link])
            link = by_child[link].find("parent").get("link")
        return found

    up, down, chain = to_root(base), to_root(tip), []
    for joint in [j for j in up if j not in down] + [j for j in reversed(down) if base is None or j not in up]:
        origin, axis = joint.find("origin"), joint.find("axis")
        numbers = {key: [float(x) for x in ((origin.get(key) if origin is not None else None) or "0 0 0").split()] for key in ("xyz", "rpy")}
        moves = joint.get("type") != "fixed"
        chain.append((joint.get("name"), frame(numbers["xyz"], rpy(*numbers["rpy"])),
                      [float(x) for x in axis.get("xyz").split()] if moves else None, joint in up))
    return chain


AXES = ["x", "y", "z", "rx", "ry", "rz"]


def readings(chain, targets, q, change, off=np.zeros(6)):
    """Positions of all targets; `change`: parameter name → what it differs by from its nominal value; `off`: how far the
    tip stands off, a translation and a rotation about itself in the axes of the measurement frame."""
    of = lambda name: [change.get(f"{name}.{axis}", 0.0) for axis in AXES]
    X, k = displaced(of("base")), 0
    for name, X_ParentJoint, axis, up in chain:
        X_ParentChild = X_ParentJoint @ displaced(of(name))
        if axis is not None:
            gear = 1 + change.get(f"{name}.gear", 0.0)
            X_ParentChild = X_ParentChild @ frame(R=rotation(axis, q[k] * gear + change.get(f"{name}.offset", 0.0)))
            k += 1
        X = X @ (np.linalg.inv(X_ParentChild) if up else X_ParentChild)
    X = X @ displaced(of("tool"))
    X[:3, 3] += off[:3]
    if np.any(off[3:]):
        X[:3, :3] = rotation(off[3:], np.linalg.norm(off[3:])) @ X[:3, :3]
    points = [np.append(p + [change.get(f"target.{n}.{a}", 0.0) for a in "xyz"], 1) for n, p in targets.items()]
    return np.concatenate([(X @ p)[:3] for p in points])


def derivative(f, size, h=1e-5):
    """Central differences of f by each of its `size` arguments."""
    return np.array([(f(h * e) - f(-h * e)) / (2 * h) for e in np.eye(size)]).T


def covariance_at(problem, chain, targets, q):
    """Of all readings at q: the instrument's over the repeats; one displacement of the tip, common to all; the joints'."""
    measurement = problem["measurement"]
    noise = si(measurement["device"]["noise"]) / np.sqrt(measurement.get("repeats", 1))
    V = noise**2 * np.eye(3 * len(targets))
    stays = measurement.get("repeatability", 0)
    stays = stays if isinstance(stays, dict) else {"position": stays}
    size = np.repeat([si(stays["position"]), si(stays.get("rotation", 0))], 3)
    A = derivative(lambda off: readings(chain, targets, q, {}, off), 6) * size
    J = derivative(lambda step: readings(chain, targets, np.add(q, step), {}), len(q)) * si(problem["robot"].get("encoder_noise", 0))
    return V + A @ A.T + J @ J.T
