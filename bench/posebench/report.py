"""Table and figure of the rows of a run."""
import csv
import math

import numpy as np

FIELDS = ("set", "poses", "solver", "estimation", "unit", "value", "ratio", "better", "lower", "upper", "draws", "efficiency", "merit", "predicted",
          "coverage", "cpu", "memory", "settings", "version", "seed", "date", "source")
PLAIN, PROGRAM = "plain least squares", "posewright's defaults"


def number(text):
    try:
        return float(text)
    except (TypeError, ValueError):
        return text or None


def read(path):
    with open(path, newline="", encoding="utf-8") as file:
        return [{key: number(value) if key not in ("set", "solver", "estimation") else value for key, value in row.items()} for row in csv.DictReader(file)]


def write_csv(path, rows):
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, FIELDS, restval="", lineterminator="\n")
        writer.writeheader()
        for row in rows:
            writer.writerow({key: f"{value:.6g}" if isinstance(value, float) else value for key, value in row.items() if value is not None})


def area(rows, key="ratio"):
    """Mean of a column over the logarithm of the number of poses (trapezoids)."""
    rows = sorted(rows, key=lambda row: row["poses"])
    x, y = np.log([row["poses"] for row in rows]), np.array([row[key] for row in rows])
    return y[0] if len(y) == 1 else float(((y[1:] + y[:-1]) / 2 * np.diff(x)).sum() / (x[-1] - x[0]))


def ordered(values):
    return list(dict.fromkeys(values))


def markdown(header, lines):
    return "\n".join(["| " + " | ".join(header) + " |", "|" + " --- |" * len(header)] + ["| " + " | ".join(line) + " |" for line in lines]) + "\n"


def robots_table(rows, estimation):
    """Solvers by robots: area relative to random, mean share of random sets that are better."""
    rows = [row for row in rows if row["unit"] and row["estimation"] == estimation and row.get("ratio") is not None]
    sets = ordered(row["set"] for row in rows)

    def cell(solver, name):
        mine = [row for row in rows if (row["solver"], row["set"]) == (solver, name)]
        return f"{area(mine):.2f}, {100 * area(mine, 'better'):.0f} %" if mine else "–"
    lines = [[solver] + [cell(solver, name) for name in sets] for solver in ordered(row["solver"] for row in rows)]
    return markdown(["solver", *sets], sorted(lines, key=lambda line: np.mean([float(c.split(",")[0]) for c in line[1:] if c != "–"]))) if lines else ""


def estimators_table(rows, solver):
    """Estimations by robots on the poses of one solver, as errors over the random median of plain least squares."""
    base = {(r["set"], r["poses"]): r["value"] for r in rows if r["solver"] == "random" and r["estimation"] == PLAIN}
    mine = [dict(r, ratio=r["value"] / base[r["set"], r["poses"]]) for r in rows if r["solver"] == solver and r["unit"] == "mm" and (r["set"], r["poses"]) in base]
    sets = ordered(r["set"] for r in mine)
    lines = [[name] + [f"{area([r for r in mine if r['set'] == s and r['estimation'] == name]):.2f}" for s in sets]
             for name in ordered(r["estimation"] for r in mine)]
    return markdown([f"estimation, poses of {solver}", *sets], lines) if lines else ""


def instances_table(rows):
    """Certified efficiency, CPU seconds and memory on the design instances."""
    mine = [row for row in rows if not row["unit"] and row["estimation"] == "information"]
    lines = []
    for name in ordered(row["set"] for row in mine):
        for row in sorted((r for r in mine if r["set"] == name), key=lambda r: -(r.get("efficiency") or 0)):
            share, cpu, memory = row.get("efficiency"), row.get("cpu"), row.get("memory")
            lines.append([name, f"{row['poses']:g}", row["solver"] + (f" ({row['settings']})" if row.get("settings") else ""),
                          f"{math.floor(1e4 * share) / 100:.2f} %" if share else "–", f"{cpu:.2f}" if cpu is not None else "–",
                          f"{memory:.0f}" if memory is not None else "–", row.get("version") or ""])
    return markdown(["instance", "N", "solver", "certified efficiency", "CPU s", "MiB", "stored: version"], lines) if lines else ""


