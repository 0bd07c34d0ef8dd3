#!/usr/bin/env python3
"""bench/robust.py PROGRAM [--draws 200] [--out FOLDER]

Plans of three robots for the tolerances, and for the nominal robot: D-efficiency of each drawn robot, against the best
plan for it. Writes robust.svg. Every number is read from the plan files."""
import argparse
import json
import math
import pathlib
import subprocess
import tempfile
import time

EXAMPLES = pathlib.Path(__file__).resolve().parent.parent / "examples"
ROBOTS = [
    ("KR 270, laser tracker", "kr270/problem.yaml", []),
    ("telescope, photogrammetry", "telescope/problem.yaml", ["--variant", "rigid"]),
    ("camera on the hand", "instruments/camera_on_hand.yaml", []),
]


def plan(program, problem, options, draws):
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "plan.json"
        begin = time.monotonic()
        subprocess.run([program, "plan", EXAMPLES / problem, "--robust", str(draws), "--proof-time", "0", "-o", out,
                        "--poses-csv", pathlib.Path(folder) / "poses.csv", *options], check=True, capture_output=True)
        return json.loads(out.read_text())["robust"], time.monotonic() - begin


def percent(efficiency):
    """As the program states it: never more than it is."""
    return f"{math.floor(1e4 * efficiency) / 100:.2f} %"


def panel(x, title, robust):
    """Efficiencies in ascending order: nominal plan grey, robust plan blue."""
    width, height, top = 240, 190, 50
    nominal, own = sorted(robust["nominal_plan"]["efficiency"]), sorted(robust["efficiency"])
    low = 0.0 if nominal[0] == 0 else min(nominal[0], own[0]) - 0.002
    high = min(1.0, max(nominal[-1], own[-1]) + (0.0 if low == 0 else 0.002))

    def line(values, colour):
        points = " ".join(f"{x + width * i / (len(values) - 1):.1f},{top + height * (1 - (v - low) / (high - low)):.1f}"
                          for i, v in enumerate(values))
        return f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="2"/>'

    ticks = [f'<text x="{x - 6}" y="{top + height * (1 - (v - low) / (high - low)) + 4:.0f}" text-anchor="end">{100 * v:.4g} %</text>'
             for v in (low, high)]
    return "\n".join([f'<text x="{x}" y="30" font-weight="bold">{title}</text>',
                      f'<rect x="{x}" y="{top}" width="{width}" height="{height}" fill="none" stroke="#999999"/>',
                      *ticks, line(nominal, "#888888"), line(own, "#1f5fbf"),
                      f'<text x="{x}" y="{top + height + 20}">drawn robots, worst first</text>'])


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("--draws", type=int, default=200)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("."))
    options = parser.parse_args()
    panels = []
    for i, (title, problem, more) in enumerate(ROBOTS):
        robust, seconds = plan(options.program, problem, more, options.draws)
        nominal = robust["nominal_plan"]
        lost = sum(e == 0 for e in nominal["efficiency"])
        print(f"{title}: nominal plan {percent(nominal['value'])} (undetermined: {lost}, lowest {percent(min(nominal['efficiency']))}), "
              f"robust plan {percent(robust['value'])} (lowest {percent(min(robust['efficiency']))}), bound {percent(robust['bound'])}, "
              f"{seconds:.1f} s")
        panels.append(panel(80 + 330 * i, title, robust))
    legend = ('<text x="80" y="290" fill="#888888">plan for the nominal robot</text>'
              '<text x="300" y="290" fill="#1f5fbf">plan for the tolerances</text>')
    (options.out / "robust.svg").write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 1010 305" font-family="sans-serif" font-size="13">'
        '<rect width="1010" height="305" fill="#ffffff"/>\n' + "\n".join(panels) + "\n" + legend + "</svg>\n", encoding="utf-8")


if __name__ == "__main__":
    main()
