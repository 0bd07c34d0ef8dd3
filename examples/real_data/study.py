#!/usr/bin/env python3
"""Chooses N of measured poses by `posewright plan`, calibrates on those alone, validates on all others.

Beside it: random subsets of the same size, and the first N poses in the order of measuring. Writes CSV and SVG.

    study.py --program build/release/bin/posewright --data ../shared/data --out docs/images
"""

import argparse
import concurrent.futures
import csv
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent

# Folder of the example, folder of the data, title, numbers of poses.
SETS = [
    ("fanuc_r2000", "fanuc_r2000", "FANUC, reflectors", (6, 8, 10, 12)),
    ("franka_board", "franka_realsense_board", "Franka, camera", (8, 12, 20, 40)),
    ("rosi_positioner", "rosi_two_axis_positioner", "positioner, camera", (4, 6, 10, 20)),
]
# What chooses: name, options of `plan`.
PLANS = [
    ("plan, o1 of everything", ["--variant", "everything", "--criterion", "o1"]),
    ("plan, o1", ["--variant", "geometric", "--criterion", "o1"]),
    ("plan, test_pose", ["--variant", "everything", "--criterion", "test_pose"]),
    ("plan, unmodelled", ["--variant", "allowing"]),
]
FAILED = math.inf


class Study:
    def __init__(self, program, example, data, folder):
        self.program, self.problem = program, HERE / example / "problem.yaml"
        self.folder = folder
        self.file = folder / f"{example}.csv"
        subprocess.run([sys.executable, HERE / example / "convert.py", data, self.file], check=True)
        with open(self.file, newline="", encoding="utf-8") as file:
            self.header, *self.rows = csv.reader(file)
        self.ids = list(dict.fromkeys(row[0] for row in self.rows))
        self.all = self.calibrate(self.ids)
        self.parameters = self.all["parameters"]

    def run(self, arguments):
        done = subprocess.run([self.program, *map(str, arguments)], capture_output=True, text=True, check=False)
        return done.returncode, done.stdout, done.stderr

    def calibrate(self, fitted):
        """By plain least squares: number of parameters, RMS distance (m) and angle (rad) on the other poses, or on these where they are all."""
        kept = set(fitted)
        with tempfile.NamedTemporaryFile("w", suffix=".csv", dir=self.folder, newline="", encoding="utf-8") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(self.header + ["use"])
            for row in self.rows:
                writer.writerow(row + ["fit" if row[0] in kept else "validate"])
            file.flush()
            code, out, _ = self.run(["calibrate", self.problem, file.name, "--weights", "ols", "--no-prior", "--force",
                                     "--json", "--quiet", "--threads", 1])
        if code != 0:
            return {"parameters": 0, "distance": FAILED, "angle": FAILED}
        result = json.loads(out)
        which = "held back" if len(kept) < len(self.ids) else "fitted"
        rms = {(r["parameters"], r["kind"]): r["rms"] for r in result["residuals"] if r["poses"] == which}

        # Of a pose, three coordinates and the three of a rotation vector.
        def three(parameters, kind):
            return math.sqrt(3) * rms.get((parameters, kind), math.nan)

        return {"parameters": sum(p["estimated"] for p in result["parameters"]),
                "distance": rms.get(("calibrated", "distance"), three("calibrated", "m")),
                "placed": rms.get(("placed", "distance"), three("placed", "m")),
                "angle": three("calibrated", "rad")}

    def judge(self, fitted):
        result = self.calibrate(fitted)
        if result["parameters"] < self.parameters:
            result["distance"] = result["angle"] = FAILED
        return result

    def plan(self, poses, options):
        code, out, errors = self.run(["plan", self.problem, "--candidates-from", self.file, "--poses", poses, "--json",
                                      "-o", "-", "--poses-csv", "-", "--quiet", "--threads", 1, *options])
        if code != 0:
            sys.exit(errors)
        plan = json.loads(out)
        certificate = plan["certificate"]["candidates"] or {}
        return [str(pose["listed"]["id"]) for pose in plan["poses"]], certificate.get("efficiency", math.nan)

    def random_subsets(self, poses, draws, seed):
        chance = random.Random(f"{seed} {self.problem.parent.name} {poses}")
        return [chance.sample(self.ids, poses) for _ in range(draws)]


