#!/usr/bin/env python3
"""Error at held-back poses over the number of poses, in the order of `posewright next` and in random orders.

    next_order.py --program build/release/bin/posewright --data ../shared/data --out docs/images

Every third pose of a set is held back. Among the others `next` chooses one after the other: what it proposes is measured by taking
its row. After each pose the robot is calibrated on those so far (variant `everything`, plain least squares) and judged by the poses
held back; beside it random orders. Writes next.csv and next.svg. What was computed is kept in next-order.jsonl and not computed again."""
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

SOURCE = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(SOURCE / "examples" / "real_data"))
import study  # noqa: E402

# Example, data, title; numbers of poses that are judged; variant by which `next` plans.
SETS = [
    ("fanuc_r2000", "fanuc_r2000", "FANUC, reflectors", [5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16]),
    ("franka_board", "franka_realsense_board", "Franka, camera", [7, 8, 10, 12, 15, 18, 22, 26, 30, 35, 40, 50, 60, 76]),
    ("rosi_positioner", "rosi_two_axis_positioner", "positioner, camera", [3, 4, 5, 6, 8, 10, 13, 16, 20, 25, 30, 40, 60, 100, 137]),
]
VARIANT, HELD_BACK, NEAR = "everything", 3, 1.10


class Order:
    """One set: which poses may be chosen, which are held back."""

    def __init__(self, program, example, data, folder):
        self.study = study.Study(program, example, data, folder)
        self.folder, self.problem = folder, SOURCE / "examples" / "real_data" / example / "problem.yaml"
        ids = self.study.ids
        self.held = set(ids[HELD_BACK - 1::HELD_BACK])
        self.pool = [i for i in ids if i not in self.held]
        self.rows = {}
        for row in self.study.rows:
            self.rows.setdefault(row[0], []).append(row)

    def write(self, file, ids, more=(), use=None):
        with open(file, "w", newline="", encoding="utf-8") as out:
            writer = csv.writer(out, lineterminator="\n")
            writer.writerow(self.study.header + ([use[0]] if use else []))
            for group, word in ((ids, "fit"), (more, "validate")):
                for i in group:
                    for row in self.rows[i]:
                        writer.writerow(row + ([word] if use else []))

    def chosen(self):
        """The pool in the order of `next`."""
        pool, data = self.folder / "pool.csv", self.folder / "so-far.csv"
        self.write(pool, self.pool)
        order = []
        while len(order) < len(self.pool):
            self.write(data, order)
            left = len(self.pool) - len(order)
            # The first poses together, as one who begins takes them; then one by one, and later in small groups.
            count = min(left, 6 if not order else 1 if len(order) < 40 else 4)
            code, out, errors = self.study.run(["next", self.problem, "--variant", VARIANT, "--data", data, "--no-prior", "-k", count,
                                                "--candidates-from", pool, "--state", "-", "--json", "--quiet", "--threads", 1])
            if code != 0:
                sys.exit(errors)
            said = json.loads(out)
            order += [str(pose["listed"]["id"]) for pose in said["poses"]]
        return order

    def judge(self, ids):
        """RMS distance at the poses held back, m."""
        with tempfile.NamedTemporaryFile("w", suffix=".csv", dir=self.folder) as file:
            self.write(file.name, ids, sorted(self.held, key=int), use=("use",))
            code, out, _ = self.study.run(["calibrate", self.problem, file.name, "--variant", VARIANT, "--weights", "ols", "--no-prior",
                                           "--force", "--json", "--quiet", "--threads", 1])
        if code != 0:
            return math.inf
        result = json.loads(out)
        rms = {(r["parameters"], r["kind"]): r["rms"] for r in result["residuals"] if r["poses"] == "held back"}
        if sum(p["estimated"] for p in result["parameters"]) < self.study.parameters:
            return math.inf
        return rms.get(("calibrated", "distance"), math.sqrt(3) * rms.get(("calibrated", "m"), math.inf))


