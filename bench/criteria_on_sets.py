#!/usr/bin/env python3
"""bench/criteria_on_sets.py DATA [--criteria A,B] [--sets WORD] [--program POSEWRIGHT]

The criteria of bench/criteria_for_robots.py on the four public sets of measured robots: error at poses that were not
fitted, of the plain fit, against 200 random subsets. They judge; no setting was chosen by them."""
import argparse
import csv
import json
import os
import pathlib
import subprocess
import sys
import tempfile

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
import numpy as np  # noqa: E402

import criteria_for_robots as plans  # noqa: E402
import ensemble  # noqa: E402


def skew(v):
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def turned(v):
    angle = np.linalg.norm(v)
    return np.eye(3) if angle < 1e-15 else ensemble.rotation(v / angle, np.array([angle]))[0]


def turn_of(R):
    """Rotation vector."""
    angle = np.arccos(np.clip((np.trace(R) - 1) / 2, -1, 1))
    axis = np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]])
    return axis / 2 if angle < 1e-9 else axis * angle / (2 * np.sin(angle))


def frame(R=np.eye(3), p=(0, 0, 0)):
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = R, p
    return T


def rpy(r, p, y):
    z, x = np.array([0, 0, 1.0]), np.array([1.0, 0, 0])
    return turned(y * z) @ turned(p * np.array([0, 1.0, 0])) @ turned(r * x)


class Set:
    """Chain with a frame before each joint, readings of points or poses, noise of each row."""

    def __init__(self, name, q, fixed, axes, base, tool, readings, noise, numbers, pose, targets=None, judges=None):
        self.__dict__.update(locals())
        self.joints = q.shape[1]
        self.count = 6 * (self.joints + 1) + (6 if pose else 3 * len(targets))

    def tip(self, x, q):
        M = self.base @ frame(turned(x[3:6]), x[:3])
        for j in range(self.joints):
            d = x[6 + 6 * j:12 + 6 * j]
            M = M @ self.fixed[j] @ frame(turned(d[3:]), d[:3]) @ frame(turned(self.axes[j] * q[j]))
        return M

    def residual(self, x, i):
        """Reading less model."""
        M, own = self.tip(x, self.q[i]), x[6 * (self.joints + 1):]
        if not self.pose:
            points = (self.targets + own.reshape(-1, 3)) @ M[:3, :3].T + M[:3, 3]
            return self.readings[i].reshape(-1) - points.reshape(-1)
        M = M @ self.tool @ frame(turned(own[3:]), own[:3])
        return np.r_[self.readings[i][:3, 3] - M[:3, 3], turn_of(self.readings[i][:3, :3] @ M[:3, :3].T)]

    def linear(self, x):
        r = np.array([self.residual(x, i) for i in range(len(self.q))])
        J = np.empty(r.shape + (self.count,))
        for k in range(self.count):
            h = np.zeros(self.count)
            h[k] = 1e-6
            J[:, :, k] = [(self.residual(x - h, i) - self.residual(x + h, i)) / 2e-6 for i in range(len(self.q))]
        return r, J


