#!/usr/bin/env python3
"""Plan, measure, calibrate, plan on at the calibrated parameters, until the robot is accurate enough.

    examples/sequential/sequential.py --program build/release/bin/posewright --target 0.05

The measurement is a virtual one here (posewright simulate draws the robot and its readings); on site Session.measure is
what changes: measure the poses of poses.csv, add their readings to measured.csv as docs/calibrate.md says.
"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default="posewright", help="posewright (from PATH)")
    parser.add_argument("--problem", default=str(HERE / "problem.yaml"), help="problem file with test_poses")
    parser.add_argument("--target", type=float, default=0.05, help="error at the test poses to reach, 1 sigma, mm (0.05)")
    parser.add_argument("--first", type=int, default=6, help="poses of the first round (6)")
    parser.add_argument("--more", type=int, default=2, help="poses of every further round (2)")
    parser.add_argument("--most", type=int, default=60, help="give up after so many poses (60)")
    parser.add_argument("--seed", type=int, default=1, help="of the virtual robot and its noise (1)")
    return parser.parse_args()


class Session:
    def __init__(self, options, folder):
        self.options, self.folder = options, folder

    def run(self, *words):
        done = subprocess.run([self.options.program, *map(str, words)], cwd=self.folder, capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"{' '.join(map(str, words))}\n{done.stderr}")
        return done.stdout

    def measure(self, poses):
        """Goes to the poses and reads. The virtual robot's parameters and noise depend on the seed and on the order of all
        poses, so what was read before stays as it is. On site, this is the robot and the tracker."""
        every = self.folder / "every.csv"
        lines = (self.folder / poses).read_text().splitlines()
        every.write_text((every.read_text() if every.exists() else lines[0] + "\n") + "\n".join(lines[1:]) + "\n")
        self.run("simulate", self.options.problem, "every.csv", "--draws", 2, "--seed", self.options.seed, "--data", "measured.csv", "--force")


def main():
    options = arguments()
    options.problem = pathlib.Path(options.problem).resolve()
    if "/" in options.program:
        options.program = str(pathlib.Path(options.program).resolve())
    with tempfile.TemporaryDirectory() as name:
        session = Session(options, pathlib.Path(name))
        session.run("plan", options.problem, "--poses", options.first, "-o", "plan.json", "--poses-csv", "poses.csv")
        session.measure("poses.csv")
        poses = options.first
        print("poses  predicted error  residuals  chi-square")
        while True:
            found = json.loads(session.run("calibrate", options.problem, "measured.csv", "-o", "calibrated.yaml", "--json"))
            judged = json.loads(session.run("evaluate", options.problem, "measured.csv", "--parameters", "calibrated.yaml", "--json"))
            error = judged["accuracy"]["rho0"] * 1e3
            rms = next(r["rms"] for r in found["residuals"] if r["kind"] == "distance" and r["parameters"] == "calibrated")
            print(f"{poses:5d}  {error:12.4f} mm  {rms * 1e3:6.3f} mm  p = {found['tests']['chi_square']['probability']:.2f}", flush=True)
            if error <= options.target:
                return 0
            if poses + options.more > options.most:
                print(f"{options.target} mm is not reached with {poses} poses")
                return 1
            session.run("plan", options.problem, "--augment", "measured.csv", "--parameters", "calibrated.yaml", "--poses", options.more,
                        "-o", "plan.json", "--poses-csv", "poses.csv")
            session.measure("poses.csv")
            poses += options.more


sys.exit(main())