def curves(order, name, sizes, draws, kept, workers):
    """Rows {set, poses, order, error}; `kept` knows those that were computed before."""
    with concurrent.futures.ThreadPoolExecutor(workers) as pool:
        if (name, "next", 0, 0) not in kept:
            kept.add({"set": name, "order": "next", "draw": 0, "poses": 0, "ids": order.chosen()})
        orders = {("next", 0): kept[(name, "next", 0, 0)]["ids"]}
        for draw in range(draws):
            ids = list(order.pool)
            random.Random(f"{name} {draw}").shuffle(ids)
            orders[("random", draw)] = ids
        jobs = [(kind, draw, n) for (kind, draw) in orders for n in sizes if (name, kind, draw, n) not in kept]
        for (kind, draw, n), error in zip(jobs, pool.map(lambda j: order.judge(orders[j[:2]][:j[2]]), jobs)):
            kept.add({"set": name, "order": kind, "draw": draw, "poses": n, "error": None if math.isinf(error) else error})


class Kept(dict):
    def __init__(self, file):
        super().__init__()
        self.file = file
        if file.exists():
            for line in file.read_text().rpartition("\n")[0].splitlines():
                self.take(json.loads(line))

    def take(self, row):
        self[(row["set"], row["order"], row["draw"], row["poses"])] = row

    def add(self, row):
        self.take(row)
        with open(self.file, "a") as out:
            out.write(json.dumps(row) + "\n")


def summarise(kept, name, sizes, draws):
    """Per number of poses: error by next, quartiles of the random orders, mm."""
    def error(kind, draw, n):
        value = kept[(name, kind, draw, n)]["error"]
        return math.inf if value is None else 1e3 * value

    rows = []
    for n in sizes:
        drawn = [error("random", d, n) for d in range(draws)]
        rows.append({"set": name, "poses": n, "next": error("next", 0, n),
                     **{q: study.quantile(drawn, s) for q, s in (("lower quartile", 0.25), ("median", 0.5), ("upper quartile", 0.75))}})
    return rows


def enough(rows, column, floor):
    """The first number of poses from which on the error stays within 10 % of that of all."""
    found = None
    for row in reversed(rows):
        if row[column] > NEAR * floor:
            break
        found = row["poses"]
    return found


