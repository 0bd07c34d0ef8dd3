#!/usr/bin/env python3
"""study.py [--program POSEWRIGHT] [--data FOLDER] [--out FOLDER] [--draws N]: error against the number of measured poses.

Plans choose among the 1,000 poses of the grid; `calibrate` fits the chosen ones with its defaults; the 20 random poses judge (RMS distance). Random subsets of
the grid stand beside them. Writes ur5.csv and ur5.svg.
"""

import argparse
import concurrent.futures
import csv
import json
import math
import pathlib
import random
import statistics
import subprocess
import sys
import tempfile

import convert

HERE = pathlib.Path(__file__).resolve().parent
SIZES = (15, 20, 30, 60)
CRITERIA = {"bias": "planned, criterion bias", "o1": "planned, criterion o1"}
# Mean error that the author of the data states for a calibrated model with a graph network, both made from all 1,000 poses.
PUBLISHED = 0.155


def run(program, *words):
    done = subprocess.run([program, *map(str, words)], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stderr)
    return json.loads(done.stdout)


def error(program, head, rows, chosen, folder):
    """Millimetres at the poses of random.csv."""
    with tempfile.NamedTemporaryFile("w", suffix=".csv", dir=folder) as file:
        file.write("\n".join([head] + [rows[k] for k in chosen]) + "\n")
        file.flush()
        result = run(program, "calibrate", HERE / "problem.yaml", file.name, "--validate", folder / "random.csv", "--profile", "none", "--json", "--quiet",
                     "--threads", 1)
    return next(1e3 * r["rms"] for r in result["residuals"]
                if r["poses"] != "fitted" and r["kind"] == "distance" and r["parameters"] == "calibrated")


def planned(program, poses, criterion, folder):
    plan = run(program, "plan", HERE / "problem.yaml", "--candidates-from", folder / "grid.csv", "--poses", poses, "--criterion", criterion, "--json", "-o", "-",
               "--poses-csv", "-", "--quiet")
    return [int(pose["listed"]["id"]) - 1 for pose in plan["poses"]]


def study(program, folder, draws):
    head, *rows = (folder / "grid.csv").read_text().splitlines()
    table = []
    for poses in SIZES:
        found = {"poses": poses}
        for criterion in CRITERIA:
            found[criterion] = error(program, head, rows, planned(program, poses, criterion, folder), folder)
        subsets = [random.Random(f"{poses} {k}").sample(range(len(rows)), poses) for k in range(draws)]
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            errors = list(pool.map(lambda chosen: error(program, head, rows, chosen, folder), subsets))
        found["lower"], found["median"], found["upper"] = statistics.quantiles(errors, n=4)
        for criterion in CRITERIA:
            found[f"{criterion} beaten by"] = sum(e < found[criterion] for e in errors) / draws
        print("  ".join(f"{key} {value:.4g}" for key, value in found.items()), flush=True)
        table.append(found)
    return table


def chart(table):
    left, right, top, bottom, most = 70, 560, 40, 300, 0.18
    x = lambda n: left + (right - left) * (math.log(n) - math.log(13)) / (math.log(70) - math.log(13))
    y = lambda e: bottom - (bottom - top) * e / most
    out = ['<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 820 350" font-family="sans-serif" font-size="14">', '<rect width="820" height="350" fill="#fff"/>',
           f'<text x="{left}" y="24" fill="#222">Error of a UR5 at 20 random poses, mm</text>']
    for tick in (0, 0.05, 0.1, 0.15):
        out.append(f'<line x1="{left}" x2="{right}" y1="{y(tick):.1f}" y2="{y(tick):.1f}" stroke="#ddd"/>'
                   f'<text x="{left - 8}" y="{y(tick) + 5:.1f}" text-anchor="end" fill="#444">{tick:g}</text>')
    for n in SIZES:
        out.append(f'<text x="{x(n):.1f}" y="{bottom + 20}" text-anchor="middle" fill="#444">{n}</text>')
    out.append(f'<text x="{(left + right) / 2:.0f}" y="{bottom + 42}" text-anchor="middle" fill="#444">measured poses</text>')
    out.append(f'<line x1="{left}" x2="{right}" y1="{y(PUBLISHED):.1f}" y2="{y(PUBLISHED):.1f}" stroke="#444" stroke-dasharray="6 4"/>')
    labels = [(PUBLISHED, "published: network, 1,000 poses", "#444")]
    band = [(x(r["poses"]), y(r["upper"])) for r in table] + [(x(r["poses"]), y(r["lower"])) for r in reversed(table)]
    out.append(f'<polygon points="{" ".join("%.1f,%.1f" % p for p in band)}" fill="#b3541e" fill-opacity="0.18"/>')
    for key, title, colour in (("median", "random poses: median, quartiles", "#b3541e"), ("o1", CRITERIA["o1"], "#7a8796"), ("bias", CRITERIA["bias"], "#1f6f8b")):
        points = [(x(r["poses"]), y(r[key])) for r in table]
        out.append(f'<polyline points="{" ".join("%.1f,%.1f" % p for p in points)}" fill="none" stroke="{colour}" stroke-width="2.5"/>')
        out += [f'<circle cx="{a:.1f}" cy="{b:.1f}" r="4" fill="{colour}"/>' for a, b in points]
        labels.append((table[-1][key], title, colour))
    below = top
    for value, title, colour in sorted(labels, reverse=True):
        below = max(below + 20, y(value))
        out.append(f'<text x="{right + 12}" y="{below + 5:.1f}" fill="{colour}">{title}</text>')
    return "\n".join(out + ["</svg>"]) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--program", default="posewright", help="the posewright to run")
    parser.add_argument("--data", type=pathlib.Path, default=convert.FOLDER)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("."), help="folder for ur5.csv and ur5.svg")
    parser.add_argument("--draws", type=int, default=200)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        convert.convert(options.data, pathlib.Path(scratch))
        table = study(options.program, pathlib.Path(scratch), options.draws)
    with open(options.out / "ur5.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(table[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows({key: f"{value:.4g}" for key, value in row.items()} for row in table)
    (options.out / "ur5.svg").write_text(chart(table), encoding="utf-8")


if __name__ == "__main__":
    main()
