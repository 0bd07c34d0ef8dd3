"""Runs solvers on the parts of a case, within their time, and keeps what is finished."""
import csv
import datetime
import hashlib
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
SOLVERS = HERE / "solvers"
JUDGES = b"".join((HERE / name).read_bytes() for name in ("cases.py", "estimators.py", "measured.py", "simulated.py"))
SKIPPED = 3  # exit code of a solver that does not apply to a set


class Notes:
    """What failed and what was skipped: who, why, and on which sets."""

    def __init__(self):
        self.failures, self.skips = {}, {}

    def failed(self, who, why, where=""):
        self.failures.setdefault((who, why), {})[where] = None
        print(f"posebench: {who}{where and ' on ' + where}: {why}", file=sys.stderr, flush=True)

    def skipped(self, who, why, where=""):
        self.skips.setdefault((who, why), {})[where] = None

    def lines(self):
        for word, notes in (("failed", self.failures), ("skipped", self.skips)):
            for (who, why), places in notes.items():
                where = ", ".join(filter(None, places))
                yield f"{word}: {who}{where and ' on ' + where}: {why}"


def sha(*pieces):
    digest = hashlib.sha256()
    for piece in pieces:
        digest.update(piece if isinstance(piece, bytes) else str(piece).encode())
        digest.update(b"\0")
    return digest.hexdigest()


def limited(command, seconds, environment):
    """What measure.py found of a command, and its errors. Asleep for six times its CPU seconds it is ended as well."""
    with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryFile() as errors:
        usage = pathlib.Path(folder) / "usage.json"
        process = subprocess.Popen([sys.executable, HERE / "measure.py", usage, str(seconds), *command], stdout=subprocess.DEVNULL, stderr=errors,
                                   env=environment, start_new_session=True)
        try:
            process.wait(6 * seconds)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
        errors.seek(0)
        words = errors.read().decode(errors="replace").strip()
        return json.loads(usage.read_text()) if usage.is_file() else {"code": 1, "late": True, "cpu": 0, "memory": 0}, words


