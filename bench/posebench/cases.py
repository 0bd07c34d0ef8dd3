"""Cases: a set with a number of poses. A case has parts (a folder for the solver, a number of poses) and judges what was chosen of each.

`value(chosen)` is what is compared with random sets, smaller is better: {estimation: value}."""
import csv
import hashlib
import json
import pathlib

import numpy as np

import criteria_for_robots
import ensemble
import instances
import measured
import simulated
from estimators import ESTIMATORS


class Unusable(Exception):
    pass


class Part:
    """What a solver gets: FOLDER with blocks.npy, task.json and, of robots, joints.npy, tips.npy, prior.npy."""

    def __init__(self, folder, blocks, poses, **more):
        self.folder, self.blocks, self.poses = folder, blocks, poses
        self.count, _, self.parameters = blocks.shape
        folder.mkdir(parents=True, exist_ok=True)
        task = {"criterion": more.pop("criterion", None), "problem": more.pop("problem", None)}
        candidates = more.pop("candidates", None)
        np.save(folder / "blocks.npy", blocks)
        for name, array in more.items():
            np.save(folder / f"{name}.npy", array)
        (folder / "task.json").write_text(json.dumps(task))
        self.criterion = task["criterion"] or "o1"
        self.digest = hashlib.sha256(blocks.tobytes() + self.criterion.encode())  # of contents: paths change from run to run
        for file in filter(None, (candidates, task["problem"])):
            self.digest.update(pathlib.Path(file).read_bytes())
        self.digest = self.digest.hexdigest()

    def merit(self, chosen):
        """ln of what the efficiency compares: det^(1/m) of the information, or its smallest eigenvalue for o3."""
        rows = self.blocks[chosen].reshape(-1, self.parameters)
        s = np.linalg.svd(rows, compute_uv=False)
        if len(s) < self.parameters or s[-1] <= 1e-12 * s[0]:
            return -np.inf
        return 2 * (np.log(s[-1]) if self.criterion == "o3" else np.log(s).mean())


class Case:
    estimations = ()
    proved = None  # upper bound of the merit that a longer search has proved

    def draws(self, count):
        rng = np.random.default_rng([2026, *(part.poses for part in self.parts)])
        return [[rng.choice(part.count, part.poses, replace=False) for part in self.parts] for _ in range(count)]


class MeasuredCase(Case):
    """Held-out error, root mean square in mm over the judges of all folds."""
    unit = "mm"

    def __init__(self, data, parts, poses):
        self.data, self.parts, self.poses = data, parts, poses
        self.label, self.estimations = f"{poses} poses", tuple(ESTIMATORS)

    def value(self, chosen):
        return {name: self.error(chosen, estimator) for name, estimator in ESTIMATORS.items()}

    def error(self, chosen, estimator):
        s, squares = self.data, []
        for (candidates, judges), picked in zip(s.folds(), chosen):
            S = candidates[picked]
            squares.append(s.squares(estimator(s.near[S], s.left[S], s.nominal, s.known), judges))
        return float(np.sqrt(np.concatenate(squares).mean()))

    def calibrations(self, chosen, folder):
        """Files to fit and to validate, for each fold."""
        for k, ((candidates, judges), picked) in enumerate(zip(self.data.folds(), chosen)):
            yield (self.data.table(candidates[picked], folder / f"fit{k}.csv"), self.data.table(judges, folder / f"judge{k}.csv"))


class RowsCase(Case):
    """No readings: the value is minus the ln of the efficiency against the bound; random sets are compared by it."""
    unit = ""
    estimations = ("information",)

    def __init__(self, part, description):
        self.parts, self.poses, self.label = [part], part.poses, f"{part.poses} poses"
        self.proved = description.get("proved", {}).get("merit")

    def value(self, chosen):
        return {"information": -self.parts[0].merit(chosen[0])}


class SimulatedCase(Case):
    """Geometric mean, over kinds of arms and drawn robots, of the error over the random median; plain fit."""
    unit = "of random"
    estimations = ("plain least squares",)

    def __init__(self, parts, judges, times):
        self.parts, self.judges, self.poses = parts, judges, times
        self.label = f"{times:g} times the smallest number of poses"
        self.medians = None

    def errors(self, chosen):
        return np.concatenate([judge(S, False) for judge, S in zip(self.judges, chosen)])

    def value(self, chosen):
        if self.medians is None:
            self.all = np.array([self.errors(draw) for draw in self.draws(60)])
            self.medians = np.median(self.all, 0)
        return {"plain least squares": float(np.exp(np.log(self.errors(chosen) / self.medians).mean()))}

    def share_better(self, chosen):
        return float((self.all < self.errors(chosen)).mean())


def checked(folder, hashes):
    for name, known in hashes.items():
        path = folder / name
        if not path.is_file():
            raise Unusable(f"{path}: no such file; the data are not part of the project (--data)")
        if hashlib.sha256(path.read_bytes()).hexdigest() != known:
            raise Unusable(f"{path}: sha256 differs from the description; figures would be of other data")


def numbers_of(description, options):
    return options.poses or description["poses"]


def of_measured(description, root, options, place):
    folder = options.data / description["folder"]
    checked(folder, description["sha256"])
    data = measured.Measured(description, root, folder, place)
    for poses in numbers_of(description, options):
        parts = []
        for k, (candidates, _) in enumerate(data.folds()):
            if poses > len(candidates):
                raise Unusable(f"{poses} poses of {len(candidates)} candidates")
            here = place / f"{poses}-{k}"
            here.mkdir()
            listed = data.table(candidates, here / "candidates.csv")
            parts.append(Part(here, data.blocks[candidates], poses, problem=str(data.problem), candidates=listed,
                              joints=data.q[candidates], tips=data.tips[candidates], prior=data.known))
        yield MeasuredCase(data, parts, poses)


def of_rows(description, root, options, place):
    blocks = instances.make(description["generator"], *description.get("arguments", []))
    found = hashlib.sha256(np.round(blocks, 6).tobytes()).hexdigest()
    if found != description["sha256"]:
        raise Unusable(f"{description['path']}: sha256 of the generated blocks is {found}; this is another instance")
    for poses in numbers_of(description, options):
        yield RowsCase(Part(place / str(poses), blocks, poses, criterion=description.get("criterion")), description)


def of_simulated(description, root, options, place):
    arms = []
    for number, arm in enumerate(ensemble.arms()):
        rng = np.random.default_rng([description["seed"], number])
        pool = ensemble.Pool(arm, description["candidates"], rng)
        test = ensemble.Pool(arm, 200, rng, pool)
        problem = criteria_for_robots.Problem(pool)
        arms.append((arm, pool, problem, criteria_for_robots.Judge(problem, pool, test, description["robots"], rng)))
    for times in description["times"]:
        parts = []
        for number, (arm, pool, problem, _) in enumerate(arms):
            here = place / f"{times:g}-{number}"
            here.mkdir()
            file, listed = simulated.write(arm, pool, here)
            parts.append(Part(here, problem.J, int(np.ceil(times * pool.smallest)), problem=str(file), candidates=listed,
                              joints=pool.q, tips=arm.place(pool.q)[2][:, 0], prior=problem.known))
        yield SimulatedCase(parts, [judge for *_, judge in arms], times)


def of(description, root, options, place):
    """The cases of a set, one for each number of poses."""
    for case in {"measured": of_measured, "rows": of_rows, "simulated": of_simulated}[description["kind"]](description, root, options, place):
        case.name = description["name"]
        yield case
