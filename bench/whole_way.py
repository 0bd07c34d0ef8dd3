#!/usr/bin/env python3
"""From a URDF to compensated programs, each command with its seconds and the lines that it begins with, as Markdown.

    whole_way.py PROGRAM URDF --tip tool0 [--package NAME=DIR…] [--controller NAME] [--lines 8] > transcript.md

The robot is any serial arm; instrument and cell are what `init` proposes for a laser tracker."""
import argparse
import pathlib
import resource
import subprocess
import tempfile
import time


def parse():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("urdf", type=pathlib.Path)
    parser.add_argument("--tip", required=True)
    parser.add_argument("--package", action="append", default=[])
    parser.add_argument("--controller")
    parser.add_argument("--lines", type=int, default=8)
    return parser.parse_args()


def commands(urdf, tip, controller):
    named = f" --controller {controller}" if controller else ""
    yield f"init {urdf} --tracker --tip {tip} --yes"
    yield "observe problem.yaml"
    yield "plan problem.yaml"
    yield "evaluate problem.yaml poses.csv --drop 2 --add 2"
    yield "plan problem.yaml --poses 20 -o smaller.json --poses-csv smaller.csv"
    yield "compare problem.yaml plan.json smaller.json"
    yield "route plan.json --from-home --closed"
    yield f"export route.json --to kuka-krl{named} -o CALPOSES.src"
    yield "simulate problem.yaml plan.json --draws 200 --data measured.csv"
    yield "next problem.yaml --data none.csv -k 6 -o next.csv"
    yield "next problem.yaml --data measured.csv -k 2 -o two.csv --required 0.1mm --state other.json"
    yield "calibrate problem.yaml measured.csv -o calibrated.yaml --urdf calibrated.urdf"
    yield f"compensate calibrated.yaml CALPOSES.src CALPOSES.dat -o corrected/{named}"
    yield "compensate calibrated.yaml poses.csv -o commanded.csv"
    yield "plan problem.yaml --parameters calibrated.yaml --poses 12 -o again.json --poses-csv again.csv"
    yield "report plan.json --route route.json -o plan.html"
    yield "calibrate problem.yaml measured.csv --json > calibration.json"
    yield "report calibration.json -o calibration.html"


def main():
    arguments = parse()
    program, packages = arguments.program.resolve(), [word for p in arguments.package for word in ("--package", p)]
    with tempfile.TemporaryDirectory() as folder:
        for command in commands(arguments.urdf.resolve(), arguments.tip, arguments.controller):
            words, _, file = command.partition(" > ")
            before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
            done = subprocess.run([program, *words.split(), *([] if words.startswith("report calibration") else packages)], cwd=folder, capture_output=True, text=True)
            if file:
                (pathlib.Path(folder) / file).write_text(done.stdout)
                done.stdout = ""
            wall, after = time.monotonic() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
            cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
            shown = command.replace(str(arguments.urdf.resolve()), arguments.urdf.name)
            print(f"$ posewright {shown}\n# {wall:.1f} s, {cpu:.1f} s of processor time" + (f", exit status {done.returncode}" if done.returncode else ""))
            lines = [line for line in (done.stdout + (done.stderr if done.returncode else "")).splitlines() if line.strip()]
            print("\n".join(f"    {line}" for line in lines[:arguments.lines]) + "\n")


if __name__ == "__main__":
    main()
