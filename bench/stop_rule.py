#!/usr/bin/env python3
"""Does what `posewright next` says when it stops hold?  stop_rule.py PROGRAM OUT.jsonl [--robots 1000]

Each drawn robot is measured in the loop: next poses, readings of the true robot with noise, next poses, … until `next` says that
the required error is reached, or 40 poses. A flat curve ends no loop here, so that *reached* is tested with more poses, too.
Readings and the true error at the test poses after compensation are computed by a second program of the robot's definition
(tests/oracle), which knows nothing of the fit. One line a robot is appended to OUT.jsonl; started again, it goes on where it was.
With --effects each robot also misses by an effect that the model lacks, so many times the noise in turn: gears (sines of each
joint, which turn it) and a smooth displacement of the tip. Exit status 1 if the claim "error <= required" is false for more than
5 % of the robots of one size (and three standard errors of so many robots)."""
import argparse
import concurrent.futures
import json
import math
import pathlib
import subprocess
import sys
import tempfile

SOURCE = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(SOURCE / "tests" / "oracle"))
try:
    import numpy as np
    import yaml

    from experiment import Experiment
    from quantities import point
except ImportError as error:
    print(f"skipped: {error.name} is absent (Debian: python3-numpy, python3-yaml)")
    sys.exit(77)

EXAMPLE = SOURCE / "examples" / "kr270"
VARIANT = "geometric"
TEST_POSES, CANDIDATES, FIRST, MOST = 20, 500, 6, 40
FEW, EACH, LATER = 20, 2, 5  # poses of a step, up to FEW measured and beyond
REQUIRED = (0.08e-3, 0.12e-3, 0.2e-3, 0.4e-3, 0.8e-3)  # m, in turn; the last two with effects alone
NOISE = 0.1e-3 / math.sqrt(3)  # m: the problem's, three repeats
LOWER, UPPER = np.radians([-100, -110, -60, -150, -90, -200]), np.radians([100, -30, 60, 150, 90, 200])
# Where an effect has its size, and is no parameter's: that many poses between the joints' limits.
POOL, LIMITS = 250, np.radians([[-183, -144, -118, -348, -123, -348], [183, -2, 153, 348, 123, 348]])
# 1σ of what differs from the nominal robot: lengths m, angles rad. Tolerances that the program assumes, and where things stand.
TOLERANCE, STANDS = (0.5e-3, math.radians(0.05)), {"base": (5e-3, math.radians(0.3)), "target": (1e-3, 0.0)}


def write_problem(folder):
    """The example with places where accuracy counts; what the next poses maximise is left to the program."""
    problem = yaml.safe_load((EXAMPLE / "problem.yaml").read_text())
    problem["robot"]["urdf"] = str(EXAMPLE / problem["robot"]["urdf"])
    problem["variants"] = {VARIANT: problem["variants"][VARIANT]}
    chance = np.random.default_rng(270)
    places = chance.uniform(LOWER, UPPER, (TEST_POSES, 6))
    problem["design"] = {"variant": VARIANT, "poses": FIRST, "candidates": CANDIDATES,
                         "test_poses": {"at": [[float(x) for x in q] for q in places]}}
    file = folder / "problem.yaml"
    file.write_text(yaml.safe_dump(problem))
    return file, places


