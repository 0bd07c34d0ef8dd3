"""Sets of measured robots: blocks of the nominal arm for the solvers, errors at held-out poses for the judge (numpy, own kinematics).

A set is a problem file with its URDF, and the readings as `posewright calibrate` reads them. Each joint has a frame of six
parameters before it; base and tool, or targets, are estimated as well. Lengths m, angles rad."""
import csv
import pathlib
import subprocess
import sys
import xml.etree.ElementTree as xml

import numpy as np
import yaml

UNITS = {"m": 1, "mm": 1e-3, "um": 1e-6, "rad": 1, "mrad": 1e-3, "deg": np.pi / 180}
LENGTH, ANGLE = 0.5e-3, 0.9e-3  # typical errors of an arm, the units of its columns


def number(value):
    """A quantity of a problem file: 0.1, or "100 mm"."""
    if not isinstance(value, str):
        return float(value)
    figure, unit = value.split()
    return float(figure) * UNITS[unit]


def numbers(values):
    return np.array([number(v) for v in values])


def skew(v):
    K = np.zeros(v.shape[:-1] + (3, 3))
    K[..., 0, 1], K[..., 0, 2], K[..., 1, 2] = -v[..., 2], v[..., 1], -v[..., 0]
    return K - np.swapaxes(K, -1, -2)


def turned(v):
    """Rotations of rotation vectors (Rodrigues)."""
    angle = np.linalg.norm(v, axis=-1)[..., None, None]
    K = skew(v)
    safe = np.where(angle < 1e-12, 1, angle)
    return np.eye(3) + np.sin(angle) / safe * K + (1 - np.cos(angle)) / safe ** 2 * (K @ K) + (angle < 1e-12) * K


def turn_of(R):
    """Rotation vectors of rotations below half a turn."""
    angle = np.arccos(np.clip((np.trace(R, axis1=-2, axis2=-1) - 1) / 2, -1, 1))[..., None]
    axis = np.stack([R[..., 2, 1] - R[..., 1, 2], R[..., 0, 2] - R[..., 2, 0], R[..., 1, 0] - R[..., 0, 1]], -1) / 2
    return axis * np.where(angle < 1e-9, 1, angle / np.maximum(np.sin(angle), 1e-12))


def from_rpy(angles):
    roll, pitch, yaw = angles
    return turned(np.array([0, 0, yaw])) @ turned(np.array([0, pitch, 0])) @ turned(np.array([roll, 0, 0]))


def from_quaternion(x, y, z, w):
    v = np.array([x, y, z])
    return np.eye(3) + 2 * w * skew(v) + 2 * skew(v) @ skew(v)


def chain(urdf, tip=None):
    """Names, frames before, axes of the moving joints from the root to the tip, and the frame of the tip behind the last."""
    joints = {j.find("child").get("link"): j for j in xml.parse(urdf).getroot().iter("joint") if j.find("child") is not None}
    ends = set(joints) - {j.find("parent").get("link") for j in joints.values()}
    link, path = tip or ends.pop(), []
    while link in joints:
        path.insert(0, joints[link])
        link = joints[link].find("parent").get("link")
    names, frames, axes, R, p = [], [], [], np.eye(3), np.zeros(3)
    for joint in path:
        origin = joint.find("origin")
        word = lambda key: [float(v) for v in (origin.get(key, "0 0 0") if origin is not None else "0 0 0").split()]  # noqa: E731
        p, R = p + R @ word("xyz"), R @ from_rpy(word("rpy"))
        if joint.get("type") == "fixed":
            continue
        names.append(joint.get("name"))
        frames.append((R, p))
        axes.append([float(v) for v in joint.find("axis").get("xyz").split()])
        R, p = np.eye(3), np.zeros(3)
    return names, frames, np.array(axes), (R, p)


class Arm:
    """The model of a problem file, with readings of points or of poses."""

    def __init__(self, problem):
        spec = yaml.safe_load(problem.read_text(encoding="utf-8"))
        robot, measurement = spec["robot"], spec["measurement"]
        self.names, self.frames, self.axes, self.tool = chain(problem.parent / robot["urdf"], robot.get("tip"))
        placement = robot.get("placement", {})
        self.base = (from_rpy(numbers(placement.get("rpy", [0, 0, 0]))), numbers(placement.get("position", [0, 0, 0])))
        self.pose = measurement["type"] == "pose"
        self.labels = [] if self.pose else list(measurement["targets"])
        self.targets = np.array([numbers(measurement["targets"][name]) for name in self.labels])
        self.joints = len(self.names)
        self.count = 6 * (self.joints + 1) + (6 if self.pose else self.targets.size)

    def tip(self, x, q):
        R, p = np.broadcast_to(self.base[0], (len(q), 3, 3)), np.broadcast_to(self.base[1], (len(q), 3))

        def move(R, p, turn, shift):
            return R @ turn, p + R @ shift
        R, p = move(R, p, turned(x[3:6]), x[:3])
        for j, (turn, shift) in enumerate(self.frames):
            d = x[6 + 6 * j:12 + 6 * j]
            R, p = move(*move(R, p, turn, shift), turned(d[3:]), d[:3])
            R = R @ turned(q[:, j, None] * self.axes[j])
        return move(R, p, *self.tool)

    def residual(self, x, q, readings):
        """Readings less model: n × rows."""
        R, p = self.tip(x, q)
        own = x[6 * (self.joints + 1):]
        if not self.pose:
            points = np.einsum("nab,kb->nka", R, self.targets + own.reshape(-1, 3)) + p[:, None]
            return (readings - points).reshape(len(q), -1)
        R, p = R @ turned(own[3:]), p + R @ own[:3]
        return np.hstack([readings[1] - p, turn_of(readings[0] @ np.swapaxes(R, 1, 2))])

    def linear(self, x, q, readings):
        h = 1e-6 * np.eye(self.count)
        J = [(self.residual(x - k, q, readings) - self.residual(x + k, q, readings)) / 2e-6 for k in h]
        return self.residual(x, q, readings), np.stack(J, 2)


