#!/usr/bin/env python3
"""Compares the verdict of `calibrate` on subsets of measured poses with the errors at other poses.

Half of the subsets are random, half are rows as they follow in the file. Prints a table as Markdown.

    verdicts.py --program build/release/bin/posewright --data ../shared/data --draws 300
"""

import argparse
import collections
import csv
import json
import pathlib
import random
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent

# Folder of the example, folder of the data, smallest and largest number of fitted poses.
SETS = [
    ("fanuc_r2000", "fanuc_r2000", 6, 22),
    ("franka_board", "franka_realsense_board", 5, 40),
    ("rosi_positioner", "rosi_two_axis_positioner", 3, 30),
]
MOST_OTHERS = 80
VERDICTS = ["use it", "gain not shown", "do not use"]
# Upper limits of errors with the estimate over errors with base and tool alone.
SIZES = {"better": 1.0, "worse by less than 2 %": 1.02, "worse": float("inf")}


def split(ids, chance, draw, fewest, most):
    """Ids to fit and ids that judge."""
    count = chance.randint(fewest, most)
    first = chance.randrange(len(ids) - count + 1) if draw % 2 == 0 else None
    fitted = chance.sample(ids, count) if first is None else ids[first:first + count]
    others = [i for i in ids if i not in set(fitted)]
    return set(fitted), set(chance.sample(others, min(MOST_OTHERS, len(others))))


def judged(program, problem, head, rows, fitted, others, file):
    """Verdict, and size of the errors at the other poses."""
    with open(file, "w", newline="") as out:
        writer = csv.writer(out)
        writer.writerow(head + ["use"])
        writer.writerows(row + ["fit" if row[0] in fitted else "validate"] for row in rows if row[0] in fitted | others)
    done = subprocess.run([program, "calibrate", problem, file, "--json", "--force", "--profile", "none"], capture_output=True, text=True)
    if not done.stdout:
        sys.exit(done.stderr)
    result = json.loads(done.stdout)
    errors = {r["parameters"]: r["rms"] for r in reversed(result["residuals"]) if r["poses"] == "held back" and r["kind"] in ("distance", "m")}
    ratio = errors["calibrated"] / errors["placed"]
    return result["verdict"], next(name for name, limit in SIZES.items() if ratio < limit)


def main():
    options = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    options.add_argument("--program", required=True)
    options.add_argument("--data", type=pathlib.Path, required=True)
    options.add_argument("--draws", type=int, default=300)
    given = options.parse_args()
    print(f"| set | verdict | {' | '.join(SIZES)} |\n| --- | --- |{' --- |' * len(SIZES)}")
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "all.csv"
        for example, data, fewest, most in SETS:
            subprocess.run([sys.executable, HERE / example / "convert.py", given.data / data, file], check=True)
            with open(file) as table:
                head, *rows = csv.reader(table)
            ids = list(dict.fromkeys(row[0] for row in rows))
            counts = collections.Counter()
            for draw in range(given.draws):
                fitted, others = split(ids, random.Random(f"{example} {draw}"), draw, fewest, most)
                counts[judged(given.program, HERE / example / "problem.yaml", head, rows, fitted, others, pathlib.Path(folder) / "some.csv")] += 1
            for verdict in VERDICTS:
                print(f"| {example} | {verdict} | " + " | ".join(str(counts[verdict, size]) for size in SIZES) + " |", flush=True)


main()
