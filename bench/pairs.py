#!/usr/bin/env python3
"""Commands that people wait for: CPU seconds of whole processes, two programs in turn, medians.

    bench/pairs.py BEFORE AFTER [--rows report,help] [--times 2] [--robots ROBOTS] [--kept]

Each row runs BEFORE, AFTER, BEFORE, AFTER, … on the same files, which AFTER prepares. ROBOTS has the makers' robots of
examples/cells/README.md; rows that need them are left out without. Prints a row of a Markdown table for each, with the
peak memory of AFTER and one figure of the result of both: log det, a share of the best, bytes of a page.
Candidates are drawn anew; with --kept each row runs once before, so AFTER finds those that it kept.
"""

import argparse
import json
import pathlib
import os
import shutil
import statistics
import subprocess
import sys
import tempfile

import numpy as np

EXAMPLES = pathlib.Path(__file__).resolve().parents[1] / "examples"
PLAN = ["-o", "out.json", "--poses-csv", "-", "--force", "--quiet"]
SELECT = ["-o", "out.json", "--force", "--quiet"]
LACKING = "  lacking: {parameters: auto, unmodelled: auto}\n"


def run(program, words, folder):
    """@return CPU seconds of the process and its children, its peak memory in MiB, its output"""
    process = subprocess.Popen([program, *words], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    text = process.stdout.read()
    _, status, usage = os.wait4(process.pid, 0)
    if os.waitstatus_to_exitcode(status) not in (0, 1):
        sys.exit(f"{' '.join(words)}: {text}")
    return usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024, text


def log_det(folder, _):
    plan = json.loads((folder / "out.json").read_text())
    proved = plan["certificate"].get("workspace") or plan["certificate"]
    share = proved.get("efficiency")
    return f"{plan['criterion']['log_det']:.4f}" + (f", {100 * share:.2f} %" if share else "")


def select_log_det(folder, _):
    plan = json.loads((folder / "out.json").read_text())
    return f"{plan['criterion']['value'] if 'log_det' not in plan['criterion'] else plan['criterion']['log_det']:.6f}"


def page_bytes(folder, _):
    return f"{(folder / 'out.html').stat().st_size / 1e6:.2f} MB"


def changes(_, text):
    result = json.loads(text)
    return ", ".join(f"{name} {result[name]['log_det']:.4f}" for name in ("drop", "add"))


def new_poses(_, text):
    left_out = json.loads(text)["left_out"]
    return f"{left_out['estimated']:.5g}"


def nothing(_, __):
    return "–"


def gaussian(folder, n, m, seed):
    name = f"gaussian-{n}-{m}.npy"
    # In a process of its own: the peak memory of a child is at least that of its parent.
    make = f"import numpy as np; np.save({name!r}, np.random.default_rng({seed}).standard_normal(({n}, {m})).reshape({n}, 1, {m}))"
    if not (folder / name).exists():
        subprocess.run([sys.executable, "-c", make], cwd=folder, check=True)
    return name


def measured(program, folder, poses):
    """Readings of random poses of the KR 270 with a tracker, simulated."""
    name = f"measured-{poses}.csv"
    if not (folder / name).exists():
        low, high = np.array([-150, -140, -100, -180, -110, -180]), np.array([150, -10, 140, 180, 110, 180])
        rows = np.random.default_rng(poses).uniform(low, high, (poses, 6))
        text = "pose," + ",".join(f"joint_a{j} [deg]" for j in range(1, 7)) + "\n"
        text += "".join(f"{k + 1}," + ",".join(f"{q:.6f}" for q in row) + "\n" for k, row in enumerate(rows))
        (folder / "random.csv").write_text(text)
        run(program, ["simulate", "examples/kr270/problem.yaml", "random.csv", "--draws", "2", "--data", name, "--force", "--quiet"], folder)
    return name


def planned(program, folder, problem, poses, *options, restarts=1):
    """A plan to go on with, found in little time. With ten restarts it states what other numbers of poses reach."""
    name = f"{pathlib.Path(problem).parent.name}-{pathlib.Path(problem).stem}-{poses}-{restarts}"
    if not (folder / f"{name}.json").exists():
        run(program, ["plan", problem, "--poses", str(poses), "--restarts", str(restarts), "--method", "exchange", "--proof-time", "0", *options,
                      "-o", f"{name}.json", "--poses-csv", f"{name}.csv", "--force", "--quiet"], folder)
    return name


def eight_joints(folder):
    """An arm of eight joints, axes in turn about z, y and x."""
    axes, urdf = ["0 0 1", "0 1 0", "1 0 0"], '<robot name="eight"><link name="l0"/>\n'
    for j in range(1, 9):
        urdf += (f'<link name="l{j}"/><joint name="j{j}" type="revolute"><parent link="l{j - 1}"/><child link="l{j}"/><origin xyz="0.05 0 {0.3 - 0.02 * j}"/>'
                 f'<axis xyz="{axes[j % 3]}"/><limit lower="-2.4" upper="2.4" effort="1" velocity="1"/></joint>\n')
    (folder / "eight.urdf").write_text(urdf + "</robot>\n")
    (folder / "eight.yaml").write_text(
        "posewright: 1\nrobot: {urdf: eight.urdf, tip: l8}\nmeasurement: {type: points, targets: {P1: [0.1, 0, 0.1], P2: [-0.1, 0.05, 0.1], P3: [0, -0.1, 0.1]}, "
        'device: {type: isotropic, noise: "0.1 mm"}}\nvariants: {geometric: {parameters: auto, nuisance: ["base.*", "target.*"]}}\ndesign: {criterion: o1, poses: 24}\n')
    return "eight.yaml"


def rows(program, folder, robots):
    """@return name → its words and its figure; files are made when a row is asked for"""
    cell, kr270 = "examples/cell/problem.yaml", "examples/kr270/problem.yaml"

    def report(problem, poses):
        return ["report", planned(program, folder, problem, poses, restarts=10) + ".json", "-o", "out.html", "--force", "--quiet"], page_bytes

    def calibrate(poses, variant):
        return ["calibrate", "examples/kr270/unmodelled.yaml", measured(program, folder, poses), "--variant", variant, "--json", "-o", "-"], new_poses

    def select(file, *words):
        return ["select", file, *words, *SELECT], select_log_det

    table = {
        "help": lambda: (["--help"], nothing),
        "report kr270, 30 poses": lambda: report(kr270, 30),
        "report kr270, 300 poses": lambda: report(kr270, 300),
        "report kr270, 1,000 poses": lambda: report(kr270, 1000),
        "report cell, 30 poses": lambda: report(cell, 30),
        "report cell, 300 poses": lambda: report(cell, 300),
        "evaluate --drop 2 --add 2, cell, 30 poses": lambda: (
            ["evaluate", cell, planned(program, folder, cell, 30) + ".csv", "--drop", "2", "--add", "2", "--json", "--quiet"], changes),
        "plan kr270": lambda: (["plan", kr270, *PLAN], log_det),
        "plan cell": lambda: (["plan", cell, *PLAN], log_det),
        "plan telescope": lambda: (["plan", "examples/telescope/problem.yaml", *PLAN], log_det),
        "plan two stations": lambda: (["plan", "examples/instruments/tracker_two_stations.yaml", *PLAN], log_det),
        "plan 8 joints": lambda: (["plan", eight_joints(folder), *PLAN], log_det),
        "select greedy 1,000,000 x 20, 40": lambda: select(gaussian(folder, 1_000_000, 20, 1), "--poses", "40", "--method", "greedy"),
        "select 5,000 x 10, 700": lambda: select(gaussian(folder, 5000, 10, 1), "--poses", "700"),
        "select 5,000 x 10, 1,000": lambda: select(gaussian(folder, 5000, 10, 1), "--poses", "1000"),
        **{f"select 5,000 x 30, 60, {k} restarts": lambda k=k: select(gaussian(folder, 5000, 30, 20240001), "--poses", "60", "--restarts", str(k)) for k in (10, 40, 100, 300)},
        **{f"calibrate {n}{', unmodelled' if v == 'lacking' else ''}": lambda n=n, v=v: calibrate(n, v) for n in (30, 100, 300, 1000) for v in ("geometric", "lacking")},
    }
    for problem in sorted((folder / "examples/cells").glob("*.yaml")) if robots else []:
        table[f"plan {problem.stem}"] = lambda problem=problem: (["plan", str(problem), *PLAN], log_det)
    return table


def prepare(folder, robots):
    shutil.copytree(EXAMPLES, folder / "examples", ignore=shutil.ignore_patterns("real_data", "notebook"))
    kr270 = folder / "examples/kr270"
    (kr270 / "unmodelled.yaml").write_text((kr270 / "problem.yaml").read_text().replace("  automatic:", LACKING + "  automatic:", 1))
    for problem in (folder / "examples/cells").glob("*.yaml"):
        problem.write_text(problem.read_text().replace("ROBOTS", str(robots)))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("before", type=pathlib.Path)
    parser.add_argument("after", type=pathlib.Path)
    parser.add_argument("--rows", default="", help="beginnings of names, with commas; all")
    parser.add_argument("--times", type=int, default=2)
    parser.add_argument("--robots", type=pathlib.Path)
    parser.add_argument("--kept", action="store_true")
    arguments = parser.parse_args()
    wanted = tuple(arguments.rows.split(",")) if arguments.rows else ("",)
    programs = [arguments.before.resolve(), arguments.after.resolve()]
    print("| command | before: CPU s | after | MiB | result before | after |\n| --- | --- | --- | --- | --- | --- |")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        robots = arguments.robots.resolve() if arguments.robots else None
        prepare(folder, robots)
        os.environ["POSEWRIGHT_CACHE"] = str(folder / "kept") if arguments.kept else "off"
        for title, make in rows(programs[1], folder, robots).items():
            if not title.startswith(wanted):
                continue
            words, figure = make()
            seconds, results = [[], []], [None, None]
            if arguments.kept:
                run(programs[1], words, folder)
            for _ in range(arguments.times):
                for k, program in enumerate(programs):
                    cpu, memory, text = run(program, words, folder)
                    seconds[k].append(cpu)
                    results[k] = figure(folder, text)
            before, after = (statistics.median(s) for s in seconds)
            print(f"| {title} | {before:.3g} | {after:.3g} | {memory:.0f} | {results[0]} | {results[1]} |", flush=True)


if __name__ == "__main__":
    main()
