#!/usr/bin/env python3
"""How long a cell takes with vendors' kinematics and meshes: observe, plan, route, report and stations of five cells,
three of examples/cells and two beside this file.

    bench/cells/run.py build/release/bin/posewright ROBOTS [--only kuka_tracker] [--commands observe,plan]

ROBOTS holds the folders that the problem files name after ROBOTS/. Printed: wall and processor seconds of each command,
the load of the machine after it, log det of a plan. --table writes rows of docs/cell.md: processor (wall) seconds.
"""

import argparse
import json
import os
import pathlib
import resource
import subprocess
import tempfile
import time

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "examples/cells"
CELLS = sorted(EXAMPLES.glob("*.yaml")) + sorted(pathlib.Path(__file__).resolve().parent.glob("*.yaml"))
COMMANDS = ["observe", "plan", "route", "report", "stations"]


def timed(command):
    before, begin = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return time.monotonic() - begin, cpu, done


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("robots", type=pathlib.Path)
    parser.add_argument("--only", action="append")
    parser.add_argument("--commands", default=",".join(COMMANDS))
    parser.add_argument("--table", action="store_true", help="a row of docs/cell.md after each cell")
    parser.add_argument("--keep", type=pathlib.Path, help="folder for what is written")
    options = parser.parse_args()
    program = str(options.program.resolve())
    folder = options.keep or pathlib.Path(tempfile.mkdtemp())
    folder.mkdir(parents=True, exist_ok=True)
    for mesh in EXAMPLES.glob("*.stl"):
        (folder / mesh.name).write_bytes(mesh.read_bytes())
    for cell in CELLS:
        if options.only and cell.stem not in options.only:
            continue
        problem = folder / cell.name
        problem.write_text(cell.read_text().replace("ROBOTS", str(options.robots.resolve())))
        plan, common = folder / f"{cell.stem}.json", ["--quiet", "--force"]
        packages = [f"--package={p.name}={p}" for p in options.robots.resolve().glob("*/*") if p.is_dir()]
        commands = {
            "observe": ["observe", problem, "--quiet", *packages],
            "plan": ["plan", problem, "-o", plan, "--poses-csv", "-", *common, *packages],
            "route": ["route", plan, "--closed", "-o", folder / f"{cell.stem}.route.json", *common, *packages],
            "report": ["report", plan, "-o", folder / f"{cell.stem}.html", *common, *packages],
        }
        if "stations:" in problem.read_text().split("workspace:")[1]:
            commands["stations"] = ["stations", problem, "--quiet", *packages]
        row = {}
        for name in options.commands.split(","):
            if name not in commands:
                continue
            wall, cpu, done = timed([program, *map(str, commands[name])])
            (folder / f"{cell.stem}.{name}.txt").write_text(done.stdout + done.stderr)
            row[name] = f"{cpu:.1f} ({wall:.1f})" if done.returncode == 0 else f"exit {done.returncode}"
            word = "" if done.returncode == 0 else f"  exit {done.returncode}: {done.stderr.strip().splitlines()[-1]}"
            if name == "plan" and done.returncode == 0:
                word = f"  log det {json.loads(plan.read_text())['criterion']['log_det']:.6f}"
            load = os.getloadavg()[0]
            print(f"{cell.stem:14} {name:9} {wall:7.1f} s wall {cpu:7.1f} s processor  load {load:4.1f}{word}", flush=True)
        if options.table:
            print(f"| `{cell.stem}` | " + " | ".join(row.get(name, "-") for name in COMMANDS) + " |", flush=True)


if __name__ == "__main__":
    main()