class Runner:
    def __init__(self, options, notes):
        self.options, self.notes = options, notes
        self.parts = options.out / "parts"
        self.parts.mkdir(parents=True, exist_ok=True)
        self.program = options.program if options.program.is_file() else None
        self.stamp = sha(self.program.read_bytes()) if self.program else ""
        self.environment = dict(os.environ, POSEWRIGHT=str(self.program.resolve() if self.program else ""), PYTHONDONTWRITEBYTECODE="1",
                                PYTHONPATH=str(SOLVERS), OPENBLAS_NUM_THREADS="1")

    def kept(self, key, compute):
        """A finished part, or `compute()`; what is None is tried again at the next call."""
        path = self.parts / f"{sha(*key)[:32]}.json"
        if path.is_file():
            return json.loads(path.read_text())
        value = compute()
        if value is not None:
            with tempfile.NamedTemporaryFile("w", dir=self.parts, suffix=".new", delete=False) as file:
                json.dump(value, file)
            os.replace(file.name, path)
        return value

    def solve(self, script, part):
        """Indices, CPU seconds, MiB; or a reason with `failed` or `skipped`."""
        shared = b"".join(path.read_bytes() for path in sorted(SOLVERS.glob("_*.py")))
        fresh = []

        def compute():
            fresh.append(self.solved(script, part))
            return fresh[0] if "chosen" in fresh[0] else None
        return self.kept((script.read_bytes(), shared, self.stamp, part.digest, part.poses), compute) or fresh[0]

    def solved(self, script, part):
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder) / "chosen"
            used, words = limited([sys.executable, script, part.folder, str(part.poses), out], self.options.limit, self.environment)
            if used["code"] == SKIPPED:
                return {"skipped": words}
            if used["late"]:
                return {"failed": f"past its time, {self.options.limit:g} s of CPU"}
            if used["code"] != 0:
                return {"failed": words.splitlines()[-1] if words else f"exit code {used['code']}"}
            try:
                chosen = [int(line) for line in out.read_text().split()]
            except (OSError, ValueError) as error:
                return {"failed": f"no list of indices: {error}"}
        if len(set(chosen)) != part.poses or not all(0 <= k < part.count for k in chosen):
            return {"failed": f"{len(set(chosen))} different indices below {part.count}, not {part.poses}"}
        return {"chosen": chosen, "cpu": used["cpu"], "memory": used["memory"]}

    def bound(self, part):
        """Upper bound of a part's merit that the program certifies, or None."""
        def compute():
            words = ["select", part.folder / "blocks.npy", "--poses", str(part.poses), "--criterion", part.criterion, "--json", "-o", "-", "--quiet",
                     "--threads", "1"]
            done = subprocess.run([self.program, *words], capture_output=True, text=True)
            if done.returncode != 0:
                self.notes.failed("certified efficiency", done.stderr.strip(), part.folder.parent.name)
                return None
            plan = json.loads(done.stdout)
            efficiency = plan["certificate"]["candidates"]["efficiency"]
            return part.merit([pose["candidate"] for pose in plan["poses"]]) - float(np.log(efficiency))
        return self.kept(("bound", self.stamp, part.digest, part.poses), compute) if self.program else None

    def calibrated(self, case, chosen):
        """Held-out error by the program's defaults, mm, and the predicted one; None where it refuses."""
        def compute():
            with tempfile.TemporaryDirectory() as folder:
                squares, judges, predicted = [], [], []
                for fit, judge in case.calibrations(chosen, pathlib.Path(folder)):
                    done = subprocess.run([self.program, "calibrate", case.data.problem, fit, "--validate", judge, "--profile", "none", "--json", "--quiet",
                                           "--threads", "1"], capture_output=True, text=True)
                    if done.returncode not in (0, 1) or not done.stdout:
                        return {"error": None}
                    result = json.loads(done.stdout)
                    held = [pose["accuracy"] for pose in result["poses"] if pose["held_back"]]
                    kinds = {r["kind"]: r["rms"] for r in result["residuals"] if r["poses"] != "fitted" and r["parameters"] == "calibrated"}
                    squares.append((kinds["distance"] if "distance" in kinds else 3 ** 0.5 * kinds["m"]) ** 2)
                    judges.append(sum(pose["held_back"] for pose in result["poses"]))
                    predicted += [(a["with_noise"]["position"], a["observed"]["position"]) for a in held if a]
            ratio = None
            if predicted:
                sums = (np.array(predicted) ** 2).sum(0)
                ratio = float(np.sqrt(sums[0] / sums[1]))
            return {"error": 1e3 * float(np.average(squares, weights=judges)) ** 0.5, "predicted": ratio}
        return self.kept(("calibrate", self.stamp, *(part.digest for part in case.parts), str(chosen)), compute)


    def intervals(self, data, poses):
        """Of a fit of these poses by the program's defaults: {parameter: (value, half of its 95 % interval)}."""
        def compute():
            with tempfile.TemporaryDirectory() as folder:
                fit = data.table(poses, pathlib.Path(folder) / "fit.csv")
                done = subprocess.run([self.program, "calibrate", data.problem, fit, "--profile", "none", "--json", "--quiet", "--threads", "1"],
                                      capture_output=True, text=True)
            if not done.stdout:
                return {}
            return {p["name"]: (p["value"], (p["interval"][1] - p["interval"][0]) / 2) for p in json.loads(done.stdout)["parameters"]
                    if p["estimated"] and p["interval"]}
        return self.kept(("intervals", self.stamp, data.description["name"], str(data.description["sha256"]), str(list(poses))), compute)


PROGRAM = "posewright's defaults"
HALVINGS, HALF = 10, 60


def bounds_of(case, bench, pool):
    """Upper bound of each part's merit: certified now, or by the proof that the description quotes. None: not known."""
    return [min((b for b in (found, case.proved) if b is not None), default=None) for found in pool.map(bench.bound, case.parts)]


def random_values(case, bench, pool):
    """Sorted values of random sets, by estimation."""
    draws = case.draws(bench.options.draws)
    parts = [word for part in case.parts for word in (part.digest, part.poses)]
    values = bench.kept(("random", JUDGES, *parts, len(draws)), lambda: [case.value(draw) for draw in draws])
    found = {name: np.sort([v[name] for v in values]) for name in case.estimations}
    if hasattr(case, "calibrations") and bench.program:
        some = list(pool.map(lambda draw: bench.calibrated(case, draw)["error"], draws[:bench.options.calibrated_draws]))
        found[PROGRAM] = np.sort([np.inf if e is None else e for e in some])
    return found


def random_rows(case, random, first, bound):
    for estimation, values in random.items():
        lower, median, upper = np.quantile(values, (0.25, 0.5, 0.75), method="nearest")
        share = float(np.exp(-median - bound)) if bound is not None and not case.unit else None
        yield dict(first, solver="random", estimation=estimation, value=median, lower=lower, upper=upper, draws=len(values), better=0.5,
                   ratio=1.0 if case.unit else None, efficiency=share)