class DrawnRobot:
    """One robot and its instrument, by definition."""

    def __init__(self, file, places, seed, noise):
        problem = yaml.safe_load(file.read_text())
        self.experiment = Experiment(problem, file.parent, problem["variants"][VARIANT])
        self.names, self.places = self.experiment.robot.coordinates, places
        self.chance, self.noise = np.random.default_rng([seed, 22]), noise
        self.true = dict(self.experiment.nominal)
        own = self.experiment.own_names
        for name in problem["variants"][VARIANT]["parameters"]:
            self.draw(own.get(name, name), TOLERANCE)
        for name in list(self.true):
            if name.split(".")[0] in STANDS:
                self.draw(name, STANDS[name.split(".")[0]])

    def draw(self, name, sizes):
        turns = name.endswith(("rx", "ry", "rz", "offset"))
        self.true[name] += sizes[1 if turns else 0] * self.chance.standard_normal()

    def read(self, q):
        y = self.moved(q)
        return y + self.noise * self.chance.standard_normal(len(y))

    def moved(self, q):
        return self.experiment.readings(self.experiment.visit(self.names, self.turned(q)), self.true) + np.tile(
            self.shift(q), len(self.experiment.instrument.targets))

    def turned(self, q):
        return q if self.size == 0 else q + self.scale * self.gears(q)

    def shift(self, q):
        return np.zeros(3) if self.size == 0 else self.scale * self.smooth(q)

    def draw_effect(self, size, fitted):
        """An effect of RMS `size` along an axis beside all that the fitted columns take up; `best`: they with that."""
        self.size, chance = size, self.chance
        self.best = dict(self.true)
        if size == 0:
            return
        n = len(self.names)
        cycles, phase, high = chance.integers(1, 9, n), chance.uniform(0, 2 * np.pi, n), chance.normal(size=n)
        length = math.radians(chance.uniform(20, 120))
        waves, offset = chance.normal(size=(2 * n, 200)) / length, chance.uniform(0, 2 * np.pi, 200)
        weight = chance.normal(size=(200, 3)) * math.sqrt(2 / 200)
        share = chance.uniform()
        self.gears = lambda q: share * high * np.sin(cycles * np.asarray(q) + phase)
        self.smooth = lambda q: (1 - share) * np.cos(np.concatenate([np.cos(q), np.sin(q)]) @ waves + offset) @ weight
        self.scale = 1e-5
        pool, J, columns = fitted
        moved = np.concatenate([self.moved(q) for q in pool]) - readings_of(self.experiment, pool, self.true)
        x = np.linalg.lstsq(J, moved, rcond=None)[0]
        factor = size / np.sqrt(np.mean((moved - J @ x)**2))
        self.scale *= factor
        for c, own in zip(columns, x):
            self.best[c] += factor * own

    def missed(self, q):
        """The tip beside the best that the fitted columns give, in the measurement frame."""
        def tip(values, at):
            return point(self.experiment.robot.tip(self.experiment.visit(self.names, at), values), np.zeros(3))
        return tip(self.true, self.turned(q)) + self.shift(q) - tip(self.best, q)

    def place(self, values, q):
        """The tip in the robot's own base."""
        values = {name: self.experiment.nominal[name] if name.startswith(("base.", "tool.")) else value for name, value in values.items()}
        return point(self.experiment.robot.tip(self.experiment.visit(self.names, q), values), np.zeros(3))

    def error(self, estimates):
        """Root mean square over the test poses of how far the calibrated robot is from the true one."""
        found = dict(self.experiment.nominal)
        for e in estimates:
            found[e["name"]] = e["value"] - self.experiment.stands.get(e["name"], 0.0)
        return math.sqrt(np.mean([np.sum((self.place(found, q) - self.place(self.best, q) - self.missed(q))**2)
                                  for q in self.places]))


def readings_of(experiment, pool, values):
    return np.concatenate([experiment.readings(experiment.visit(experiment.robot.coordinates, q), values) for q in pool])


def fitted_columns(program, file):
    """Poses, the readings' derivatives there by each column that `next` fits, and the columns' names."""
    done = subprocess.run([program, "observe", file, "--json", "--quiet"], capture_output=True, text=True, check=True)
    names = [p["name"] for p in json.loads(done.stdout)["variants"][0]["parameters"]]
    problem = yaml.safe_load(file.read_text())
    experiment = Experiment(problem, file.parent, problem["variants"][VARIANT])
    names = [experiment.own_names.get(name, name) for name in names]
    pool = np.random.default_rng(5).uniform(*LIMITS, (POOL, len(experiment.robot.coordinates)))
    J = []
    for name in names:
        beside = [readings_of(experiment, pool, {**experiment.nominal, name: experiment.nominal[name] + h}) for h in (1e-6, -1e-6)]
        J.append((beside[0] - beside[1]) / 2e-6)
    return pool, np.stack(J, 1), names


