#!/usr/bin/env python3
"""Time to the proved D-optimum of random rows, as in the study of Hendrych, Besançon & Pokutta (2023, arXiv:2312.11200).

    bench/proved_optimum.py build/release/bin/posewright [--seeds 3] [--time-limit 600]
    bench/proved_optimum.py build/release/bin/posewright --criterion o3 --sizes 100x10x15,120x10x15 --seeds 5 --gap 1 --time-limit 3600

IND: uniform in [0, 1). CORR: normal, mean normal, covariance BᵀB of a uniform B. Nobody is chosen twice.
"""

import argparse
import json
import pathlib
import resource
import subprocess
import tempfile
import time

import numpy as np

SIZES = [(120, 12, 18), (200, 10, 10), (500, 10, 15), (1000, 10, 10)]


def rows_of(kind, n, p, seed):
    random = np.random.default_rng(seed)
    if kind == "IND":
        return random.random((n, p))
    B = random.random((n, p))
    return random.multivariate_normal(random.standard_normal(p), B.T @ B, size=n, method="cholesky")


def proof(rows, poses, options, folder):
    np.save(folder / "rows.npy", rows[:, None, :])
    begin = time.monotonic()
    gap = ["--gap", str(options.gap)] if options.gap > 0 else []
    subprocess.run([options.program.resolve(), "select", folder / "rows.npy", "--poses", str(poses), "--criterion",
                    options.criterion, "--method", "branch_and_bound", "--time-limit", str(options.time_limit), *gap,
                    "--quiet", "--force", "-o", folder / "plan.json"],
                   check=True, stdout=subprocess.DEVNULL)
    seconds = time.monotonic() - begin
    cpu = resource.getrusage(resource.RUSAGE_CHILDREN)
    plan = json.loads((folder / "plan.json").read_text())
    return seconds, cpu.ru_utime + cpu.ru_stime, not plan["interrupted"], plan["certificate"]["candidates"]["efficiency"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--time-limit", type=float, default=600)
    parser.add_argument("--gap", type=float, default=0, help="percent: proved counts what no plan exceeds by more (0: exactly)")
    parser.add_argument("--criterion", default="o1")
    parser.add_argument("--sizes", default=",".join("x".join(map(str, size)) for size in SIZES),
                        help="rows x parameters x N, separated by commas")
    options = parser.parse_args()
    sizes = [tuple(map(int, size.split("x"))) for size in options.sizes.split(",")]
    before = 0.0
    with tempfile.TemporaryDirectory() as folder:
        for n, p, poses in sizes:
            for kind in ("IND", "CORR"):
                count = 0
                for seed in range(1, options.seeds + 1):
                    seconds, cpu, proved, efficiency = proof(rows_of(kind, n, p, seed), poses, options,
                                                             pathlib.Path(folder))
                    count += proved
                    word = "proved" if proved else f"{100 * efficiency:.2f} % proved"
                    print(f"{kind} {n} x {p}, N = {poses}, seed {seed}: {seconds:.2f} s, {cpu - before:.2f} s of CPU, {word}",
                          flush=True)
                    before = cpu
                print(f"{kind} {n} x {p}, N = {poses}: {count} of {options.seeds} proved", flush=True)


if __name__ == "__main__":
    main()
