#!/usr/bin/env python3
"""Time to the proved D-optimum of random rows, as in the study of Hendrych, Besançon & Pokutta (2023, arXiv:2312.11200).

    bench/proved_optimum.py build/release/bin/posewright [--seeds 3] [--time-limit 600]
    bench/proved_optimum.py build/release/bin/posewright --criterion o3 --sizes 100x10x15,120x12x18 --time-limit 180

IND: uniform in [0, 1). CORR: normal, mean normal, covariance BᵀB of a uniform B. Nobody is chosen twice.
"""

import argparse
import json
import pathlib
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


def proof(program, rows, poses, criterion, limit, folder):
    np.save(folder / "rows.npy", rows[:, None, :])
    begin = time.monotonic()
    subprocess.run([program, "select", folder / "rows.npy", "--poses", str(poses), "--criterion", criterion, "--method",
                    "branch_and_bound", "--time-limit", str(limit), "--quiet", "--force", "-o", folder / "plan.json"],
                   check=True, stdout=subprocess.DEVNULL)
    seconds = time.monotonic() - begin
    candidates = json.loads((folder / "plan.json").read_text())["certificate"]["candidates"]
    return seconds, candidates["optimal"], candidates["efficiency"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--time-limit", type=float, default=600)
    parser.add_argument("--criterion", default="o1")
    parser.add_argument("--sizes", default=",".join("x".join(map(str, size)) for size in SIZES),
                        help="rows x parameters x N, separated by commas")
    options = parser.parse_args()
    sizes = [tuple(map(int, size.split("x"))) for size in options.sizes.split(",")]
    with tempfile.TemporaryDirectory() as folder:
        for n, p, poses in sizes:
            for kind in ("IND", "CORR"):
                for seed in range(1, options.seeds + 1):
                    seconds, optimal, efficiency = proof(options.program.resolve(), rows_of(kind, n, p, seed), poses,
                                                         options.criterion, options.time_limit, pathlib.Path(folder))
                    word = "proved" if optimal else f"{100 * efficiency:.2f} % proved"
                    print(f"{kind} {n} x {p}, N = {poses}, seed {seed}: {seconds:.2f} s, {word}", flush=True)


if __name__ == "__main__":
    main()
