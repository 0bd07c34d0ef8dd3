"""What calibrations and criteria are judged with: an arm's readings at many poses at once, their covariance, least squares.

By definition alone: frames multiplied out (joints and frames of arm.py), derivatives by differences. Nothing here is taken
from the program. Lengths in m, angles in rad. `change`: parameter name → what it differs by from its nominal value."""
import fnmatch
import math

import numpy as np
import yaml
from arm import AXES, frame, joints_of, readings, rpy, si
from scipy.optimize import least_squares

STEP = 1e-5  # Of central differences, m or rad: what they miss is some 1e-10 of the derivative.


def displaced(values):
    """arm.displaced, Rz Ry Rx multiplied out, for numbers or for arrays of them."""
    x, y, z, r, p, w = np.broadcast_arrays(*values)
    cr, sr, cp, sp, cw, sw = np.cos(r), np.sin(r), np.cos(p), np.sin(p), np.cos(w), np.sin(w)
    X = np.zeros(x.shape + (4, 4))
    X[..., 0, 0], X[..., 0, 1], X[..., 0, 2], X[..., 0, 3] = cw * cp, cw * sp * sr - sw * cr, cw * sp * cr + sw * sr, x
    X[..., 1, 0], X[..., 1, 1], X[..., 1, 2], X[..., 1, 3] = sw * cp, sw * sp * sr + cw * cr, sw * sp * cr - cw * sr, y
    X[..., 2, 0], X[..., 2, 1], X[..., 2, 2], X[..., 2, 3] = -sp, cp * sr, cp * cr, z
    X[..., 3, 3] = 1
    return X


def turned(axis, angles):
    """Rotations about one axis by many angles (Rodrigues), as frames."""
    x, y, z = np.asarray(axis, float) / np.linalg.norm(axis)
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    X = np.zeros(np.shape(angles) + (4, 4))
    X[..., :3, :3] = np.eye(3) + np.sin(angles)[..., None, None] * K + (1 - np.cos(angles))[..., None, None] * (K @ K)
    X[..., 3, 3] = 1
    return X


class Poses:
    """Where something was read: joint readings, the station's name at each, and over how many readings of a pose two
    readings of it are averaged together: shares[i, a, b] = |lines with a and b| / (|lines with a| · |lines with b|)."""

    def __init__(self, Q, stations=None, shares=None):
        self.Q = np.atleast_2d(np.asarray(Q, float))
        self.stations = list(stations) if stations is not None else [None] * len(self.Q)
        self.shares = shares

    def __getitem__(self, which):
        shares = self.shares[which] if self.shares is not None else None
        return Poses(self.Q[which], [self.stations[i] for i in np.arange(len(self.Q))[which]], shares)


def default_tolerance(name):
    kind, axis = name.split(".")[0], name.split(".")[-1]
    if axis == "gear":
        return 1e-3
    lengths = {"base": 10e-3, "station": 10e-3, "tool": 5e-3, "target": 1e-3}
    if axis in "xyz":
        return lengths.get(kind, 0.5e-3)
    return math.radians(1) if kind in ("base", "station", "tool") else math.radians(0.05)


