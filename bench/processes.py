"""bench/processes.py PROGRAM PROBLEM PLAN OUT.csv OUT.svg: virtual calibrations by 1 and 2 processes, and by simulation up to 1,000.

Measured: seconds of `simulate --draws N`, with one thread a process (mpirun on this machine). Simulated, event by event:
a first process that hands out indices and takes results as src/processes does, with the task times that one process
measured and MESSAGE seconds of its core for a message, LATENCY seconds on the way. Everybody's own start (reading the problem, MPI) is in all of them.
"""
import csv
import heapq
import math
import os
import random
import subprocess
import sys
import time

DRAWS = 12_000
MESSAGE, LATENCY = 5e-6, 50e-6  # a message's work for the first process; a fast network has a tenth of that latency
AHEAD, MOST = 8e-3, 4096
COUNTS = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000)


def seconds(processes, program, problem, plan, draws):
    start = ["mpirun", "-n", str(processes)] if processes > 1 else []
    begin, used = time.monotonic(), os.times()
    subprocess.run([*start, program, "simulate", problem, plan, "--draws", str(draws), "--threads", "1", "--json", "--quiet"],
                   check=True, stdout=subprocess.DEVNULL)
    now = os.times()
    return time.monotonic() - begin, now.children_user + now.children_system - used.children_user - used.children_system


def simulated(processes, tasks, mean, start):
    """Wall time of so many tasks of exponentially spread length (mean ± 30 %), one thread a process."""
    draw = random.Random(processes)
    ahead = 1 + min(math.ceil(AHEAD / mean), MOST)
    left, first_free = tasks, 0.0  # of the first process's attention
    # An event: a process asks for more when it has fewer than `ahead` tasks; here, when it has done half of them.
    events = [(LATENCY, p) for p in range(1, processes)]
    heapq.heapify(events)
    ends = [0.0] * processes
    own = 0.0
    while left > 0:
        if processes == 1 or (own <= events[0][0] if events else True):
            own += max(0.0, draw.gauss(mean, 0.3 * mean))
            left -= 1
            ends[0] = own
            continue
        at, p = heapq.heappop(events)
        begin = max(at, first_free)
        first_free = begin + 3 * MESSAGE  # question, answer, bundled results
        own += 3 * MESSAGE                # its core is not at its own tasks then
        given = min(max(1, ahead // 2), left)
        left -= given
        work = sum(max(0.0, draw.gauss(mean, 0.3 * mean)) for _ in range(given))
        ready = max(ends[p], begin + MESSAGE + LATENCY)
        ends[p] = ready + work
        # Half of what it has is still ahead when it asks again.
        heapq.heappush(events, (max(begin + MESSAGE + 2 * LATENCY, ends[p] - work), p))
    result = max(ends) + LATENCY
    # All results go to everybody at the end, down a tree.
    return start + result + math.ceil(math.log2(processes)) * LATENCY if processes > 1 else start + result


def plot(rows, file):
    width, height, left, right, top, bottom = 640, 360, 64, 24, 40, 52
    x = lambda p: left + math.log10(p) / 3 * (width - left - right)
    y = lambda s: height - bottom - math.log10(s) / 3 * (height - top - bottom)
    svg = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="13">'
           f'<rect width="{width}" height="{height}" fill="#ffffff"/>'
           f'<text x="{left}" y="22" fill="#222">how many times faster than one process (draws of the KR 270)</text>']
    for k in range(4):
        svg.append(f'<line x1="{left}" x2="{width - right}" y1="{y(10 ** k):.1f}" y2="{y(10 ** k):.1f}" stroke="#ddd"/>'
                   f'<text x="{left - 8}" y="{y(10 ** k) + 4:.1f}" text-anchor="end" fill="#444">{10 ** k}</text>'
                   f'<text x="{x(10 ** k):.1f}" y="{height - bottom + 20}" text-anchor="middle" fill="#444">{10 ** k:,}</text>')
    svg.append(f'<line x1="{x(1)}" y1="{y(1)}" x2="{x(1000)}" y2="{y(1000)}" stroke="#bbb" stroke-dasharray="4 4"/>')
    colours = {"12,000 draws": "#1f6f8b", "1,000,000 draws": "#b3541e"}
    for name, colour in colours.items():
        some = [r for r in rows if r["series"] == name and r["how"] == "simulated"]
        points = " ".join(f'{x(r["processes"]):.1f},{y(r["speedup"]):.1f}' for r in some)
        svg.append(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="2"/>'
                   f'<text x="{x(1000):.1f}" y="{y(some[-1]["speedup"]) + 18:.1f}" text-anchor="end" fill="{colour}">{name}, simulated</text>')
    for r in (r for r in rows if r["how"] == "measured"):
        svg.append(f'<circle cx="{x(r["processes"]):.1f}" cy="{y(r["speedup"]):.1f}" r="4" fill="#222"/>')
    svg.append(f'<circle cx="{left + 20}" cy="{top + 10}" r="4" fill="#222"/><text x="{left + 32}" y="{top + 14}" fill="#222">measured</text>'
               f'<text x="{(left + width - right) / 2}" y="{height - 10}" text-anchor="middle" fill="#444">processes, a thread each</text></svg>')
    with open(file, "w", encoding="utf-8") as out:
        out.write("\n".join(svg) + "\n")


def main():
    program, problem, plan, table, picture = sys.argv[1:]
    (one, used), (two, used_by_two) = (seconds(p, program, problem, plan, DRAWS) for p in (1, 2))
    start = {1: seconds(1, program, problem, plan, 2)[0], 2: seconds(2, program, problem, plan, 2)[0]}
    mean = (used - seconds(1, program, problem, plan, 2)[1]) / DRAWS
    rows = [{"series": "12,000 draws", "how": "measured", "processes": p, "seconds": s, "cpu": c, "speedup": one / s}
            for p, s, c in ((1, one, used), (2, two, used_by_two))]
    for name, draws in (("12,000 draws", DRAWS), ("1,000,000 draws", 1_000_000)):
        alone = simulated(1, draws, mean, start[1])
        for p in COUNTS:
            s = alone if p == 1 else simulated(p, draws, mean, start[2])
            rows.append({"series": name, "how": "simulated", "processes": p, "seconds": s, "cpu": "", "speedup": alone / s})
    with open(table, "w", newline="", encoding="utf-8") as out:
        writer = csv.DictWriter(out, list(rows[0]))
        writer.writeheader()
        writer.writerows({k: f"{v:.4g}" if isinstance(v, float) else v for k, v in r.items()} for r in rows)
    plot(rows, picture)


main()