def run_robot(program, file, places, seed, noise_factor, effects, fitted):
    robot = DrawnRobot(file, places, seed, noise_factor * NOISE)
    size = effects[seed % len(effects)]
    required = REQUIRED[seed // len(effects) % (3 if max(effects) == 0 else len(REQUIRED))]
    robot.draw_effect(size * NOISE, fitted)
    targets = robot.experiment.instrument.targets
    with tempfile.TemporaryDirectory(dir=file.parent) as scratch:
        data, count, flat = pathlib.Path(scratch) / "measured.csv", FIRST, None
        with open(data, "w") as out:
            header = ["id"] + [f"{n} [rad]" for n in robot.names] + [f"{t}.{a} [m]" for t in targets for a in "xyz"]
            out.write(",".join(header) + "\n")
        while True:
            done = subprocess.run([program, "next", file, "--data", data, "-k", str(count), "--required",
                                   f"{1e3 * required} mm", "--json", "--quiet", "--threads", "1", "--seed", str(seed)],
                                  capture_output=True, text=True)
            if done.returncode != 0:
                raise RuntimeError(f"robot {seed}: {done.stderr}")
            said = json.loads(done.stdout)
            measured = said["measured"]["poses"]
            if said["verdict"] == "flat" and flat is None:
                flat = measured
            if said["verdict"] == "reached" or measured >= MOST:
                break
            with open(data, "a") as out:
                for pose in said["poses"]:
                    values = [*pose["configuration"], *robot.read(pose["configuration"])]
                    out.write(",".join([str(pose["id"]), *map(repr, map(float, values))]) + "\n")
            measured += len(said["poses"])
            count = EACH if measured < FEW else max(1, min(LATER, MOST - measured))
    now = said["curve"][-1]
    return {"robot": seed, "verdict": said["verdict"], "poses": said["measured"]["poses"], "required": required,
            "expected": now["expected"], "upper": now["upper"], "true": robot.error(said["estimates"]),
            "effect": said["unmodelled"] is not None, "size": size, "flat": flat}


def known(out):
    """What was done before; half a line at the end was being written."""
    if not out.exists():
        return []
    whole = out.read_text().rpartition("\n")[0]
    rows = [json.loads(line) for line in whole.splitlines()]
    out.write_text("".join(json.dumps(row) + "\n" for row in rows))
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("program")
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--robots", type=int, default=1000)
    parser.add_argument("--workers", type=int, default=1)
    parser.add_argument("--noise-factor", type=float, default=1.0, help="the true noise in units of the stated one")
    parser.add_argument("--effects", type=lambda text: tuple(map(float, text.split(","))), default=(0.0,),
                        help="sizes of what the model lacks in units of the stated noise, in turn: 0,0.5,1,2,4")
    parser.add_argument("--anew", action="store_true", help="what was done before does not count")
    options = parser.parse_args()
    if options.anew:
        options.out.unlink(missing_ok=True)
    rows = known(options.out)
    left = sorted(set(range(options.robots)) - {row["robot"] for row in rows})
    with tempfile.TemporaryDirectory() as scratch, open(options.out, "a") as out:
        file, places = write_problem(pathlib.Path(scratch))
        with concurrent.futures.ThreadPoolExecutor(options.workers) as pool:
            program = str(pathlib.Path(options.program).resolve())
            fitted = fitted_columns(program, file) if max(options.effects) > 0 else None
            for row in pool.map(lambda seed: run_robot(program, file, places, seed, options.noise_factor,
                                                           options.effects, fitted), left):
                rows.append(row)
                out.write(json.dumps(row) + "\n")
                out.flush()
    rows = [row for row in rows if row["robot"] < options.robots]
    good = True
    for size in sorted(set(options.effects)):
        good = held_for([row for row in rows if row["size"] == size], size) and good
    sys.exit(0 if good else 1)


def held_for(rows, size):
    """Prints how often the claim is true for effects of one size; whether it is often enough."""
    claims = [row for row in rows if row["verdict"] == "reached"]
    false = sum(row["true"] > row["required"] for row in claims)
    below = sum(row["true"] <= row["upper"] for row in rows)
    poses = sorted(row["poses"] for row in claims)
    print(f"effect of {size:g} times the noise, {len(rows)} robots; {len(claims)} times 'error <= required', false {false} times "
          f"({100 * false / max(1, len(rows)):.1f} % of the robots)"
          + (f", at {poses[0]} to {poses[-1]} poses, median {poses[len(poses) // 2]}" if poses else "")
          + f"; flat before that: {sum(row['flat'] is not None for row in rows)}; true error below the stated limit: {100 * below / max(1, len(rows)):.1f} %")
    return false <= 0.05 * len(rows) + 3 * math.sqrt(0.05 * 0.95 * len(rows))


if __name__ == "__main__":
    main()
