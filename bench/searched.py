#!/usr/bin/env python3
"""How far figures over the workspace are off that no proof stands behind.

    bench/searched.py PROGRAM PYTHON_FOLDER [COUNT [SEED [SKIP]]]

Random problems of tests/oracle (arms, gantries, SCARAs, seven axes, springs and compensators, loaded minus unloaded, six legs,
delta, five-bar; points, trackers, cameras, distances, joint sensors) are planned from the default number of candidates without a
proof, COUNT (50) of them. Each stated share is compared with the weights of two longer searches: the program with twice the
candidates and another seed, and (for determinants) numpy, which knows the blocks alone: optimal weights on 10,000 other
configurations, refined at random. A row is a problem: the stated share, the share by the best weights known, and whether the plan
states the figure or leaves it out. Plans under o2 and o4, which have no bound over the workspace, follow: they must state none.
PYTHON_FOLDER holds the package posewright; SKIP problems are left out at the beginning; WORKERS (2) problems run at a time."""
import concurrent.futures
import json
import math
import os
import pathlib
import resource
import subprocess
import sys
import tempfile

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
import numpy as np
import yaml

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "tests/oracle"))
from random_machines import MACHINES  # noqa: E402
from random_problems import ROBOTS, random_problem  # noqa: E402

# Criteria in turn; h of those with one that is not a determinant's (docs/plan-file.md).
CRITERIA = {"o1": None, "ds": None, "a": 1.0, "o3": 0.5, "o5": 0.5}
DETERMINANTS = ("o1", "ds")
WITHOUT_BOUND = ("o2", "o4")
KINDS = ROBOTS + MACHINES
PATIENCE = 30  # CPU seconds for one plan


def planned(program, file, criterion, *words, name="plan.json"):
    """The plan written beside the problem; none where the program refuses, or takes longer than the patience."""
    command = [program, "plan", file, "--criterion", criterion, "--prior", "none", "--scaling", "tolerance", "--method", "exchange",
               "--restarts", "1", "--threads", "1", "--proof-time", "0", "-o", file.parent / name, "--poses-csv", "-", "--quiet", *words]
    limit = lambda: resource.setrlimit(resource.RLIMIT_CPU, (PATIENCE, PATIENCE))
    done = subprocess.run(command, capture_output=True, preexec_fn=limit)
    return json.loads((file.parent / name).read_text()) if done.returncode == 0 else None


def degree_of(plan, criterion):
    return CRITERIA[criterion] or sum(p["identifiable"] and p["role"] == "interest" for p in plan["parameters"])


def kept(plan):
    return [p["name"] for p in plan["parameters"] if p["identifiable"]]


def value_of(plan, h):
    """Φ of the plan."""
    whole = plan["certificate"]["workspace"]
    return whole["bound"] + h * math.log(whole["efficiency"])


def reached(plan, h):
    """Φ of the best weights that the program found."""
    return value_of(plan, h) - h * math.log(plan["certificate"]["workspace"]["at_most"])


class Weights:
    """Optimal weights for log det of the parameters of interest, by definition."""

    def __init__(self, blocks, nuisance):
        self.blocks, self.nuisance, self.h = blocks, nuisance, blocks.shape[2] - nuisance
        self.w = np.full(len(blocks), 1 / len(blocks))

    def information(self):
        rows = self.blocks * np.sqrt(self.w)[:, None, None]
        rows = rows.reshape(-1, rows.shape[2])
        return rows.T @ rows

    def value(self):
        M, k = self.information(), self.nuisance
        return np.linalg.slogdet(M)[1] - (np.linalg.slogdet(M[:k, :k])[1] if k else 0)

    def gradient(self):
        M, k = self.information(), self.nuisance
        G = np.linalg.inv(M)
        if k:
            G[:k, :k] -= np.linalg.inv(M[:k, :k])
        return G

    def sensitivity(self, blocks):
        return np.einsum("nri,ij,nrj->n", blocks, self.gradient(), blocks, optimize=True)

    def solve(self, rounds):
        for _ in range(rounds):
            self.w *= self.sensitivity(self.blocks) / self.h
            self.w /= self.w.sum()

    def keep(self, more):
        """The blocks with weight, and new ones."""
        stay = self.w > 1e-4 / len(self.w)
        share = 0.2 if len(more) else 0.0
        self.blocks = np.concatenate([self.blocks[stay], more])
        self.w = np.concatenate([(1 - share) * self.w[stay] / self.w[stay].sum(), np.full(len(more), share / max(1, len(more)))])


