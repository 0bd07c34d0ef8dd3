"""Criteria, bounds and σ that plans and evaluations state, from definitions: criteria_by_definition.py PROGRAM SOURCE [COUNT [SEED]].

COUNT random arms (default 5) with a list of ten candidates, few enough to try every set of poses; SEED "fresh" draws one. The KR 270
of the examples with drawn candidates besides. Exit status 1 where anything disagrees."""
import itertools
import json
import pathlib
import secrets
import shutil
import subprocess
import sys
import tempfile

try:
    import numpy as np
    import yaml

    import calibration_problems as drawn
    from criteria_checks import Check, Definitions, check_certificate, check_evaluation, check_numbers, check_shares, sets_of
    from statistics_by_definition import Arm, Poses
except ImportError as error:
    print(f"skipped: {error.name} is absent (Debian: python3-numpy, python3-yaml, python3-scipy)")
    sys.exit(77)

CRITERIA = ["o1", "ds", "a", "o2", "o3", "o4", "o5", "test_pose", "test_pose_max", "compound", "maximin", "discriminate", "bias"]


def random_case(folder, random):
    """An arm of three or four joints, two variants and a truth, few parameters so that few poses of ten can tell them."""
    joints = int(random.integers(3, 5))
    drawn.random_problem(folder, random, joints)
    problem = yaml.safe_load((folder / "problem.yaml").read_text())
    names = [f"j{k}.{a}" for k in range(2, joints + 1) for a in ("x", "y", "rx", "offset", "gear")]
    order = [names[i] for i in random.permutation(len(names))]
    few, more = order[:random.integers(2, 5)], order[:random.integers(5, 8)]
    nuisance = ["base.*"] if random.random() < 0.7 else ["base.?"]
    tolerance = {"*.offset": "0.02 deg", "*.gear": 2e-3} if random.random() < 0.5 else {}
    variant = lambda names: {"parameters": list(names), "nuisance": nuisance, "tolerance": tolerance}
    problem["variants"] = {"few": variant(few), "more": variant(more), "truth": variant(more)}
    # One parameter that both estimate, one that none does.
    arm = Arm(folder / "problem.yaml")
    problem["variants"]["truth"]["nominal"] = {order[0]: arm.own_value(order[0]) + 0.0004, order[-1]: arm.own_value(order[-1]) + 0.0007}
    if random.random() < 0.3:
        problem["variants"]["few"]["nominal"] = {order[1]: arm.own_value(order[1]) + 0.0002}
    design = {"variant": "few", "truth": "truth", "poses": int(random.integers(5, 8)), "candidates_from": "list.csv",
              "variants": {"few": 1, "more": 3} if random.random() < 0.5 else ["few", "more"],
              "scaling": str(random.choice(["tolerance", "norm", "none"])), "prior": str(random.choice(["none", "tolerance"])),
              "repeats": "allow" if random.random() < 0.3 else "forbid", "reserve": bool(random.random() < 0.25)}
    if random.random() < 0.7:
        design["test_poses"] = {"at": random.uniform(-2, 2, (4, joints)).round(4).tolist(), "point": [0.01, 0.02, 0.1]}
        if random.random() < 0.5:
            design["test_poses"]["weights"] = [1, 2, 0.5, 4]
    (folder / "problem.yaml").write_text(yaml.safe_dump(problem | {"design": design}))
    # A truth is told from one fitted variant: a problem without for criteria of several.
    del design["truth"]
    (folder / "several.yaml").write_text(yaml.safe_dump(problem | {"design": design}))


def kr270(source, folder):
    """Its own parameters of the milling paper, with test poses; scaling by tolerance."""
    for file in ("problem.yaml", "kr270.urdf"):
        shutil.copy(source / "examples/kr270" / file, folder / file)
    problem = yaml.safe_load((folder / "problem.yaml").read_text())
    problem["design"]["test_poses"] = {"at": [[0, -1, 1.2, 0.3, 0.5, 0], [0.8, -0.6, 0.9, -1, 1, 0.4]], "point": [0.2, 0, 0.1]}
    del problem["variants"]["denavit_hartenberg"]
    (folder / "problem.yaml").write_text(yaml.safe_dump(problem))
    return folder / "problem.yaml"


def write_list(path, arm, poses):
    head = ["id", *arm.joints] + (["station"] if arm.stations else [])
    lines = [[str(i + 1), *(repr(float(v)) for v in q)] + ([s] if arm.stations else [])
             for i, (q, s) in enumerate(zip(poses.Q, poses.stations))]
    path.write_text("\n".join(",".join(line) for line in [head, *lines]) + "\n")


