#!/usr/bin/env python3
"""bench/proofs.py PROGRAM PROBLEM... [--options "..."]: what `plan` proves of each problem over the whole workspace, and in how long.

Every problem is planned without a proof on all threads (log det, what searches find, seconds) and with one on one thread
and on all. Prints a row of a Markdown table for each, and the sentence that users read. The two plans with a proof must be
the same to the last digit, but for a proof that was ended by time.
"""

import argparse
import json
import os
import pathlib
import resource
import subprocess
import sys
import tempfile
import time


def planned(program, problem, folder, *options):
    """@return plan.json, what was printed, wall and CPU seconds"""
    plan = os.path.join(folder, "plan.json")
    before, begin = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    done = subprocess.run([program, "plan", problem, "-o", plan, "--poses-csv", os.path.join(folder, "poses.csv"), "--force",
                           "--quiet", *options], capture_output=True, text=True, check=False)
    wall = time.monotonic() - begin
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode != 0:
        sys.exit(f"{problem}: {done.stderr.strip()}")
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return json.load(open(plan)), done.stdout, wall, cpu


def without_times(plan):
    statistics = {k: v for k, v in plan["statistics"].items() if k not in ("seconds", "stages")}
    return {**plan, "statistics": statistics}


def percent(value):
    return f"{100 * value:.2f} %"


def name_of(problem):
    path = pathlib.Path(problem)
    return path.parent.name if path.stem == "problem" else f"{path.parent.name}/{path.stem}"


def row(program, problem, folder, options):
    searched, _, _, search_cpu = planned(program, problem, folder, *options, "--proof-time", "0")
    one, _, _, one_cpu = planned(program, problem, folder, *options, "--threads", "1")
    plan, text, wall, _ = planned(program, problem, folder, *options)
    ends_by_time = "--proof-time" in options
    if not ends_by_time and without_times(one) != without_times(plan):
        sys.exit(f"{problem}: the plan depends on the number of threads")
    found, proof = searched["certificate"]["workspace"], plan["certificate"]["workspace"]
    proved = [percent(proof["efficiency"]), f"{proof['max_sensitivity_ratio']:.4f}", f"{proof['boxes']:,}"]
    if not proof["proved"]:
        proved = ["–", "–", "–"]
    values = [name_of(problem), str(len(plan["poses"])), f"{plan['criterion']['log_det']:.4f}", f"{search_cpu:.1f}", percent(found["efficiency"]), *proved,
              f"{one_cpu:.1f}", f"{wall:.1f}"]
    sentences = [line for line in text.splitlines() if line.startswith(("Over the whole workspace", "Proved over", "Proved within"))]
    return "| " + " | ".join(values) + " |", sentences


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("problems", nargs="+")
    parser.add_argument("--options", default="", help="for plan: --proof-time 600")
    arguments = parser.parse_args()
    print("| problem | N | log det | search, CPU s | searched | proved | largest d over h | boxes | with the proof, one thread, CPU s | all threads, wall s |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |")
    sentences = []
    with tempfile.TemporaryDirectory() as folder:
        for problem in arguments.problems:
            line, said = row(arguments.program, problem, folder, arguments.options.split())
            print(line, flush=True)
            sentences += [f"{name_of(problem)}: {sentence}" for sentence in said]
    print("\n" + "\n".join(sentences))


main()