def table_of(files):
    """Header, and for each pose its rows as written: several rows of one id are repeats."""
    header, poses = None, []
    for file in files:
        with open(file, newline="", encoding="utf-8") as lines:
            header, *rows = csv.reader(lines)
        last = None
        for row in rows:
            if row[0] != last:
                poses.append([])
            poses[-1].append(row[1:])
            last = row[0]
    return header[1:], poses


class Measured:
    """One set: candidates that may be fitted, poses that judge, by folds of its file NAME.split.csv."""

    def __init__(self, description, root, data, folder):
        self.description, self.folder = description, folder
        self.problem = root / description["problem"]
        self.arm = Arm(self.problem)
        script = root / description["convert"]
        several = len(description["readings"]) > 1
        subprocess.run([sys.executable, script, data, folder if several else folder / description["readings"][0]], check=True)
        self.header, self.rows = table_of([folder / name for name in description["readings"]])
        self.read()
        with open(description["path"].with_suffix(".split.csv"), newline="", encoding="utf-8") as file:
            self.fold = np.zeros(len(self.rows), int)
            for row in csv.DictReader(file):
                self.fold[int(row["pose"]) - 1] = int(row["fold"])
        self.noise = np.array(description["noise"])
        self.linearise()

    def read(self):
        mean = np.array([np.mean([[float(v) for v in row] for row in pose], 0) for pose in self.rows])
        at = {word.split(" ")[0]: i for i, word in enumerate(self.header)}
        self.q = mean[:, [at[name] for name in self.arm.names]]
        if not self.arm.pose:
            self.readings = np.stack([mean[:, [at[f"{name}.{axis}"] for axis in "xyz"]] for name in self.arm.labels], 1)
            return
        turn = np.array([from_quaternion(*row) for row in mean[:, [at[f"pose.q{axis}"] for axis in "xyzw"]]])
        self.readings = (turn, mean[:, [at[f"pose.{axis}"] for axis in "xyz"]])

    def linearise(self):
        """Blocks at the nominal arm, which solvers see; blocks and residuals near the fit of all poses, which the judge takes."""
        arm, at = self.arm, np.zeros(self.arm.count)
        unit = np.full(arm.count, LENGTH)
        for frame in range(arm.joints + 1 + arm.pose):
            unit[6 * frame + 3:6 * frame + 6] = ANGLE
        r, nominal = arm.linear(at, self.q, self.readings)
        s = np.linalg.svd((nominal * unit / self.noise[:, None]).reshape(-1, arm.count), compute_uv=False)
        rank = (s > 3e-6 * s[0]).sum()  # axes that are parallel in the nominal arm only would add weak directions near the fit
        raw = nominal
        for _ in range(6):
            J = (raw * unit / self.noise[:, None]).reshape(-1, arm.count)
            U, s, Vt = np.linalg.svd(J, full_matrices=False)
            step = Vt[:rank].T @ (U[:, :rank].T @ (r / self.noise).reshape(-1) / s[:rank])
            at = at + unit * step
            r, raw = arm.linear(at, self.q, self.readings)
            if np.abs(step).max() < 1e-6:
                break
        V = Vt[:rank].T
        self.raw = nominal
        self.blocks = (nominal * unit / self.noise[:, None]) @ V
        self.near, self.left = (raw * unit / self.noise[:, None]) @ V, r / self.noise
        flat = np.zeros(arm.count)
        flat[:6] = flat[6 + 6 * arm.joints:] = 1  # base, tool and targets may be anywhere
        self.known = V.T @ ((1 - flat)[:, None] * V)
        self.nuisance = np.linalg.svd(V[flat == 1].T, full_matrices=False)[0]
        self.nominal = -V.T @ (at / unit)  # the nominal arm, counted from that fit
        self.m = rank
        self.tips = arm.tip(at, self.q)[1]

    def folds(self):
        return [(np.flatnonzero(self.fold != k), np.flatnonzero(self.fold == k)) for k in range(1, self.fold.max() + 1)]

    def squares(self, theta, poses):
        """Squared distances between reading and prediction, one for each point, mm²."""
        miss = (self.left[poses] - self.near[poses] @ theta) * self.noise
        miss = miss[:, :3] if self.arm.pose else miss
        return 1e6 * (miss.reshape(-1, 3) ** 2).sum(1)

    def table(self, poses, path):
        """The rows of these poses as `calibrate` reads them; ids count from 1 in this order."""
        with open(path, "w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(["id"] + self.header)
            writer.writerows([k + 1] + row for k, pose in enumerate(poses) for row in self.rows[pose])
        return path
