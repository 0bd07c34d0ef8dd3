#!/usr/bin/env python3
"""How long a cell takes with vendors' kinematics and meshes: observe, plan, route, report and stations of three cells.

    bench/cells/run.py build/release/bin/posewright ROBOTS [--only kuka_tracker] [--commands observe,plan]

ROBOTS holds the folders that the problem files name after ROBOTS/. Printed: wall and processor seconds of each command.
"""

import argparse
import pathlib
import resource
import subprocess
import tempfile
import time

CELLS = pathlib.Path(__file__).resolve().parents[2] / "examples/cells"


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
    parser.add_argument("--commands", default="observe,plan,route,report,stations")
    parser.add_argument("--keep", type=pathlib.Path, help="folder for what is written")
    options = parser.parse_args()
    program = str(options.program.resolve())
    folder = options.keep or pathlib.Path(tempfile.mkdtemp())
    folder.mkdir(parents=True, exist_ok=True)
    for mesh in CELLS.glob("*.stl"):
        (folder / mesh.name).write_bytes(mesh.read_bytes())
    for cell in sorted(CELLS.glob("*.yaml")):
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
        for name in options.commands.split(","):
            if name not in commands:
                continue
            wall, cpu, done = timed([program, *map(str, commands[name])])
            (folder / f"{cell.stem}.{name}.txt").write_text(done.stdout + done.stderr)
            word = "" if done.returncode == 0 else f"  exit {done.returncode}: {done.stderr.strip().splitlines()[-1]}"
            print(f"{cell.stem:14} {name:9} {wall:7.1f} s wall {cpu:7.1f} s processor{word}", flush=True)


if __name__ == "__main__":
    main()