def trust_table(rows):
    """Coverage of 95 % intervals, and predicted over observed error."""
    lines = [[r["set"], r["estimation"], f"{100 * r['coverage']:.1f} %"] for r in rows if r.get("coverage") is not None]
    ratios = [r for r in rows if r.get("predicted") is not None]
    text = markdown(["set", "intervals of", "hold the other half"], lines) if lines else ""
    lines = [[name, solver, ", ".join(f"{r['predicted']:.2f}" for r in ratios if (r["set"], r["solver"]) == (name, solver))]
             for name in ordered(r["set"] for r in ratios) for solver in ordered(r["solver"] for r in ratios if r["set"] == name)
             if solver in ("posewright", "posewright-o1", "farthest-point")]
    return text + ("\n" + markdown(["set", "solver", "predicted / observed error, by number of poses"], lines) if lines else "")


HEAD = """# posebench

This page is written by `bench/posebench/run`; `bench/posebench/README.md` has the measures, and how to add a set or a solver. Data of this run: [posebench.csv](images/posebench.csv).

![Error at poses that judge over the number of measured poses: planned, random, farthest point](images/posebench.svg)"""
AREA = ("Error relative to random sets (area over ln N; 1: random median), and share of random sets that are better (mean over N). {}")


def provenance(rows, sets):
    names = {row["set"] for row in rows}
    lines = [[name, d["title"], f"{d['source']}; {d['licence']}", "; ".join(d.get("read_by", []))] for name, d in sets.items() if name in names]
    return markdown(["set", "title", "source, licence", "read by"], lines)


def page(rows, notes, sets):
    """The Markdown page of a run."""
    when = "Run on " + ", ".join(ordered(str(row["date"]) for row in rows if row["solver"] == "random")) + "."
    skips = [when + " " + STORED, "\n".join(f"- {line}" for line in notes.lines())]
    sections = [("Measured and simulated robots", [AREA.format("Fit: plain least squares."), robots_table(rows, PLAIN),
                                                   AREA.format(f"Fit: {PROGRAM}."), robots_table(rows, PROGRAM)]),
                ("Estimation", ["Error over the random median of plain least squares (area over ln N).", estimators_table(rows, "posewright"),
                                estimators_table(rows, "random")]),
                ("Design instances", ["Certified: against the bound that `posewright select` proves. Rows with a version are stored results. `docs/benchmarks.md` "
                                      "has their machine, seeds and how they were built; compare seconds of another machine by orders of magnitude.", instances_table(rows)]),
                ("Trust", [trust_table(rows)]),
                ("Sets", [provenance(rows, sets)]),
                ("What was skipped", skips)]
    parts = [HEAD] + [part for title, body in sections if "\n|" in "\n".join(body) or body == skips
                      for part in (f"## {title}", *body)]
    return "\n\n".join(part.rstrip() for part in parts if part.strip()) + "\n"


STORED = "AlgDesign, skpr and OptimalDesign are R packages that Debian does not have; their stored results stand in. FIGAROH's selection is restated."


LINES = (("posewright", "posewright, default", "#1f6f8b"), ("posewright-o1", "posewright, o1", "#7a8796"), ("farthest-point", "farthest point", "#5b8c2a"))


