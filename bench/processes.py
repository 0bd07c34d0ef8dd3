"""bench/processes.py PROGRAM PROBLEM PLAN [--draws N] [--repeats K] [--table OUT.csv] [--picture OUT.svg]

Virtual calibrations (`simulate --draws N`) by one thread, by two threads of one process and by two processes of a thread each,
in turn, K times: wall time, seconds of the cores, and what two processes take more than two threads. With --table or --picture
also, by simulation, up to 1,000 processes of a thread each.

The simulation is event by event: a first process that hands out indices and takes results as src/processes does. Task times,
bytes of a result (counted by --verbose) and everybody's start (reading the problem, MPI; with two draws) are those that were
measured, and so is a message's cost: bench/message_cost.cpp measures it between two processes of this machine (compiled by
mpicxx). The table has the same once more with a network of NETWORK_WAY and NETWORK_MEGABYTE. At the end all results go to
everybody through a chain of processes, each of which receives and passes on.
"""
import argparse
import csv
import heapq
import math
import os
import pathlib
import random
import re
import statistics
import subprocess
import tempfile
import time

# Assumed, not measured: seconds on the way between two machines, and for a megabyte (10 Gbit/s).
NETWORK_WAY, NETWORK_MEGABYTE = 50e-6, 1e-3
AHEAD, MOST = 8e-3, 4096
COUNTS = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000)
ENVIRONMENT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}


def message_cost():
    """Seconds on the way, of the first process's work for one that it receives or sends, and for a megabyte."""
    with tempfile.TemporaryDirectory() as folder:
        program = os.path.join(folder, "message_cost")
        subprocess.run(["mpicxx", "-O2", "-std=c++20", pathlib.Path(__file__).with_name("message_cost.cpp"), "-o", program], check=True)
        words = subprocess.run(["mpirun", "-n", "2", program], check=True, capture_output=True, text=True, env=ENVIRONMENT).stdout.split()
    cost = dict(zip(words[::2], (1e-6 * float(word) for word in words[1::2])))
    return cost["way"], (cost["received"] + cost["sent"]) / 2, cost["megabyte"]


def bytes_of_result(arguments):
    """The second process gets all results, and sends its own, about half of them."""
    draws = 400
    told = subprocess.run(["mpirun", "-n", "2", arguments.program, "simulate", arguments.problem, arguments.plan, "--draws", str(draws),
                           "--threads", "1", "--json", "--verbose"], check=True, capture_output=True, text=True, env=ENVIRONMENT).stderr
    return int(re.search(r"messages, (\d+) bytes", told)[1]) / (1.5 * draws)


def seconds(processes, threads, arguments, draws):
    """Wall time and seconds of the cores."""
    start = ["mpirun", "-n", str(processes)] if processes > 1 else []
    begin, used = time.monotonic(), os.times()
    subprocess.run([*start, arguments.program, "simulate", arguments.problem, arguments.plan, "--draws", str(draws),
                    "--threads", str(threads), "--json", "--quiet"], check=True, stdout=subprocess.DEVNULL, env=ENVIRONMENT)
    now = os.times()
    return time.monotonic() - begin, now.children_user + now.children_system - used.children_user - used.children_system