def quantile(values, share):
    """Linear between order statistics; infinite where a subset that failed has part in it."""
    ordered = sorted(values)
    at = share * (len(ordered) - 1)
    low, high = ordered[math.floor(at)], ordered[math.ceil(at)]
    return low if low == high else low + (at - math.floor(at)) * (high - low)


def rows_of(study, title, poses, draws, seed, workers):
    """One dictionary for each way of choosing."""
    rows = []

    def add(chosen_by, result, **more):
        rows.append({"set": title, "poses": poses, "chosen by": chosen_by, "distance mm": 1e3 * result["distance"],
                     "angle mrad": 1e3 * result["angle"], **more})

    subsets = study.random_subsets(poses, draws, seed)
    with concurrent.futures.ThreadPoolExecutor(workers) as pool:
        drawn = list(pool.map(study.judge, subsets))
        plans = list(pool.map(lambda p: study.plan(poses, p[1]), PLANS))
        judged = list(pool.map(study.judge, [ids for ids, _ in plans]))
    failures = sum(not math.isfinite(d["distance"]) for d in drawn)
    for (name, _), (ids, efficiency), result in zip(PLANS, plans, judged):
        better = sum(d["distance"] < result["distance"] for d in drawn)
        add(name, result, efficiency=efficiency, rank=better / draws, ids=" ".join(ids))
    for name, share in (("random, lower quartile", 0.25), ("random, median", 0.5), ("random, upper quartile", 0.75)):
        add(name, {k: quantile([d[k] for d in drawn], share) for k in ("distance", "angle")}, failures=failures)
    add("own order", study.judge(study.ids[:poses]))
    return rows


FIELDS = ["set", "poses", "chosen by", "distance mm", "angle mrad", "efficiency", "rank", "failures", "ids"]


def write_csv(path, rows):
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, FIELDS, restval="", lineterminator="\n")
        writer.writeheader()
        for row in rows:
            writer.writerow({k: f"{v:.4g}" if isinstance(v, float) else v for k, v in row.items()})


def panel(rows, title, left, floor):
    """One set: bars from quartile to quartile with the median, dots of the plan, crosses of the data's own order."""
    values = [r["distance mm"] for r in rows if math.isfinite(r["distance mm"])] + [floor]
    low, high = math.log10(min(values)) - 0.08, math.log10(max(values)) + 0.08
    width, top, bottom = 168, 40, 270

    def y(value):
        return bottom - (min(math.log10(value), high) - low) / (high - low) * (bottom - top)

    text = [f'<text x="{left}" y="22" fill="#222">{title}</text>']
    ticks = [m * 10.0 ** e for e in range(-3, 5) for m in (1, 2, 5) if low <= math.log10(m * 10.0 ** e) <= high]
    for tick in ticks:
        text.append(f'<line x1="{left}" x2="{left + width}" y1="{y(tick):.1f}" y2="{y(tick):.1f}" stroke="#ddd"/>'
                    f'<text x="{left - 5}" y="{y(tick) + 4:.1f}" text-anchor="end" fill="#444">{tick:g}</text>')
    text.append(f'<line x1="{left}" x2="{left + width}" y1="{y(floor):.1f}" y2="{y(floor):.1f}" stroke="#444" '
                'stroke-dasharray="4 3"/>')
    sizes = sorted({r["poses"] for r in rows})
    for i, poses in enumerate(sizes):
        x = left + width * (i + 0.5) / len(sizes)
        at = {r["chosen by"]: r["distance mm"] for r in rows if r["poses"] == poses}
        text.append(f'<text x="{x:.1f}" y="290" text-anchor="middle" fill="#444">{poses}</text>')
        ends = [y(at["random, lower quartile"]), y(at["random, upper quartile"]), y(at["random, median"])]
        text.append(f'<rect x="{x - 7:.1f}" y="{ends[1]:.1f}" width="14" height="{max(ends[0] - ends[1], 1):.1f}" '
                    f'fill="#b3541e" fill-opacity="0.3"/><line x1="{x - 7:.1f}" x2="{x + 7:.1f}" y1="{ends[2]:.1f}" '
                    f'y2="{ends[2]:.1f}" stroke="#b3541e" stroke-width="2"/>')
        text.append(f'<circle cx="{x:.1f}" cy="{y(at[PLANS[0][0]]):.1f}" r="4" fill="#1f6f8b"/>')
        v = y(at[PLANS[3][0]])
        text.append(f'<path d="M{x + 7:.1f} {v - 5:.1f}l5 5l-5 5l-5 -5z" fill="#5b8c2a"/>')
        if math.isfinite(at["own order"]):
            v = y(at["own order"])
            text.append(f'<path d="M{x - 4:.1f} {v - 4:.1f}l8 8m0 -8l-8 8" stroke="#444" stroke-width="1.5"/>')
    return "\n".join(text)


