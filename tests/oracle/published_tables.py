"""What the page of the telescope states of its geometry and of the signs of Δux, by loop equations and least squares alone:
published_tables.py PROGRAM SOURCE. From the program comes only how many of its candidates are within the stroke."""
import itertools
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np
import yaml
from scipy.optimize import least_squares

from parallel_robots import SixLegs

BOX = np.array([2e-3, 2e-3, 0.2e-3, *np.radians([1, 1, 1])])
STROKE = 1.3e-3
PUBLISHED_SIGNS = [-1, 1, 1, -1, 1, -1]  # Δux of Table II(a)


def robot_of(source, name):
    return SixLegs(yaml.safe_load((source / "examples/telescope" / name).read_text())["robot"])


def travel(robot, pose):
    return np.abs(robot.actuators(pose, robot.nominal)).max()


def worst_error(robot, pose):
    """m: the largest way of the platform's centre when every actuator is off by +1 or -1 µm."""
    legs, rho = robot.legs_of(robot.nominal), robot.actuators(pose, robot.nominal)
    difference = lambda f, x, h: np.array([(f(x + s) - f(x - s)) / (2 * h) for s in h * np.eye(6)]).T
    by_pose = difference(lambda x: robot.loops(x, rho, legs), np.array(pose), 1e-6)
    by_actuators = difference(lambda r: robot.loops(pose, r, legs), rho, 1e-6)
    moved = -np.linalg.solve(by_pose, by_actuators) @ (1e-6 * np.array(list(itertools.product((-1, 1), repeat=6))).T)
    return np.linalg.norm(moved[:3], axis=0).max()


def geometry(source):
    rng, found = np.random.default_rng(3), {}
    for name in ("problem.yaml", "within_stroke.yaml"):
        robot = robot_of(source, name)
        corners = BOX * list(itertools.product((-1, 1), repeat=6))
        flat = [corner * [1, 1, 1, 1, 1, 0] for corner in corners[::2]]
        draws = rng.uniform(-1, 1, (1000, 6)) * BOX
        found[name] = {"corners": [travel(robot, c) for c in corners], "flat": [travel(robot, c) for c in flat],
                       "share": np.mean([travel(robot, d) <= STROKE for d in draws]),
                       "error": max(worst_error(robot, c) for c in [*corners[::7], np.zeros(6)])}
    return found


def check_page(source, found):
    """The row of each file in the page's Table I."""
    for name, ours in found.items():
        row = re.search(rf"^\| `{name}` \|.*$", (source / "docs/reproduction-telescope.md").read_text(), re.M)[0].split(" | ")
        flat, full = map(float, row[2].split(", "))
        assert abs(flat - 1e3 * max(ours["flat"])) < 0.006 and abs(full - 1e3 * max(ours["corners"])) < 0.006, (row, ours)
        within = (sum(t <= STROKE for t in ours["flat"]), sum(t <= STROKE for t in ours["corners"]))
        assert tuple(map(int, re.findall(r"(\d+) of", row[3]))) == within, (row, within)
        assert abs(float(re.findall(r"(\d+) %", row[4])[1]) / 100 - ours["share"]) < 0.04, (row, ours["share"])
        assert abs(float(row[6].split()[0]) - 1e6 * ours["error"]) < 0.05, (row, ours["error"])


def six_signs(source):
    """Readings of a telescope whose platform gives way by the published K, fitted leg by leg (eq. 13) without it."""
    spec = yaml.safe_load((source / "examples/telescope/problem.yaml").read_text())
    robot = SixLegs(spec["robot"])
    truth = robot.nominal | spec["variants"]["matrix"]["nominal"]
    rows = np.loadtxt(source / "examples/telescope/planned.csv", delimiter=",", skiprows=1)
    poses, stand = [], []
    for q in rows[:, 1:7]:
        rho = robot.actuators(q, robot.nominal)
        solved = least_squares(lambda x: 1e3 * robot.loops(np.array(x) * BOX, rho, robot.legs_of(truth)), q / BOX, xtol=1e-15, ftol=1e-15, gtol=1e-15)
        poses.append(robot.platform(solved.x * BOX))
        stand.append(rho)
    found = []
    for i in range(6):
        def g(x):
            a, b = np.array([x[0], x[1], 0]), np.array([x[2], x[3], 0])
            u = np.array([x[4], 0, np.sqrt(1 - x[4] ** 2)])
            return [1e3 * (x[5] - np.linalg.norm(X[:3, 3] + X[:3, :3] @ b - a - rho[i] * u)) for X, rho in zip(poses, stand)]
        start = [robot.nominal[f"leg_{i + 1}.{key}"] for key in ("ax", "ay", "bx", "by", "ux", "l")]
        found.append(least_squares(g, start, x_scale=[1e-3] * 4 + [1e-2, 1e-3], xtol=1e-14, ftol=1e-14, gtol=1e-14).x[4])
    return found


def counted(program, source, name):
    """How many configurations the program draws, and how many of them it finds feasible."""
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run([program, "plan", source / "examples/telescope" / name, "--candidates", "1000", "--poses", "8", "--restarts", "1", "--method",
                               "exchange", "--proof-time", "0", "--quiet", "-o", f"{folder}/p.json", "--poses-csv", "-"], capture_output=True, text=True, check=True)
    return tuple(map(int, re.search(r"Candidates: (\d+) drawn, (\d+) feasible", done.stdout).groups()))


def main(program, source):
    source = pathlib.Path(source).resolve()
    found = geometry(source)
    check_page(source, found)
    assert max(found["within_stroke.yaml"]["corners"]) <= STROKE
    assert max(found["problem.yaml"]["flat"]) > 4 * STROKE
    drawn, feasible = counted(program, source, "within_stroke.yaml")
    assert drawn == feasible == 1000, (drawn, feasible)
    ux = six_signs(source)
    assert [np.sign(u) for u in ux] == PUBLISHED_SIGNS, ux
    print(", ".join(f"{u:.3f}" for u in ux), {name: f"{100 * f['share']:.1f} %" for name, f in found.items()})


main(*sys.argv[1:])