def simulated(processes, tasks, mean, start, size, way, work, megabyte):
    """Wall time of so many tasks of length mean ± 30 %, one thread a process."""
    draw = random.Random(processes)
    ahead = 1 + min(math.ceil(AHEAD / mean), MOST)
    left, first_free = tasks, 0.0  # of the first process's attention
    # An event: a process asks for more when it has fewer than `ahead` tasks; here, when it has done half of them.
    events = [(way, p) for p in range(1, processes)]
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
        given = min(max(1, ahead // 2), left)
        busy = 3 * work + 1e-6 * given * size * megabyte  # question, answer, bundled results
        first_free = begin + busy
        own += busy  # its core is not at its own tasks then
        left -= given
        length = sum(max(0.0, draw.gauss(mean, 0.3 * mean)) for _ in range(given))
        ready = max(ends[p], begin + work + way)
        ends[p] = ready + length
        # Half of what it has is still ahead when it asks again.
        heapq.heappush(events, (max(begin + work + 2 * way, ends[p] - length), p))
    if processes == 1:
        return start + max(ends)
    return start + max(ends) + processes * way + 2e-6 * tasks * size * megabyte


COLOURS = ["#1f6f8b", "#b3541e"]


def plot(rows, file):
    width, height, left, right, top, bottom = 640, 400, 64, 24, 40, 52
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
    series = [name for name in dict.fromkeys(r["series"] for r in rows if r["how"] == "simulated")]
    for k, name in enumerate(series):
        some = [r for r in rows if r["series"] == name and r["how"] == "simulated"]
        points = " ".join(f'{x(r["processes"]):.1f},{y(r["speedup"]):.1f}' for r in some)
        dash = ' stroke-dasharray="6 3"' if k % 2 else ""
        svg.append(f'<polyline points="{points}" fill="none" stroke="{COLOURS[k // 2]}" stroke-width="2"{dash}/>'
                   f'<line x1="{left + 12}" x2="{left + 28}" y1="{top + 30 + 20 * k}" y2="{top + 30 + 20 * k}" stroke="{COLOURS[k // 2]}" '
                   f'stroke-width="2"{dash}/><text x="{left + 36}" y="{top + 34 + 20 * k}" fill="{COLOURS[k // 2]}">{name}, simulated</text>')
    for r in (r for r in rows if r["how"] == "measured"):
        svg.append(f'<circle cx="{x(r["processes"]):.1f}" cy="{y(r["speedup"]):.1f}" r="4" fill="#222"/>')
    svg.append(f'<circle cx="{left + 20}" cy="{top + 10}" r="4" fill="#222"/><text x="{left + 36}" y="{top + 14}" fill="#222">measured</text>'
               f'<text x="{(left + width - right) / 2}" y="{height - 10}" text-anchor="middle" fill="#444">processes, a thread each</text></svg>')
    with open(file, "w", encoding="utf-8") as out:
        out.write("\n".join(svg) + "\n")


RUNS = {"one thread": (1, 1), "two threads": (1, 2), "two processes": (2, 1)}


def compared(arguments):
    """One thread, two threads of one process and two processes of one thread in turn; wall time and seconds of the cores of each."""
    rows = []
    for _ in range(arguments.repeats):
        rows.append({name: seconds(*how, arguments, arguments.draws) for name, how in RUNS.items()})
        print(f"{arguments.draws:,} draws: " + "; ".join(f"{name} {wall:.1f} s wall, {cores:.1f} s of the cores"
                                                        for name, (wall, cores) in rows[-1].items()), flush=True)
    for what, k in (("wall time", 0), ("seconds of the cores", 1)):
        more = [100 * (row["two processes"][k] / row["two threads"][k] - 1) for row in rows]
        print(f"two processes take {min(more):.1f} to {max(more):.1f} % more {what} than two threads (median {statistics.median(more):.1f} %)")
    # Other programs of the machine only add.
    return {name: tuple(min(row[name][k] for row in rows) for k in (0, 1)) for name in RUNS}


def main():
    parser = argparse.ArgumentParser()
    for name in ("program", "problem", "plan"):
        parser.add_argument(name)
    parser.add_argument("--draws", type=int, default=18_000)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--table")
    parser.add_argument("--picture")
    arguments = parser.parse_args()
    least = compared(arguments)
    if not arguments.table and not arguments.picture:
        return
    (one, used), (two, used_by_two) = least["one thread"], least["two processes"]
    start, begun = {}, {}
    for p in (1, 2):
        start[p], begun[p] = (min(values) for values in zip(*(seconds(p, 1, arguments, 2) for _ in range(5))))
    mean = (used - begun[1]) / arguments.draws
    way, work, megabyte = message_cost()
    size = bytes_of_result(arguments)
    print(f"a task {1e3 * mean:.2f} ms, its result {size:.0f} bytes; a start {start[1]:.2f} s, of two processes {start[2]:.2f} s; a message "
          f"{1e6 * way:.2f} µs on the way, {1e6 * work:.2f} µs of work, {1e6 * megabyte:.0f} µs a megabyte; 2 processes {one / two:.2f} "
          "times as fast as one")
    measured = f"{arguments.draws:,} draws"
    rows = [{"series": measured, "how": "measured", "processes": p, "seconds": s, "cpu": c, "speedup": one / s}
            for p, s, c in ((1, one, used), (2, two, used_by_two))]
    for draws in (arguments.draws, 1_000_000):
        for name, cost in (("", (way, work, megabyte)), (", network", (NETWORK_WAY, work, NETWORK_MEGABYTE))):
            alone = simulated(1, draws, mean, start[1], size, *cost)
            for p in COUNTS:
                s = alone if p == 1 else simulated(p, draws, mean, start[2], size, *cost)
                rows.append({"series": f"{draws:,} draws{name}", "how": "simulated", "processes": p, "seconds": s, "cpu": "",
                             "speedup": alone / s})
    if arguments.table:
        with open(arguments.table, "w", newline="", encoding="utf-8") as out:
            writer = csv.DictWriter(out, list(rows[0]))
            writer.writeheader()
            writer.writerows({k: f"{v:.4g}" if isinstance(v, float) else v for k, v in r.items()} for r in rows)
    if arguments.picture:
        plot(rows, arguments.picture)
    for r in rows:
        print(f"{r['series']}, {r['how']}: {r['processes']} processes, {r['seconds']:.2f} s, {r['speedup']:.1f} times as fast")


main()