def sets(data):
    h = np.pi / 2
    z, y, x = np.array([0, 0, 1.0]), np.array([0, 1.0, 0]), np.array([1.0, 0, 0])
    ur = [np.genfromtxt(data / "ur5_gts3800" / f, delimiter=",", skip_header=1) for f in ("grid.csv", "random.csv")]
    both = np.vstack(ur)
    a, d = [0, -.425, -.39225, 0, 0, 0], [.089159, 0, 0, .10915, .09465, .0823]
    alpha = [h, 0, 0, h, -h, 0]
    before = [frame()] + [frame(p=(0, 0, d[i])) @ frame(p=(a[i], 0, 0)) @ frame(turned(alpha[i] * x)) for i in range(5)]
    yield Set("UR5", np.deg2rad(both[:, 7:13]), before, [z] * 6, frame(), frame(), (both[:, 1:4] - both[:, 4:7]) / 1e3,
              np.full(3, 1e-4), (15, 20, 30, 60), False, np.array([[0, 0, .0823 + .031003]]),
              np.arange(len(ur[0]), len(both)))

    def numbers(name):
        return np.array([[float(v) for v in row] for row in csv.reader(open(data / "fanuc_r2000" / name)) if row])
    q = numbers("fanuc_q.csv")[::10]
    points = np.hstack([numbers(f"fanuc_m{k}.csv") for k in "ABC"]).reshape(24, 10, 9).mean(1)
    yield Set("FANUC", q, [frame(), frame(rpy(0, -h, 0), (.312, 0, 0)), frame(rpy(0, h, 0), (1.075, 0, 0)),
                           frame(p=(1.28, 0, .225)), frame(), frame()], [z, y, -y, -x, -y, -x],
              frame(p=(-.558, -.563, .561)), frame(), points, np.full(9, .082e-3), (6, 8, 10, 12), False,
              np.array([[.416, -.017, .060], [.420, .057, -.016], [.420, -.044, -.042]]))
    rows = list(csv.DictReader(open(data / "franka_realsense_board" / "measurements.csv")))
    q = np.array([[float(r[f"q{i}_rad"]) for i in range(1, 8)] for r in rows])
    seen = []
    for r in rows:
        M = np.eye(4)
        M[:3] = [[float(r[f"cam_{i}{j}"]) for j in range(4)] for i in range(3)]
        seen.append(M)
    yield Set("Franka", q, [frame(p=(0, 0, .333)), frame(rpy(-h, 0, 0)), frame(rpy(h, 0, 0), (0, -.316, 0)),
                            frame(rpy(h, 0, 0), (.0825, 0, 0)), frame(rpy(-h, 0, 0), (-.0825, .384, 0)),
                            frame(rpy(h, 0, 0)), frame(rpy(h, 0, 0), (.088, 0, 0))], [z] * 7,
              frame(p=(-.66, .59, .01)), frame(p=(0, 0, .107)), seen, np.r_[[.8e-3] * 3, [2e-3] * 3], (8, 12, 20, 40), True)
    rows = list(csv.DictReader(open(data / "rosi_two_axis_positioner" / "measurements.csv")))
    q = np.array([[float(r["j1_rad"]), float(r["j2_rad"])] for r in rows])
    seen = []
    for r in rows:
        w, i, j, k = np.array([float(r[n]) for n in ("qw", "qx", "qy", "qz")])
        v = np.array([i, j, k])
        R = np.eye(3) + 2 * w * skew(v) + 2 * skew(v) @ skew(v)
        seen.append(frame(R, [float(r[n]) for n in ("x_m", "y_m", "z_m")]))
    yield Set("positioner", q, [frame(), frame(rpy(-h, 0, 0))], [z, z], frame(rpy(h, 0, 0), (0, -.587, .590)),
              frame(rpy(1.57, -.2, -2.96), (-.636, -.177, .034)), seen, np.r_[[.23e-3] * 3, [.5e-3] * 3], (4, 6, 10, 20), True)


