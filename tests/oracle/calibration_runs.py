"""One file of readings, drawn in one of many ways, and what `calibrate` says of it."""
import json
import subprocess

import numpy as np
import yaml

import calibration_problems as drawn


def random_way(random, arm, variant, small):
    """How the data differ from what the problem states, and how they are given and fitted."""
    way = {"options": [], "larger": 1.0, "hidden_shift": 0.0, "independent": False, "missing": 0.0, "lines": 1, "hold": None, "off": 1.0}
    way |= [{}, {}, {"larger": 5.0}, {"hidden_shift": 5e-4}, {"independent": True}][random.integers(5)]
    way["options"] = [[], [], ["--no-prior"], ["--weights", "ols"], ["--weights", "ols", "--no-prior"]][random.integers(5)]
    if small:
        # Few poses, each left out; half of the robots are as good as nominal: nothing is to be gained there.
        return way | {"off": 0.01 if random.random() < 0.5 else 1.0, "options": way["options"][:2]}
    way["lines"] = int(random.integers(2, 5)) if random.random() < 0.4 else 1
    # As many of every pose, or of each what there was time for.
    way["uneven"] = way["lines"] > 1 and random.random() < 0.5
    way["missing"] = 0.1 if random.random() < 0.3 else 0.0
    way["hold"] = [None, None, "--validate", "--hold-back"][random.integers(4)]
    # A base that stands anywhere, where nobody says that it does not.
    way["turned"] = random.random() < 0.2 and not arm.tolerance("base.rx", variant)[1]
    return way


def describe(way):
    parts = [key if value is True else f"{key} {value}" for key, value in way.items()
             if key != "options" and (value is True or value not in (None, False, 0, 1))]
    return " ".join(way["options"] + parts) or "as stated"


class Run:
    """One file of readings, what `calibrate` says of it, and what it is made of."""

    def __init__(self, program, folder, arm, variant, way, random, count):
        self.arm, self.variant, self.way = arm, variant, way
        self.weights = "ols" if "ols" in way["options"] else "wls"
        truth = {name: value * way["off"] for name, value in drawn.drawn_truth(arm, random).items()}
        if way.get("turned"):
            truth |= dict(zip(["base.rx", "base.ry", "base.rz"], random.uniform([-3, -1.4, -3], [3, 1.4, 3])))
        self.truth, self.poses = truth, drawn.drawn_poses(arm, random, count)
        kinds = {key: way[key] for key in ("larger", "hidden_shift", "independent")}
        lines = random.integers(1, way["lines"] + 2, count) if way.get("uneven") else [way["lines"]] * count
        everything = drawn.drop_cells(drawn.drawn_readings(arm, self.poses, truth, lines, random, **kinds), random, way["missing"])
        drawn.written(folder / "data.csv", arm, self.poses, everything, random)
        self.lines = [np.array([z for k, z in everything if k == i]) for i in range(count)]
        self.repeated = max(len(here) for here in self.lines) > 1
        arguments = [program, "calibrate", folder / "problem.yaml", folder / "data.csv", "--variant", variant, "--json", "--quiet"]
        self.held = np.zeros(count, bool)
        if way["hold"] == "--hold-back":
            arguments += ["--hold-back", "4"]
            self.held = (np.arange(count) + 1) % 4 == 0
        self.later = None
        if way["hold"] == "--validate":
            later = drawn.drawn_poses(arm, random, 6)
            more = drawn.drawn_readings(arm, later, truth, [1] * 6, random)
            drawn.written(folder / "later.csv", arm, later, more, random)
            arguments += ["--validate", folder / "later.csv"]
            self.later = (later, np.array([z for _, z in more]))
        (folder / "estimate.yaml").unlink(missing_ok=True)
        done = subprocess.run([*map(str, arguments), "-o", folder / "estimate.yaml", *way["options"]], capture_output=True, text=True)
        self.status, self.said = done.returncode, done.stderr.strip()
        self.result = json.loads(done.stdout) if done.stdout else None
        self.file = yaml.safe_load((folder / "estimate.yaml").read_text())["parameters"] if (folder / "estimate.yaml").exists() else None

    def fitted(self):
        """Poses that are fitted, means over their lines, and the problem's repeats where every pose has one line."""
        poses, z = drawn.averaged(self.arm, self.poses, [(i, line) for i, lines in enumerate(self.lines) for line in lines])
        if not self.repeated:
            poses.shares = None
        return poses[~self.held], z[~self.held]