def solver_rows(case, name, runs, random, first, bench, bounds):
    """One row for each estimation; of several parts the lowest efficiency."""
    chosen = [run["chosen"] for run in runs]
    merits = [part.merit(S) for part, S in zip(case.parts, chosen)]
    efficiency = min((float(np.exp(merit - bound)) for merit, bound in zip(merits, bounds) if bound is not None), default=None)
    more = dict(first, solver=name, efficiency=efficiency, merit=merits[0], cpu=sum(run["cpu"] for run in runs), memory=max(run["memory"] for run in runs))
    values = {estimation: (value, None) for estimation, value in case.value(chosen).items()}
    if PROGRAM in random:
        result = bench.calibrated(case, chosen)
        values[PROGRAM] = (np.inf if result["error"] is None else result["error"], result.get("predicted"))
    for estimation, (value, predicted) in values.items():
        better = case.share_better(chosen) if hasattr(case, "share_better") else float((random[estimation] < value - 1e-9).mean())
        yield dict(more, estimation=estimation, value=value, better=better, predicted=predicted,
                   ratio=value / np.median(random[estimation]) if case.unit else None)


def rows_of(case, scripts, bench, pool):
    """Rows of random sets and of each solver, on one case."""
    random = random_values(case, bench, pool)
    first = {"set": case.name, "poses": case.poses, "unit": case.unit, "date": datetime.date.today().isoformat()}
    bounds = bounds_of(case, bench, pool)
    rows = list(random_rows(case, random, first, bounds[0]))
    for row in stored_rows(case) if bounds[0] is not None else ():
        rows.append(dict(row, efficiency=float(np.exp(row["merit"] - bounds[0]))))
    tasks = {(name, k): pool.submit(bench.solve, path, part) for name, path in scripts.items() for k, part in enumerate(case.parts)}
    for name in scripts:
        runs = [tasks[name, k].result() for k in range(len(case.parts))]
        reasons = [(word, run[word]) for word in ("failed", "skipped") for run in runs if word in run]
        if reasons:
            say = bench.notes.failed if reasons[0][0] == "failed" else bench.notes.skipped
            say(name, reasons[0][1], case.name)
        else:
            rows += solver_rows(case, name, runs, random, first, bench, bounds)
    return rows


def plain_intervals(data, poses):
    """The same of plain least squares, along the axes of the blocks; noise from the residuals."""
    J, y = data.near[poses].reshape(-1, data.m), data.left[poses].reshape(-1)
    theta = np.linalg.pinv(J, rcond=3e-6) @ y
    variance = ((y - J @ theta) ** 2).sum() / (len(y) - data.m)
    half = 1.96 * np.sqrt(variance * np.diag(np.linalg.pinv(J.T @ J, rcond=1e-12)))
    return {k: (float(theta[k]), float(half[k])) for k in range(data.m)}


def coverage_rows(data, bench, pool):
    """Share of parameters whose values from disjoint halves of the poses differ by no more than both 95 % intervals allow."""
    rng, pairs = np.random.default_rng(2026), []
    half = min(HALF, len(data.q) // 2)
    for _ in range(HALVINGS):
        drawn = rng.permutation(len(data.q))[:2 * half]
        pairs.append((np.sort(drawn[:half]), np.sort(drawn[half:])))
    ways = {"plain least squares": plain_intervals}
    if bench.program:
        ways[PROGRAM] = bench.intervals
    for estimation, of in ways.items():
        held = []
        for a, b in pool.map(lambda pair: (of(data, pair[0]), of(data, pair[1])), pairs):
            held += [abs(a[k][0] - b[k][0]) <= np.hypot(a[k][1], b[k][1]) for k in a.keys() & b.keys()]
        if held:
            yield {"set": data.description["name"], "poses": half, "solver": "halves", "estimation": estimation, "unit": "parameters",
                   "coverage": float(np.mean(held)), "draws": len(pairs), "date": datetime.date.today().isoformat()}


def stored_rows(case):
    """Results of solvers that are not installed here, from stored/."""
    for path in sorted((HERE / "stored").glob("*.csv")):
        with open(path, newline="", encoding="utf-8") as file:
            for row in csv.DictReader(file):
                if row["set"] == case.name and int(row["poses"]) == case.poses:
                    merit = float(row.pop("log_det")) / case.parts[0].parameters
                    yield dict(row, poses=case.poses, unit=case.unit, estimation="information", merit=merit,
                               cpu=float(row["cpu"]), memory=float(row["memory"]))
