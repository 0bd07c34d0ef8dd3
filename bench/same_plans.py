#!/usr/bin/env python3
"""bench/same_plans.py PROGRAM WASM [EXAMPLE...]: the plan of each problem file in examples, by the native PROGRAM and by the package
of npm in WASM (build/wasm/npm, or node_modules/posewright after `npm install` of the archive), one thread each and without a proof.

A row an example: CPU seconds of both, log det, and whether everything in plan.json is equal to the last digit: poses, bounds,
statistics; of times and hashes of files nothing is asked. Exit status 1 if a plan differs. EXAMPLE is a part of a path; makers' files
of examples/cells are not in the repository, so those are left out where they cannot be read."""
import json
import pathlib
import re
import resource
import subprocess
import sys
import tempfile

if len(sys.argv) < 3:
    sys.exit("usage: bench/same_plans.py PROGRAM WASM [EXAMPLE...]")
root = pathlib.Path(__file__).resolve().parent.parent
program, package = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
wanted = sys.argv[3:] or [""]
BOTH = {"native": [program], "node": ["node", package / "posewright.mjs"]}


def problems():
    files = sorted((root / "examples").rglob("*.yaml"))
    return [f for f in files if re.search(r"^design\s*:", f.read_text(), re.M) and any(w in str(f) for w in wanted)]


def without_times(value):
    """Copy of a value of JSON without seconds and hashes."""
    if isinstance(value, dict):
        return {key: without_times(v) for key, v in value.items() if key not in ("seconds", "sha256")}
    return [without_times(v) for v in value] if isinstance(value, list) else value


def differences(one, other, where=""):
    """Paths in JSON at which two values differ."""
    if isinstance(one, dict) and isinstance(other, dict):
        return [d for key in {**one, **other} for d in differences(one.get(key), other.get(key), f"{where}/{key}")]
    if isinstance(one, list) and isinstance(other, list) and len(one) == len(other):
        return [d for k, (a, b) in enumerate(zip(one, other)) for d in differences(a, b, f"{where}/{k}")]
    return [] if one == other else [where]


def plan(command, problem, folder):
    """CPU seconds, plan, and what the program says of an error."""
    words = ["plan", problem, "--threads", "1", "--proof-time", "0", "-o", "plan.json", "--poses-csv", "poses.csv", "--force", "--quiet"]
    spent = lambda: sum(resource.getrusage(resource.RUSAGE_CHILDREN)[:2])
    before = spent()
    done = subprocess.run([*command, *words], cwd=folder, capture_output=True, text=True)
    if done.returncode != 0:
        return spent() - before, None, done.stderr.strip()
    return spent() - before, without_times(json.loads((folder / "plan.json").read_text())), (folder / "poses.csv").read_text()


different = []
for problem in problems():
    name = str(problem.relative_to(root / "examples"))
    with tempfile.TemporaryDirectory() as folder:
        (native_time, native, text), (node_time, node, other) = (plan(c, problem, pathlib.Path(folder)) for c in BOTH.values())
    if native is None and text.replace(str(program), "") == other:
        print(f"{name}: neither plans: {text.splitlines()[0]}", flush=True)
        continue
    apart = differences(native, node) or ([] if text == other else ["poses.csv"])
    different += [name] if apart else []
    log_det = native["criterion"]["log_det"] if native else text
    print(f"{name}: native {native_time:.1f} s, node {node_time:.1f} s, log det {log_det}, {'differs in ' + ', '.join(apart[:5]) if apart else 'equal'}", flush=True)
sys.exit(f"{len(different)} differ: {', '.join(different)}" if different else 0)
