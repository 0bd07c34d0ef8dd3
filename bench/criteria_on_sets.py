#!/usr/bin/env python3
"""bench/criteria_on_sets.py DATA [--criteria A,B] [--sets WORD] [--program POSEWRIGHT]

The criteria of bench/criteria_for_robots.py on the four public sets of measured robots: error at poses that were not
fitted, of the plain fit, against 200 random subsets. They judge; no setting was chosen by them."""
import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import tomllib

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
import numpy as np  # noqa: E402

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "posebench"))
import criteria_for_robots as plans  # noqa: E402
import measured  # noqa: E402


class Measured(plans.Problem):
    """A set of posebench as a pool of candidates: planned by the nominal robot, judged near the fit of everything."""

    def __init__(self, s):
        self.set, arm = s, s.arm
        self.judges = s.folds()[0][1] if s.description["name"] == "ur5" else None
        keep = np.arange(len(s.q)) if self.judges is None else s.folds()[0][0]
        self.kept = keep
        low, high = s.q.min(0), s.q.max(0)

        class Pool:
            q = s.q[keep]
            f = np.hstack([np.cos(s.q[keep]), np.sin(s.q[keep])])

            @staticmethod
            def along(j):
                return s.raw[keep][:, :, 9 + 6 * j:12 + 6 * j] @ arm.axes[j] / s.noise

        Pool.arm = type("A", (), {"sliding": np.zeros(arm.joints, bool), "limits": np.c_[low, high], "joints": arm.joints})
        self.pool, self.J = Pool, s.blocks[keep]
        self.n, self.r, self.m = self.J.shape
        self.known = self.weak = 1e-6 * np.eye(self.m)
        self.nuisance = s.nuisance
        if arm.pose:
            self.shift, self.there, self.place = np.eye(6)[:, :3], np.eye(3), self.J[:, :3]
        else:
            self.shift = self.there = np.tile(np.eye(3), (self.r // 3, 1))
            self.place = self.J
        self.finish()

    def error(self, S):
        J = self.set.near[S].reshape(-1, self.m)
        theta = np.linalg.solve(J.T @ J + 1e-9 * np.eye(self.m), J.T @ self.set.left[S].reshape(-1))
        others = self.judges if self.judges is not None else np.setdiff1d(np.arange(self.n), S)
        return np.sqrt(self.set.squares(theta, others).mean())


NAMES = ("ur5", "fanuc", "franka", "positioner")


def planned(program, s, kept, folder, N):
    """The program's choice of a criterion, and the members among the kept poses of its plan of N, all parameters estimated."""
    variant = "geometric" if s.description["name"] == "ur5" else "everything"
    made = subprocess.run([program, "plan", s.problem, "--candidates-from", s.table(kept, folder / "poses.csv"), "--poses", str(N), "--json", "-o",
                           "-", "--poses-csv", "-", "--quiet", "--threads", "1", "--variant", variant, "--criterion", "auto"],
                          check=True, capture_output=True, text=True)
    plan = json.loads(made.stdout)
    return plan["criterion"]["name"], [int(pose["listed"]["id"]) - 1 for pose in plan["poses"]]


def sets(data, words, folder):
    here = pathlib.Path(__file__).resolve().parent
    for name in NAMES:
        path = here / "posebench" / "data" / f"{name}.toml"
        description = dict(tomllib.loads(path.read_text(encoding="utf-8")), path=path, name=name)
        if words.lower() in name:
            yield measured.Measured(description, here.parent, data / description["folder"], folder)


def compare(s, options, folder):
    problem = Measured(s)
    name = s.description["name"]
    print(f"{name}: {problem.n} poses, {problem.m} parameters", flush=True)
    if problem.judges is not None:
        print(f"  all fitted: {problem.error(np.arange(problem.n)):.4f} mm")
    table = plans.criteria(problem)
    rng = np.random.default_rng(0)
    for N in s.description["poses"]:
        subsets = [rng.choice(problem.n, N, replace=False) for _ in range(200)]
        random = np.array([problem.error(S) for S in subsets])
        start = plans.exchange(table["o1"], subsets[0])
        print(f"  N = {N}: random median {np.median(random):.4f} mm; error, random subsets that are better:")
        for word, criterion in table.items():
            if options.criteria and word not in options.criteria.split(","):
                continue
            error = problem.error(plans.exchange(criterion, start))
            print(f"    {word:14s} {error:.4f}  {100 * (random < error).mean():3.0f} %", flush=True)
        if options.program:
            criterion, members = planned(options.program, s, problem.kept, folder, N)
            error = problem.error(members)
            print(f"    posewright     {error:.4f}  {100 * (random < error).mean():3.0f} %  ({criterion})", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--criteria", default="")
    parser.add_argument("--sets", default="")
    parser.add_argument("--program", help="plans of this program by criterion auto, too")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        for s in sets(options.data, options.sets, pathlib.Path(folder)):
            compare(s, options, pathlib.Path(folder))


if __name__ == "__main__":
    main()