class Panel:
    """Error of one set over the number of poses."""
    left, width, top, bottom = 64, 330, 44, 300

    def __init__(self, rows, description, x):
        self.rows, self.description, self.left = rows, description, x + 64
        poses = sorted({r["poses"] for r in rows})
        self.poses, self.x0, self.x1 = poses, math.log(poses[0] / 1.15), math.log(poses[-1] * 1.15)
        self.random = sorted((r for r in rows if r["solver"] == "random"), key=lambda r: r["poses"])
        self.published = description.get("published")
        tops = [r["upper"] for r in self.random] + [r["value"] for r in rows if r["solver"] in [name for name, *_ in LINES]]
        self.most = 1.12 * max([v for v in tops if math.isfinite(v)] + ([self.published["error"]] if self.published else []))

    def x(self, n):
        return self.left + self.width * (math.log(n) - self.x0) / (self.x1 - self.x0)

    def y(self, value):
        return self.bottom - (self.bottom - self.top) * min(value / self.most, 1)

    def curve(self, points, colour):
        points = [(self.x(n), self.y(v)) for n, v in points]
        line = " ".join(f"{a:.1f},{b:.1f}" for a, b in points)
        return [f'<polyline points="{line}" fill="none" stroke="{colour}" stroke-width="2.5"/>',
                *(f'<circle cx="{a:.1f}" cy="{b:.1f}" r="3.5" fill="{colour}"/>' for a, b in points)]

    def axes(self):
        step = 10 ** math.floor(math.log10(self.most / 2)) * next((k for k in (1, 2, 5) if self.most / (k * 10 ** math.floor(math.log10(self.most / 2))) <= 5), 5)
        out = [f'<text x="{self.left - 8}" y="{self.top - 20}" fill="#222">{self.description["title"]}: error, mm</text>']
        for k in range(int(self.most / step) + 1):
            y = self.y(k * step)
            out.append(f'<line x1="{self.left}" x2="{self.left + self.width}" y1="{y:.1f}" y2="{y:.1f}" stroke="#ddd"/>'
                       f'<text x="{self.left - 8}" y="{y + 5:.1f}" text-anchor="end" fill="#444">{k * step:.3g}</text>')
        return out + [f'<text x="{self.x(n):.1f}" y="{self.bottom + 18}" text-anchor="middle" fill="#444">{n:g}</text>' for n in self.poses]

    def svg(self):
        out = self.axes()
        band = [(r["poses"], r["upper"]) for r in self.random] + [(r["poses"], r["lower"]) for r in reversed(self.random)]
        out.append(f'<polygon points="{" ".join(f"{self.x(n):.1f},{self.y(v):.1f}" for n, v in band)}" fill="#b3541e" fill-opacity="0.18"/>')
        out += self.curve([(r["poses"], r["value"]) for r in self.random], "#b3541e")
        for name, _, colour in reversed(LINES):
            mine = sorted((r["poses"], r["value"]) for r in self.rows if r["solver"] == name)
            out += self.curve(mine, colour) if mine else []
        if self.published:
            y = self.y(self.published["error"])
            out.append(f'<line x1="{self.left}" x2="{self.left + self.width}" y1="{y:.1f}" y2="{y:.1f}" stroke="#444" stroke-dasharray="6 4"/>'
                       f'<text x="{self.left + self.width}" y="{y - 6:.1f}" text-anchor="end" fill="#444">{self.published["label"]}</text>')
        return out


def figure(rows, sets):
    """Error over the number of poses of each measured set, two beside each other."""
    estimation = PROGRAM if any(r["estimation"] == PROGRAM for r in rows) else PLAIN
    rows = [r for r in rows if r["unit"] == "mm" and r["estimation"] == estimation]
    names = [name for name in sets if any(r["set"] == name for r in rows)]
    names.sort(key=lambda name: "published" not in sets[name])
    out = []
    for k, name in enumerate(names):
        panel = Panel([r for r in rows if r["set"] == name], sets[name], 420 * (k % 2))
        out += [f'<g transform="translate(0 {330 * (k // 2)})">', *panel.svg(), "</g>"]
    high = 330 * ((len(names) + 1) // 2) + 30
    legend = [("random: median, quartiles", "#b3541e"), *((title, colour) for _, title, colour in LINES)]
    out += [f'<text x="{64 + 210 * k}" y="{high - 10}" fill="{colour}">{title}</text>' for k, (title, colour) in enumerate(legend)]
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 870 {high}" font-family="sans-serif" font-size="14">'
            f'<rect width="870" height="{high}" fill="#fff"/>\n' + "\n".join(out) + "\n</svg>\n")


def write(out, rows, notes, sets):
    write_csv(out / "posebench.csv", rows)
    rows = read(out / "posebench.csv")
    (out / "posebench.md").write_text(page(rows, notes, sets), encoding="utf-8")
    (out / "posebench.svg").write_text(figure(rows, sets), encoding="utf-8")
