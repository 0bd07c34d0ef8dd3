"""bench/spread.py PROGRAM [--megabytes 400] [--poses 50] [--processes 1,2,4] [--plain]: peak memory of each process of `select --spread`.

Writes random blocks (3 rows of 33 columns, numbers of 8 bytes) of so many megabytes to a temporary file and chooses from them
by 1, 2 and 4 processes; prints each process's peak resident memory, the time, the messages of an exchange, and whether all wrote the same plan. --plain:
once more without --spread.
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

import numpy

ROWS, COLUMNS = 3, 33
ENVIRONMENT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
TIMES = {"seconds", "time", "stages", "created"}


def measured(folder, command):
    """One process: runs the program and leaves its peak memory (KiB) in a file."""
    code = subprocess.run(command).returncode
    rank = os.environ.get("OMPI_COMM_WORLD_RANK", "0")
    pathlib.Path(folder, f"peak{rank}").write_text(str(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss), encoding="ascii")
    sys.exit(code)


def write_blocks(file, megabytes):
    count = int(megabytes * 1e6 / (8 * ROWS * COLUMNS))
    blocks = numpy.lib.format.open_memmap(file, mode="w+", dtype="<f8", shape=(count, ROWS, COLUMNS))
    draw = numpy.random.default_rng(1)
    for first in range(0, count, 10000):
        some = min(10000, count - first)
        blocks[first:first + some] = draw.normal(size=(some, ROWS, COLUMNS)) * draw.uniform(0.2, 1, size=(some, 1, 1))
    blocks.flush()
    return count


def without_times(value):
    if isinstance(value, dict):
        return {key: without_times(item) for key, item in value.items() if key not in TIMES}
    return [without_times(item) for item in value] if isinstance(value, list) else value


def run(program, folder, processes, poses, spread):
    start = ["mpirun", "--oversubscribe", "--bind-to", "none", "-n", str(processes)] if processes > 1 else []
    begin = time.monotonic()
    done = subprocess.run([*start, sys.executable, __file__, "--measured", folder, program, "select", f"{folder}/blocks.npy", "--poses",
                           str(poses), "--threads", "1", "--json", "--verbose", "-o", "-", *(["--spread"] if spread else [])],
                          env=ENVIRONMENT, capture_output=True, text=True)
    wall = time.monotonic() - begin
    if done.returncode != 0:
        sys.exit(done.stderr)
    peaks = [int(pathlib.Path(folder, f"peak{rank}").read_text(encoding="ascii")) / 1024 for rank in range(processes)]
    plan = json.loads(done.stdout)
    print(f"{'spread over' if spread else 'plain select,'} {processes} process{'es' if processes > 1 else ''}: peak memory "
          f"{', '.join(f'{peak:.0f}' for peak in peaks)} MiB, {wall:.0f} s, log det {plan['criterion']['log_det']:.6f}, bound "
          f"{plan['certificate']['candidates']['bound']:.6f}", flush=True)
    for line in done.stderr.splitlines():
        if "blocks spread over" in line:
            print("  " + line, flush=True)
    return without_times(plan)


def main():
    if sys.argv[1:2] == ["--measured"]:
        measured(sys.argv[2], sys.argv[3:])
    parser = argparse.ArgumentParser()
    parser.add_argument("program", type=lambda text: str(pathlib.Path(text).resolve()))
    parser.add_argument("--megabytes", type=float, default=400)
    parser.add_argument("--poses", type=int, default=50)
    parser.add_argument("--processes", type=lambda text: [int(word) for word in text.split(",")], default=[1, 2, 4])
    parser.add_argument("--plain", action="store_true")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        count = write_blocks(f"{folder}/blocks.npy", arguments.megabytes)
        print(f"{count:,} blocks of {ROWS} x {COLUMNS}, {arguments.megabytes:.0f} MB; {arguments.poses} are chosen", flush=True)
        plans = [run(arguments.program, folder, processes, arguments.poses, True) for processes in arguments.processes]
        print("the same plan" if all(plan == plans[0] for plan in plans) else "THE PLANS DIFFER")
        if arguments.plain:
            run(arguments.program, folder, 1, arguments.poses, False)


main()