def check_listed(program, folder, poses, name, options, evaluate, check):
    """A plan from the list, then the same poses evaluated."""
    plan_file, csv = folder / "plan.json", folder / "poses.csv"
    problem_file = folder / ("several.yaml" if name in ("compound", "maximin") else "problem.yaml")
    arm = Arm(problem_file)
    done = subprocess.run([program, "plan", problem_file, "--criterion", name, "--restarts", "2", "-o", plan_file, "--poses-csv", csv,
                           "--force", "--quiet", "--threads", "1", *options], capture_output=True, text=True)
    if done.returncode != 0:
        return done, None
    plan = json.loads(plan_file.read_text())
    chosen = [p["candidate"] for p in plan["poses"]]
    meaning, among = Definitions(arm, plan, poses), np.arange(len(poses.Q))
    # A mean logarithm may be nothing but rounding.
    plain = np.exp if name == "compound" else float
    check.same("value", plain(meaning.value(name, np.array([chosen]), among)[0]), plain(plan["criterion"]["value"]))
    check_numbers(plan, meaning, chosen, among, check)
    check_certificate(name, plan, meaning, chosen, len(poses.Q), check)
    check_shares(name, plan, meaning, chosen, among, check)
    if evaluate:
        # One pose less must determine everything still; with a reserve, after the loss of another.
        less = len(chosen) - 1 - bool(plan["criterion"]["reserve"])
        drop = [["--drop", "1"]] * bool(np.isfinite(meaning.fit.log_det(chosen_sets(chosen, less))).all())
        done = subprocess.run([program, "evaluate", problem_file, csv, "--criterion", "o1", "--json", "--quiet", "--add", "1", *itertools.chain(*drop)],
                              capture_output=True, text=True)
        check.holds(f"evaluate: {done.stderr.strip()[:150]}", done.returncode == 0)
        if done.returncode == 0:
            check_evaluation(json.loads(done.stdout), arm, poses, chosen, check)
    return done, meaning


def chosen_sets(chosen, size):
    return np.array(list(itertools.combinations(chosen, size)))


def possible(meaning, count, design):
    """How many sets of the list determine everything; with a reserve, whichever pose is lost."""
    sets = sets_of(count, design["poses"], design["repeats"])
    left = [np.delete(sets, k, axis=1) for k in range(sets.shape[1])] if design["reserve"] else [sets]
    return int(np.all([np.isfinite(meaning.fit.log_det(s)) for s in left], axis=0).sum())


def check_case(program, folder, told, random):
    arm = Arm(folder / "problem.yaml")
    poses = drawn.drawn_poses(arm, random, 10)
    write_list(folder / "list.csv", arm, poses)
    good, determined = True, 0
    for name in CRITERIA:
        if name.startswith("test_pose") and "test_poses" not in arm.problem["design"]:
            continue
        check = Check()
        method = str(random.choice(["exchange", "tabu", "tabu", "greedy", "branch_and_bound", "branch_and_bound"]))
        done, meaning = check_listed(program, folder, poses, name, ["--method", method], random.random() < 0.3, check)
        if meaning and name == "o1":
            determined = possible(meaning, len(poses.Q), arm.problem["design"])
        if not meaning and name not in ("compound", "maximin"):
            # Greedy steps may end where no step is left that they can see.
            check.holds(f"{done.stderr.strip()} But {determined} sets do", determined == 0 or method == "greedy")
        good = check.report(f"{told} {name} {method}", done) and good
    return good


def check_drawn(program, folder, problem_file, told):
    """Plans from candidates that the program draws: what they state of their own poses."""
    arm, good = Arm(problem_file), True
    for name in CRITERIA:
        if (name.startswith("test_pose") and "test_poses" not in arm.problem["design"]) or name in ("discriminate", "bias"):
            continue
        plan_file, check = folder / "plan.json", Check()
        done = subprocess.run([program, "plan", problem_file, "--criterion", name, "--candidates", "24", "--restarts", "1",
                               "--method", "exchange", "-o", plan_file, "--poses-csv", "-", "--force", "--quiet"],
                              capture_output=True, text=True)
        if done.returncode == 0:
            plan = json.loads(plan_file.read_text())
            poses = Poses([p["configuration"][:len(arm.joints)] for p in plan["poses"]])
            meaning, chosen = Definitions(arm, plan, poses), np.arange(len(poses.Q))
            check.same("value", meaning.value(name, np.array([chosen]), chosen)[0], plan["criterion"]["value"])
            check_numbers(plan, meaning, chosen, chosen, check)
        good = check.report(f"{told} {name}, drawn candidates", done) and good
    return good


def main(program, source, count="5", seed="1"):
    seed = secrets.randbelow(10**9) if seed == "fresh" else int(seed)
    print(f"seed {seed}")
    program, good = pathlib.Path(program).resolve(), True
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        good = check_drawn(program, folder, kr270(pathlib.Path(source).resolve(), folder), "KR 270")
        for k in range(int(count)):
            random = np.random.default_rng([seed, k])
            random_case(folder, random)
            good = check_case(program, folder, f"arm {k}", random) and good
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main(*sys.argv[1:])