def write_svg(path, rows, floors):
    titles = list(dict.fromkeys(r["set"] for r in rows))
    panels = [panel([r for r in rows if r["set"] == title], title, 48 + 218 * i, floors[title])
              for i, title in enumerate(titles)]
    width = 218 * len(titles) + 20
    legend = ('<circle cx="54" cy="318" r="4" fill="#1f6f8b"/><text x="64" y="322" fill="#222">plan</text>'
              '<path d="M504 313l5 5l-5 5l-5 -5z" fill="#5b8c2a"/><text x="514" y="322" fill="#222">plan, unmodelled: auto</text>'
              '<rect x="110" y="311" width="14" height="14" fill="#b3541e" fill-opacity="0.3"/>'
              '<line x1="110" x2="124" y1="318" y2="318" stroke="#b3541e" stroke-width="2"/>'
              '<text x="130" y="322" fill="#222">random: quartiles, median</text>'
              '<path d="M308 314l8 8m0 -8l-8 8" stroke="#444" stroke-width="1.5"/>'
              '<text x="322" y="322" fill="#222">first N</text>'
              '<line x1="384" x2="404" y1="318" y2="318" stroke="#444" stroke-dasharray="4 3"/>'
              '<text x="410" y="322" fill="#222">all fitted</text>')
    path.write_text(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {max(width, 700)} 340" '
                    f'font-family="sans-serif" font-size="13"><rect width="{max(width, 700)}" height="340" '
                    'fill="#ffffff"/>\n' + "\n".join(panels) + "\n" + legend + "</svg>\n", encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--program", default="posewright", help="the posewright to run")
    parser.add_argument("--data", type=pathlib.Path, default=HERE.parents[1].parent / "shared" / "data")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("."), help="folder for real-data.csv and .svg")
    parser.add_argument("--draws", type=int, default=200)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("sets", nargs="*", help="names of examples (all)")
    options = parser.parse_args()
    rows, floors = [], {}
    with tempfile.TemporaryDirectory() as scratch:
        for example, data, title, sizes in SETS:
            if options.sets and example not in options.sets:
                continue
            if not (options.data / data).is_dir():
                sys.exit(f"{options.data / data}: no such folder; see examples/real_data/{example}/README.md")
            study = Study(options.program, example, options.data / data, pathlib.Path(scratch))
            floors[title] = 1e3 * study.all["distance"]
            print(f"{title}: {len(study.ids)} poses, {study.parameters} parameters, all fitted: "
                  f"{floors[title]:.4g} mm, {1e3 * study.all['angle']:.4g} mrad")
            for poses in sizes:
                rows += rows_of(study, title, poses, options.draws, options.seed, options.workers)
                for row in rows[-7:]:
                    print("  {poses:3d}  {chosen by:24s} {distance mm:9.4g} mm {angle mrad:9.4g} mrad  ".format(**row) +
                          ", ".join(f"{k} {row[k]:.3g}" for k in ("efficiency", "rank", "failures") if k in row))
    write_csv(options.out / "real-data.csv", rows)
    write_svg(options.out / "real-data.svg", rows, floors)


if __name__ == "__main__":
    main()
