#!/usr/bin/env python3
"""bench/gain_over_time.py PROGRAM OUT.svg PROBLEM...: what each stage of `auto` gains, over the seconds of the whole search.

Plans every problem once and draws the D-efficiency (against the plan's bound over its candidates) at the end of each stage,
as plan.json states them. Prints a table of the same.
"""
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 680, 360, 60, 150, 40, 50
COLOURS = ["#1f6f8b", "#b3541e", "#4a7c36", "#7a4a9c", "#888800"]


def stages_of(program, problem, folder):
    plan = os.path.join(folder, "plan.json")
    subprocess.run([program, "plan", problem, "-o", plan, "--poses-csv", os.path.join(folder, "poses.csv"), "--force", "--quiet",
                    "--proof-time", "0"], check=True, stdout=subprocess.DEVNULL)
    statistics = json.load(open(plan))["statistics"]
    # Seconds of a stage are counted from the begin of the search.
    points = [(stage["name"], stage["seconds"], 100 * stage["efficiency"]) for stage in statistics["stages"]]
    return points, statistics["seconds"]


def name_of(problem):
    path = pathlib.Path(problem)
    return path.parent.name if path.stem == "problem" else path.stem


def draw(series, out):
    times = [t for points in series.values() for _, t, _ in points]
    low, high = math.log10(min(times)) - 0.1, math.log10(max(times)) + 0.1
    least = math.floor(min(e for points in series.values() for _, _, e in points) / 5) * 5

    def x(t):
        return LEFT + (math.log10(t) - low) / (high - low) * (WIDTH - LEFT - RIGHT)

    def y(e):
        return HEIGHT - BOTTOM - (e - least) / (100 - least) * (HEIGHT - TOP - BOTTOM)

    svg = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" font-size="12">'
           f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#ffffff"/>'
           f'<text x="{LEFT}" y="22" fill="#222">D-efficiency at the end of each stage of auto, percent of the bound over the candidates</text>']
    for e in range(least, 101, 5):
        svg.append(f'<line x1="{LEFT}" x2="{WIDTH - RIGHT}" y1="{y(e):.1f}" y2="{y(e):.1f}" stroke="#ddd"/>'
                   f'<text x="{LEFT - 8}" y="{y(e) + 4:.1f}" text-anchor="end" fill="#444">{e}</text>')
    for k in range(math.ceil(low), math.floor(high) + 1):
        svg.append(f'<text x="{x(10 ** k):.1f}" y="{HEIGHT - BOTTOM + 18}" text-anchor="middle" fill="#444">{10 ** k:g} s</text>')
    for (name, points), colour in zip(series.items(), COLOURS):
        line = " ".join(f"{x(t):.1f},{y(e):.1f}" for _, t, e in points)
        svg.append(f'<polyline points="{line}" fill="none" stroke="{colour}" stroke-width="2"/>')
        for stage, t, e in points:
            svg.append(f'<circle cx="{x(t):.1f}" cy="{y(e):.1f}" r="3.5" fill="{colour}"><title>{stage}</title></circle>')
    for i, ((name, _), colour) in enumerate(zip(series.items(), COLOURS)):
        at = TOP + 16 + 18 * i
        svg.append(f'<circle cx="{WIDTH - RIGHT + 20}" cy="{at - 4}" r="4" fill="{colour}"/>'
                   f'<text x="{WIDTH - RIGHT + 30}" y="{at}" fill="#222">{name}</text>')
    svg.append(f'<text x="{(LEFT + WIDTH - RIGHT) / 2}" y="{HEIGHT - 12}" text-anchor="middle" fill="#444">'
               'seconds since the search began: greedy, exchange, continuous, new candidates</text></svg>')
    pathlib.Path(out).write_text("\n".join(svg) + "\n")


def main():
    program, out, *problems = sys.argv[1:]
    series = {}
    with tempfile.TemporaryDirectory() as folder:
        for problem in problems:
            points, whole = stages_of(program, problem, folder)
            series[name_of(problem)] = points
            for stage, seconds, efficiency in points:
                print(f"| {name_of(problem)} | {stage} | {seconds:.2f} | {efficiency:.2f} % |")
            print(f"| {name_of(problem)} | whole search | {whole:.2f} | |", flush=True)
    draw(series, out)


main()