class Arm:
    def __init__(self, problem_file):
        self.problem = yaml.safe_load(problem_file.read_text())
        robot, self.measurement = self.problem["robot"], self.problem["measurement"]
        self.chain = joints_of(problem_file.parent / robot["urdf"], robot["tip"], robot.get("base"))
        self.joints = [name for name, _, axis, _ in self.chain if axis is not None]
        self.own = robot.get("parameter_names", {})
        self.placement = self.frame_of(robot.get("placement", {}))
        self.targets = {n: np.array([si(v) for v in p]) for n, p in self.measurement["targets"].items()}
        self.stations = {n: self.frame_of(s if isinstance(s, dict) else {"position": s})
                         for n, s in self.measurement["device"].get("stations", {}).items()}
        self.columns = [f"{n}.{a}" for n in self.targets for a in "xyz"]

    @staticmethod
    def frame_of(placement):
        return frame([si(v) for v in placement.get("position", [0, 0, 0])], rpy(*[si(v) for v in placement.get("rpy", [0, 0, 0])]))

    def tolerance(self, name, variant):
        """What the variant says, the last of its entries that fit, else the default, and whether it is stated."""
        for pattern, value in reversed(self.problem["variants"][variant].get("tolerance", {}).items()):
            if fnmatch.fnmatchcase(name, pattern):
                return si(value), True
        return default_tolerance(self.own.get(name, name)), False

    def own_value(self, name):
        """A joint frame stands where the URDF has it: x, y, z are that place along its own axes; a target's are its own."""
        kind, axis = self.own.get(name, name).rsplit(".", 1)
        for joint, X_ParentJoint, _, _ in self.chain:
            if joint == kind and axis in ("x", "y", "z"):
                return float(X_ParentJoint[:3, 3] @ X_ParentJoint[:3, "xyz".index(axis)])
        return float(self.targets[kind[7:]]["xyz".index(axis)]) if kind.startswith("target.") else 0.0

    def nominal(self, variant):
        """By how much the variant stands apart from the robot's own values (exact names only)."""
        return {name: si(value) - self.own_value(name) for name, value in self.problem["variants"][variant].get("nominal", {}).items()}

    def tips(self, Q, change):
        """Frames of the tip, pose by pose; where values of `change` are arrays, for each of their entries."""
        change = {self.own.get(name, name): np.asarray(value)[..., None] for name, value in change.items()}
        of = lambda name: displaced([change.get(f"{name}.{axis}", np.zeros(1)) for axis in AXES])
        X, k = self.placement @ of("base"), 0
        for name, X_ParentJoint, axis, up in self.chain:
            X_ParentChild = X_ParentJoint @ of(name)
            if axis is not None:
                gear = 1 + change.get(f"{name}.gear", np.zeros(1))
                X_ParentChild = X_ParentChild @ turned(axis, Q[:, k] * gear + change.get(f"{name}.offset", np.zeros(1)))
                k += 1
            X = X @ (np.linalg.inv(X_ParentChild) if up else X_ParentChild)
        return X @ of("tool")

    def seen(self, poses, change, tips=None):
        """Readings without noise, pose × target × axis, in the axes of the station that reads."""
        X = self.tips(poses.Q, change) if tips is None else tips
        of = lambda name: [np.asarray(change.get(f"{name}.{axis}", 0.0)) for axis in AXES]
        points = []
        for n, x in self.targets.items():
            p = np.stack(np.broadcast_arrays(*[x[i] + d for i, d in enumerate(of(f"target.{n}")[:3])]), axis=-1)
            points.append((X[..., :3, :3] @ p[..., None, :, None])[..., 0] + X[..., :3, 3])
        points = np.stack(np.broadcast_arrays(*points), axis=-2)
        for name, X_WorldStation in self.stations.items():
            S = (X_WorldStation @ displaced(of(f"station.{name}")))[..., None, None, :, :]
            from_it = [i for i, station in enumerate(poses.stations) if station == name]
            here = points[..., from_it, :, :] - S[..., :3, 3]
            points[..., from_it, :, :] = (here[..., None, :] @ S[..., :3, :3])[..., 0, :]
        return points

    def readings(self, poses, change, tips=None):
        points = self.seen(poses, change, tips)
        return points.reshape(points.shape[:-2] + (-1,))

    def differs_from_arm(self, q, change):
        """How far all this is from arm.py's own way at one pose, without stations: 0 but for rounding."""
        slow = readings(self.chain, self.targets, q, {self.own.get(k, k): v for k, v in change.items()}).reshape(-1, 3)
        slow = slow @ self.placement[:3, :3].T + self.placement[:3, 3]
        return np.abs(self.seen(Poses([q]), change)[0] - slow).max()

    def instrument(self, poses, change):
        """Covariance of one reading of every target, pose × target × 3 × 3, in the station's axes."""
        device, p = self.measurement["device"], self.seen(poses, change)
        one = np.ones(p.shape[:2])[..., None, None]
        if device["type"] == "covariance":
            return one * np.array([[float(v) for v in row] for row in device["matrix"]])
        if device["type"] != "laser_tracker":
            noise = device["noise"] if isinstance(device["noise"], list) else [device["noise"]] * 3
            return one * np.diag([si(v) ** 2 for v in noise])
        says = {k: si(v) for k, v in device.get("noise", {"range": "2.5 um", "range_per_m": "0.075 um", "transverse": "3.75 um",
                                                           "angle": "0.0015 mrad"}).items()}
        R = np.linalg.norm(p, axis=2)[..., None, None]
        along = says.get("range", 0) + says.get("range_per_m", 0) * R
        across = says.get("transverse", 0) + says.get("angle", 0) * R
        beam = p[..., :, None] * p[..., None, :] / R**2
        return along**2 * beam + across**2 * (np.eye(3) - beam)

    def stays(self, poses, change):
        """What moves all readings of a visit, one column for each independent cause of size one: the displacement of the
        tip about itself in the axes of the measurement frame, and the joints' readings. Its covariance is A Aᵀ."""
        stays = self.measurement.get("repeatability", 0)
        stays = stays if isinstance(stays, dict) else {"position": stays}
        size = [si(stays["position"])] * 3 + [si(stays.get("rotation", 0))] * 3
        columns, tips = [], self.tips(poses.Q, change)
        for axis in np.flatnonzero(size):
            ahead, behind = (self.readings(poses, change, displaced_about(tips, d)) for d in STEP * np.eye(6)[axis] * [[1], [-1]])
            columns.append((ahead - behind) / (2 * STEP) * size[axis])
        noise = si(self.problem["robot"].get("encoder_noise", 0))
        for joint in range(len(self.joints) if noise else 0):
            step = STEP * np.eye(len(self.joints))[joint]
            ahead, behind = (self.readings(Poses(poses.Q + d, poses.stations), change) for d in (step, -step))
            columns.append((ahead - behind) / (2 * STEP) * noise)
        return np.array(columns).transpose(1, 2, 0) if columns else np.zeros((len(poses.Q), len(self.columns), 0))

    def covariances(self, poses, change):
        """Of a pose's averaged readings: the instrument's over the repeats, plus what stays at the visit."""
        single, size = self.instrument(poses, change), len(self.columns)
        V = np.zeros((len(poses.Q), size, size))
        for t in range(len(self.targets)):
            V[:, 3 * t:3 * t + 3, 3 * t:3 * t + 3] = single[:, t]
        shares = poses.shares if poses.shares is not None else 1 / self.measurement.get("repeats", 1)
        A = self.stays(poses, change)
        return V * shares + A @ A.transpose(0, 2, 1)