class Measured(plans.Problem):
    """A set as a pool of candidates: planned by the nominal robot, judged near the fit of everything."""

    def __init__(self, s):
        unit = np.tile([.5e-3] * 3 + [.9e-3] * 3, s.joints + 3)[:s.count]
        at = np.zeros(s.count)
        r, raw = s.linear(at)
        nominal = raw
        for _ in range(4):
            J = (raw * unit / s.noise[:, None]).reshape(-1, s.count)
            U, sv, Vt = np.linalg.svd(J, full_matrices=False)
            k = (sv > 3e-6 * sv[0]).sum()
            step = Vt[:k].T @ (U[:, :k].T @ (r / s.noise).reshape(-1) / sv[:k])
            at = at + unit * step
            r, raw = s.linear(at)
            if np.abs(step).max() < 1e-6:
                break
        self.judges = s.judges
        keep = np.arange(len(s.q)) if s.judges is None else np.arange(s.judges[0])
        low, high = s.q.min(0), s.q.max(0)

        class Pool:
            arm = type("A", (), {"sliding": np.zeros(s.joints, bool), "limits": np.c_[low, high], "joints": s.joints})
            q = s.q[keep]
            f = np.hstack([np.cos(s.q[keep]), np.sin(s.q[keep])])

            @staticmethod
            def along(j):
                return nominal[keep][:, :, 9 + 6 * j:12 + 6 * j] @ s.axes[j] / s.noise

        self.pool = Pool
        V = Vt[:k].T
        self.J = (nominal[keep] * unit / s.noise[:, None]) @ V
        self.n, self.r, self.m = self.J.shape
        self.known = self.weak = 1e-6 * np.eye(self.m)
        flat = np.zeros(s.count)
        flat[:6] = flat[6 + 6 * s.joints:] = 1
        self.nuisance = np.linalg.svd(V[flat == 1].T, full_matrices=False)[0]
        if s.pose:
            self.shift, self.there, self.place = np.eye(6)[:, :3], np.eye(3), self.J[:, :3]
        else:
            self.shift = self.there = np.tile(np.eye(3), (self.r // 3, 1))
            self.place = self.J
        self.finish()
        self.near, self.left = (raw * unit / s.noise[:, None]) @ V, r / s.noise
        self.noise, self.pose = s.noise, s.pose

    def error(self, S):
        J = self.near[S].reshape(-1, self.m)
        theta = np.linalg.solve(J.T @ J + 1e-9 * np.eye(self.m), J.T @ self.left[S].reshape(-1))
        others = self.judges if self.judges is not None else np.setdiff1d(np.arange(self.n), S)
        miss = (self.left[others] - self.near[others] @ theta) * self.noise
        miss = miss[:, :3] if self.pose else miss
        return 1e3 * np.sqrt((miss ** 2).sum() / (len(others) * miss.shape[1] / 3))


EXAMPLES = {"FANUC": ("fanuc_r2000", "fanuc_r2000"), "Franka": ("franka_board", "franka_realsense_board"),
            "positioner": ("rosi_positioner", "rosi_two_axis_positioner")}


def planned(program, name, data, N):
    """Members of the program's plan of N of the set's poses, all parameters estimated."""
    example, folder = EXAMPLES[name]
    here = pathlib.Path(__file__).resolve().parent.parent / "examples/real_data" / example
    with tempfile.TemporaryDirectory() as place:
        poses = pathlib.Path(place) / "poses.csv"
        subprocess.run([sys.executable, here / "convert.py", data / folder, poses], check=True)
        with open(poses, newline="", encoding="utf-8") as file:
            ids = list(dict.fromkeys(row[0] for row in list(csv.reader(file))[1:]))
        made = subprocess.run([program, "plan", here / "problem.yaml", "--candidates-from", poses, "--poses", str(N),
                               "--json", "-o", "-", "--poses-csv", "-", "--quiet", "--threads", "1", "--variant",
                               "everything", "--criterion", "bias"], check=True, capture_output=True, text=True)
    return [ids.index(str(pose["listed"]["id"])) for pose in json.loads(made.stdout)["poses"]]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--criteria", default="")
    parser.add_argument("--sets", default="")
    parser.add_argument("--program", help="plans of this program by criterion bias, too")
    options = parser.parse_args()
    for s in sets(options.data):
        if options.sets not in s.name:
            continue
        problem = Measured(s)
        print(f"{s.name}: {problem.n} poses, {problem.m} parameters", flush=True)
        if s.judges is not None:
            print(f"  all fitted: {problem.error(np.arange(problem.n)):.4f} mm")
        table = plans.criteria(problem)
        rng = np.random.default_rng(0)
        for N in s.numbers:
            subsets = [rng.choice(problem.n, N, replace=False) for _ in range(200)]
            random = np.array([problem.error(S) for S in subsets])
            start = plans.exchange(table["o1"], subsets[0])
            print(f"  N = {N}: random median {np.median(random):.4f} mm; error, random subsets that are better:")
            for name, criterion in table.items():
                if options.criteria and name not in options.criteria.split(","):
                    continue
                error = problem.error(plans.exchange(criterion, start))
                print(f"    {name:14s} {error:.4f}  {100 * (random < error).mean():3.0f} %", flush=True)
            if options.program and s.name in EXAMPLES:
                error = problem.error(planned(options.program, s.name, options.data, N))
                print(f"    posewright     {error:.4f}  {100 * (random < error).mean():3.0f} %", flush=True)


if __name__ == "__main__":
    main()
