"""What a written plan states of any robot, instrument and load case, computed again from its poses alone.

    plan_of_any_robot.py PROGRAM SOURCE [COUNT [SEED]]      the examples of SOURCE and COUNT (20) random problems
    plan_of_any_robot.py PROGRAM --problems FILE...         these problem files
    plan_of_any_robot.py --write FOLDER SEED NUMBER         writes a random problem, to look at it

A second road that knows only definitions: frames multiplied out, loops closed by Newton's method, derivatives by differences,
covariances as matrices, the information as a sum. Nothing is taken from the program but the files that it writes. SEED is a
number (1) or "fresh". Exit status 1 where anything differs, 77 where numpy or yaml is absent."""
import concurrent.futures
import contextlib
import io
import json
import os
import pathlib
import re
import secrets
import subprocess
import sys
import tempfile
import traceback

# Small matrices: threads of the linear algebra only wait for each other.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
try:
    import numpy as np
    import yaml

    from comparison import compare
    from experiment import Experiment
    from quantities import si
    from random_problems import random_problem
except ImportError as error:
    if error.name not in ("numpy", "yaml"):
        raise
    print(f"skipped: {error.name} is absent (Debian: python3-numpy, python3-yaml)")
    sys.exit(77)

# Not unless they are named.
LEFT_OUT = {"cell/problem.yaml": "collisions, and motions between poses"}
LEFT_OUT |= {f"cells/{name}.yaml": "needs its maker's files" for name in ("abb_tracker", "kuka_tracker", "ur_camera")}
LEFT_OUT |= dict.fromkeys(("instruments/tracker_and_camera.yaml", "instruments/tracker_and_level.yaml", "instruments/four_cameras.yaml", "instruments/read_together.yaml", "instruments/datum_cube.yaml", "two_arms/one_tracker.yaml", "humanoid/both_hands.yaml"), "an experiment here has one instrument; tests/tasks/instruments_test.cpp adds them up")


def planned(program, file, variant, poses, plan_file, *candidates):
    """Runs the program for a quick plan."""
    candidates = candidates or ("--candidates", max(40, 2 * poses))
    command = [program, "plan", file, "--variant", variant, "--poses", poses, *candidates, "--restarts", 1, "--method", "exchange",
               "--threads", 1, "-o", plan_file, "--poses-csv", "-", "--quiet", "--force"]
    return subprocess.run([str(word) for word in command], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)


def plan_of(program, file, variant, folder):
    """A plan of as few poses as do: what is to be checked does not grow with them."""
    design, plan_file = yaml.safe_load(file.read_text())["design"], folder / "plan.json"
    for poses in sorted({min(count, design["poses"]) for count in (10, 20, 30, design["poses"])}):
        done = planned(program, file, variant, poses, plan_file)
        if done.returncode != 1:
            break
    if done.returncode == 0 and design.get("scaling") == "norm":
        # Effects are averaged over the candidates; where these are the poses of the plan, the plan tells them.
        listed = plan_file.rename(folder / "candidates.json")
        done = planned(program, file, variant, poses, plan_file, "--candidates-from", listed)
    return done, plan_file


def refused_rightly(message, file, variant):
    """Whether the actuators of a delta robot cannot hold the test pose that is refused."""
    found = re.search(r"test pose (\d+) is not feasible: actuator travel", message)
    problem = yaml.safe_load(file.read_text())
    if not found or problem["robot"].get("model") != "delta":
        return False
    experiment = Experiment(problem, file.parent, problem["variants"][variant])
    at = problem["design"]["test_poses"]["at"][int(found[1]) - 1]
    angles = experiment.robot.actuators(np.array(at), experiment.nominal)
    lower, upper = [si(end) for end in problem["robot"]["travel"]]
    return bool(np.any(angles < lower) or np.any(angles > upper))


def check(program, label, file, variant):
    """Prints a line; whether all agrees. A problem that the program says cannot be planned is not a disagreement, one that it cannot
    read is."""
    with tempfile.TemporaryDirectory() as name:
        done, plan_file = plan_of(program, file, variant, pathlib.Path(name))
        if done.returncode:
            good = done.returncode == 1 or refused_rightly(done.stderr, file, variant)
            print(f"{label}: not planned: {done.stderr.strip()[:300]}{'' if good else '  FAILED'}")
            return good
        problem, plan = yaml.safe_load(file.read_text()), json.loads(plan_file.read_text())
    good = True
    for each in dict.fromkeys(p.get("variant", variant) for p in plan["parameters"]):
        found, parameters = compare(problem, file.parent, plan, each)
        good = found.good() and good
        print(f"{label} {each}: {len(plan['poses'])} poses, {len(parameters.used)} of {len(parameters.listed)} parameters: {found}"
              f"{'' if found.good() else '  FAILED'}")
    return good


def task(program, label, file, variant):
    """A check in a process of its own: what it prints, and whether all agrees."""
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        try:
            good = check(program, label, file, variant)
        except Exception:
            print(f"{label} {variant}: {traceback.format_exc()}  FAILED")
            good = False
    return printed.getvalue(), good


def random_task(program, seed, number):
    with tempfile.TemporaryDirectory() as name:
        file, title = random_problem(pathlib.Path(name), np.random.default_rng([seed, number]), number)
        return task(program, f"random {seed}/{number}: {title}", file, "all")


def variants_to_check(files):
    for file in files:
        problem = yaml.safe_load(file.read_text())
        for variant in problem["variants"]:
            # The truth of a design is not what is fitted.
            if variant != problem.get("design", {}).get("truth"):
                yield f"{file.parent.name}/{file.name}", file, variant


def main(arguments):
    if arguments[0] == "--write":
        folder, seed, number = pathlib.Path(arguments[1]), int(arguments[2]), int(arguments[3])
        print(*random_problem(folder, np.random.default_rng([seed, number]), number))
        sys.exit(0)
    program, random, files = pathlib.Path(arguments[0]).resolve(), [], []
    if "--problems" in arguments:
        files = [pathlib.Path(name).resolve() for name in arguments[arguments.index("--problems") + 1:]]
    else:
        for file in sorted((pathlib.Path(arguments[1]).resolve() / "examples").rglob("*.yaml")):
            if reason := LEFT_OUT.get("/".join(file.parts[-2:])):
                print(f"{file.parent.name}/{file.name}: skipped ({reason})")
            else:
                files.append(file)
        count, seed = int(arguments[2]) if len(arguments) > 2 else 20, arguments[3] if len(arguments) > 3 else "1"
        seed = secrets.randbelow(10**9) if seed == "fresh" else int(seed)
        random = [(seed, number) for number in range(count)]
        print(f"{count} random problems of seed {seed}")
    good = True
    with concurrent.futures.ProcessPoolExecutor() as pool:
        tasks = [pool.submit(task, program, *each) for each in variants_to_check(files)]
        tasks += [pool.submit(random_task, program, *each) for each in random]
        for done in tasks:
            text, agrees = done.result()
            print(text, end="", flush=True)
            good = agrees and good
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main(sys.argv[1:])