def displaced_about(tips, d):
    X = tips.copy()
    X[:, :3, 3] += d[:3]
    X[:, :3, :3] = displaced([0, 0, 0, *d[3:]])[:3, :3] @ X[:, :3, :3]
    return X


def whitening(V, read):
    """For every pose W with W V Wᵀ = 1 over what was read there, and nothing of what was not."""
    W = np.zeros_like(V)
    for i in range(len(V)):
        there = np.flatnonzero(read[i])
        if len(there):
            W[np.ix_([i], there, there)] = np.linalg.inv(np.linalg.cholesky(V[np.ix_([i], there, there)][0]))
    return W


def derivative(f, x, units):
    """Central differences of f, which takes many x at once, for steps of STEP in m or rad (x counts in `units`)."""
    h = STEP / units
    there = f(np.concatenate([x + np.diag(h), x - np.diag(h)]))
    return ((there[:len(x)] - there[len(x):]) / (2 * h[:, None])).T


def newton(f, x, units, steps):
    """Gauss and Newton's steps while they lead down: past where a sum of squares can tell two points apart. And whether they arrived."""
    for _ in range(steps):
        J, r = derivative(f, x, units), f(x)
        step = np.linalg.lstsq(J, r, rcond=None)[0]
        if np.sum(f(x - step) ** 2) > np.sum(r**2) * (1 + 1e-9):
            return x, J, False
        x = x - step
        if np.abs(step).max() < 1e-9 * (1 + np.abs(x).max()):
            return x, J, True
    return x, J, False


def minimum(f, x, units):
    """Least squares of f, x in the given units, and the Jacobian there."""
    near, J, arrived = newton(f, x, units, 4)
    if arrived:
        return near, J
    x = least_squares(f, x, jac=lambda y: derivative(f, y, units), method="trf", xtol=1e-10, ftol=1e-10, gtol=1e-10, max_nfev=60).x
    return newton(f, x, units, 2)[:2]