def by_definition(folder, file, plan, seed):
    """Φ of weights that numpy finds, in the plan's units; and that of the plan itself."""
    sys.path.insert(0, folder)
    import posewright as pw
    model = pw.Model(pw.Problem(str(file)), "all", kept(plan), threads=1)
    blocks_of = lambda q: np.array(model.blocks(q, threads=1))
    own = Weights(blocks_of(str(file.parent / "plan.json")), model.nuisance)
    rng, q = np.random.default_rng(seed), model.candidates(10000, seed=seed + 1000, threads=1)
    all_blocks = blocks_of(q)
    scale = np.sqrt((all_blocks ** 2).sum(axis=(0, 1)) / len(all_blocks))
    scaled = lambda b: b / scale
    offset = 2 * np.log(scale[model.nuisance:]).sum() + (len(scale) - model.nuisance) * math.log(len(plan["poses"]))
    all_blocks = scaled(all_blocks)
    weights = Weights(all_blocks[:2000], model.nuisance)
    lower, upper = q.min(axis=0), q.max(axis=0)
    boxed = plan["statistics"]["candidates_drawn"] == plan["statistics"]["candidates_feasible"]
    whole = np.array([len(np.unique(column)) < 30 for column in q.T])
    for turn in range(10):
        weights.solve(60)
        d = weights.sensitivity(all_blocks)
        best = np.argsort(-d)[:100]
        more = [all_blocks[best]]
        if boxed:
            at = q[best]
            for step in (0.2, 0.05, 0.01):
                tries = np.repeat(at, 6, axis=0)
                tries += np.where(whole, 0, step * (upper - lower) * rng.normal(size=tries.shape))
                tries = np.clip(tries, lower, upper)
                value = weights.sensitivity(scaled(blocks_of(np.concatenate([at, tries])))).T
                groups = np.concatenate([value[:len(at), None], value[len(at):].reshape(len(at), 6)], axis=1).argmax(axis=1)
                at = np.where((groups > 0)[:, None], tries.reshape(len(at), 6, -1)[np.arange(len(at)), groups - 1], at)
            more.append(scaled(blocks_of(at)))
        weights.keep(np.concatenate(more))
    weights.solve(300)
    return weights.value() + offset, own.value() + (len(scale) - model.nuisance) * math.log(len(plan["poses"]))


def problem_of(folder, seed, number):
    file, title = random_problem(pathlib.Path(folder), np.random.default_rng([seed, number]), number, KINDS)
    problem = yaml.safe_load(file.read_text())
    problem["design"].pop("test_poses", None)
    file.write_text(yaml.safe_dump(problem, sort_keys=False))
    return file, title


def known_best(program, folder, file, criterion, plan, number):
    """Φ of the best weights of each search, and a word where numpy has another Φ for the plan than the program."""
    h = degree_of(plan, criterion)
    best, notes = {"own": reached(plan, h)}, ""
    longer = planned(program, file, criterion, "--candidates", "20000", "--seed", "7", name="longer.json")
    # Of parameters that hang together each pool may keep others.
    if longer and longer["certificate"]["workspace"] and kept(longer) == kept(plan):
        best["longer"] = reached(longer, h)
    if criterion in DETERMINANTS:
        try:
            best["numpy"], again = by_definition(folder, file, plan, number)
            value = value_of(plan, h)
            notes = "" if abs(again - value) < 1e-6 * max(1, abs(value)) else f" (numpy has {again:.6f} for the plan, not {value:.6f})"
        except Exception as error:
            notes = f" (numpy: {error})"
    return best, notes


def judged(program, folder, seed, number):
    """A row, and by how much the figure is too good; none without a plan, or if the figure is proved."""
    with tempfile.TemporaryDirectory() as name:
        file, title = problem_of(name, seed, number)
        criterion = list(CRITERIA)[number // len(KINDS) % len(CRITERIA)]
        plan = planned(program, file, criterion)
        whole = plan and plan["certificate"]["workspace"]
        if not whole or whole["proved"]:
            return None
        best, notes = known_best(program, folder, file, criterion, plan, number)
        who, h = max(best, key=best.get), degree_of(plan, criterion)
        true = math.exp((value_of(plan, h) - best[who]) / h)
        excess = whole["efficiency"] / true - 1
        return [f"{number}", title, criterion, f"{100 * whole['efficiency']:.2f}", f"{100 * true:.2f}", f"{100 * excess:+.2f}", who,
                "stated" if whole["settled"] else "left out"], notes, excess


def without_bound(program, seed, number):
    """Whether a quick plan under o2 or o4 states no figure over the workspace; none without a plan."""
    with tempfile.TemporaryDirectory() as name:
        file, _ = problem_of(name, seed, number)
        plan = planned(program, file, WITHOUT_BOUND[number % 2], "--candidates", "100")
        return plan and plan["certificate"]["workspace"] is None


def main(program, folder, count="50", seed="1", skip="0"):
    program, folder, count, seed = os.path.abspath(program), os.path.abspath(folder), int(count), int(seed)
    print("| problem | what | criterion | stated, % | by the best weights known, % | too good by, % | found by | figure |\n|" + " --- |" * 8)
    off, tried, numbers = [], 0, range(int(skip), int(skip) + 3 * count)
    with concurrent.futures.ProcessPoolExecutor(int(os.environ.get("WORKERS", "2"))) as pool:
        for task in [pool.submit(judged, program, folder, seed, n) for n in numbers]:
            tried += 1
            if (found := task.result()) is not None:
                row, notes, excess = found
                print("| " + " | ".join(row) + " |" + notes, flush=True)
                off.append((row[-1], excess))
            if len(off) == count:
                break
        pool.shutdown(cancel_futures=True)
    silent = [s for n in range(len(KINDS)) if (s := without_bound(program, seed, n)) is not None]
    stated = [abs(x) for figure, x in off if figure == "stated"]
    print(f"\n{len(off)} of {tried} problems have a plan within {PATIENCE} CPU s and no proof. {len(stated)} of {len(off)} figures are stated, "
          f"{sum(x > 0.01 for x in stated)} of them off by more than 1 %; the largest by {100 * max(stated):.2f} %.")
    print(f"o2, o4: {sum(silent)} of {len(silent)} plans state no figure over the workspace.")


if __name__ == "__main__":
    main(*sys.argv[1:])
