#!/usr/bin/env python3
"""bench/coverage.py PROGRAM [--draws 1000] [--plan PLAN.json]

Virtual calibrations of the rigid telescope with a plan for the tolerances: how many 95 % intervals hold the truth, the
linear ones and those by profile, with and without tolerances. Prints a Markdown table. About 15 minutes of processor
time; every number is read from what `simulate --profile --json` prints."""
import argparse
import json
import math
import pathlib
import subprocess
import tempfile

PROBLEM = pathlib.Path(__file__).resolve().parent.parent / "examples/telescope/problem.yaml"
GROUPS = [("12 leg directions", lambda name: name[-3:] in (".ux", ".uy")),
          ("30 others", lambda name: name[-3:] not in (".ux", ".uy")),
          ("all 42", lambda name: True)]


def simulated(program, plan, draws, options):
    done = subprocess.run([program, "simulate", PROBLEM, plan, "--variant", "rigid", "--draws", str(draws), "--profile",
                           "--json", *options], check=True, capture_output=True, text=True)
    return json.loads(done.stdout)


def cell(shares):
    return f"{100 * sum(shares) / len(shares):.1f} ({100 * min(shares):.1f} to {100 * max(shares):.1f}) %"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("--draws", type=int, default=1000)
    parser.add_argument("--plan", type=pathlib.Path, help="of `plan --variant rigid`; else one is made")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        plan = given.plan or pathlib.Path(folder) / "plan.json"
        if not given.plan:
            subprocess.run([given.program, "plan", PROBLEM, "--variant", "rigid", "--robust", "200", "-o", plan,
                            "--poses-csv", pathlib.Path(folder) / "poses.csv"], check=True, capture_output=True)
        print("| tolerances count | parameters | linear intervals cover | by profile |\n| --- | --- | --- | --- |")
        for words, options in (("no", ["--no-prior"]), ("yes", [])):
            result = simulated(given.program, plan, given.draws, options)
            for title, belongs in GROUPS:
                chosen = [p for p in result["parameters"] if belongs(p["name"])]
                print(f"| {words} | {title} | {cell([p['coverage'] for p in chosen])} "
                      f"| {cell([p['profile_coverage'] for p in chosen])} |")
            print(f"<!-- {result['draws']['fitted']} draws; one parameter ± "
                  f"{100 * math.sqrt(0.95 * 0.05 / result['draws']['fitted']):.2f} % -->")


if __name__ == "__main__":
    main()