def draw_panel(rows, title, left, floor):
    values = [v for r in rows for v in (r["next"], r["lower quartile"], r["upper quartile"], floor) if math.isfinite(v)]
    low, high = math.log10(min(values)) - 0.05, math.log10(min(max(values), 20 * floor)) + 0.05
    n0, n1 = math.log10(rows[0]["poses"]), math.log10(rows[-1]["poses"])
    width, top, bottom = 190, 44, 270

    def x(n):
        return left + width * (math.log10(n) - n0) / (n1 - n0)

    def y(value):
        return bottom - (min(math.log10(value), high) - low) / (high - low) * (bottom - top) if math.isfinite(value) else top

    text = [f'<text x="{left}" y="22" fill="#222">{title}</text>',
            f'<text x="{left + width}" y="288" text-anchor="end" fill="#444">poses</text>',
            f'<text x="{left}" y="37" fill="#444">mm</text>']
    for tick in (m * 10.0 ** e for e in range(-3, 4) for m in (1, 2, 5)):
        if low <= math.log10(tick) <= high:
            text.append(f'<line x1="{left}" x2="{left + width}" y1="{y(tick):.1f}" y2="{y(tick):.1f}" stroke="#ddd"/>'
                        f'<text x="{left - 5}" y="{y(tick) + 4:.1f}" text-anchor="end" fill="#444">{tick:g}</text>')
    for n in (5, 10, 20, 50, 100):
        if rows[0]["poses"] <= n <= 0.6 * rows[-1]["poses"]:
            text.append(f'<text x="{x(n):.1f}" y="288" text-anchor="middle" fill="#444">{n}</text>')
    band = [(r["poses"], r["upper quartile"]) for r in rows] + [(r["poses"], r["lower quartile"]) for r in reversed(rows)]
    text.append(f'<polygon points="{" ".join(f"{x(n):.1f},{y(v):.1f}" for n, v in band)}" fill="#b3541e" fill-opacity="0.2"/>')
    for column, colour, dash in (("median", "#b3541e", ""), ("next", "#1f6f8b", "")):
        points = " ".join(f"{x(r['poses']):.1f},{y(r[column]):.1f}" for r in rows if math.isfinite(r[column]))
        text.append(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="2"{dash}/>')
    v = y(NEAR * floor)
    text.append(f'<line x1="{left}" x2="{left + width}" y1="{v:.1f}" y2="{v:.1f}" stroke="#444" stroke-dasharray="4 3"/>')
    return "\n".join(text)


def write_svg(path, panels):
    width = 245 * len(panels) + 20
    legend = ('<path d="M54 314h24" stroke="#1f6f8b" stroke-width="2"/><text x="84" y="318" fill="#222">order of next</text>'
              '<rect x="190" y="307" width="24" height="14" fill="#b3541e" fill-opacity="0.2"/><path d="M190 314h24" stroke="#b3541e" '
              'stroke-width="2"/><text x="220" y="318" fill="#222">random orders: quartiles, median</text>'
              '<path d="M478 314h24" stroke="#444" stroke-dasharray="4 3"/><text x="508" y="318" fill="#222">all poses fitted, + 10 %</text>')
    path.write_text(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {max(width, 700)} 335" font-family="sans-serif" font-size="13">'
                    f'<rect width="{max(width, 700)}" height="335" fill="#ffffff"/>\n' + "\n".join(panels) + "\n" + legend + "</svg>\n",
                    encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--program", default="posewright")
    parser.add_argument("--data", type=pathlib.Path, default=SOURCE.parent / "shared" / "data")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("."), help="folder for next.csv and next.svg")
    parser.add_argument("--kept", type=pathlib.Path, default=pathlib.Path("next-order.jsonl"), help="what was computed before")
    parser.add_argument("--draws", type=int, default=50)
    parser.add_argument("--workers", type=int, default=1)
    parser.add_argument("sets", nargs="*", help="names of examples (all)")
    options = parser.parse_args()
    kept, table, panels = Kept(options.kept), [], []
    for example, data, title, sizes in SETS:
        if options.sets and example not in options.sets:
            continue
        with tempfile.TemporaryDirectory() as scratch:
            order = Order(str(pathlib.Path(options.program).resolve()), example, options.data / data, pathlib.Path(scratch))
            sizes = [n for n in sizes if n < len(order.pool)] + [len(order.pool)]
            curves(order, title, sizes, options.draws, kept, options.workers)
        rows = summarise(kept, title, sizes, options.draws)
        floor = rows[-1]["next"]
        print(f"{title}: {len(order.pool)} poses to choose from, {len(order.held)} held back; all fitted {floor:.3g} mm; within 10 % "
              f"of it from {enough(rows, 'next', floor)} poses on by next, {enough(rows, 'median', floor)} by the median random order")
        for row in rows:
            print("  {poses:4d}  next {next:7.3f}  random {lower quartile:7.3f} {median:7.3f} {upper quartile:7.3f} mm".format(**row))
        table += rows
        panels.append(draw_panel(rows, title, 48 + 245 * len(panels), floor))
    with open(options.out / "next.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, ["set", "poses", "next", "lower quartile", "median", "upper quartile"], lineterminator="\n")
        writer.writeheader()
        for row in table:
            writer.writerow({k: f"{v:.4g}" if isinstance(v, float) else v for k, v in row.items()})
    write_svg(options.out / "next.svg", panels)


if __name__ == "__main__":
    main()
