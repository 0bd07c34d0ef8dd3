#!/usr/bin/env python3
"""bench/peers/figaroh_selection.py BLOCKS.npy N [plan.json]

Selection of calibration postures as FIGAROH does it (optimal_config: D-optimal weights of all candidates, then the
candidates of largest weight), restated on blocks n × r × m. FIGAROH solves for the weights with a conic solver; here the
multiplicative algorithm (Silvey, Titterington & Torsney 1978) gives the same weights. With a plan of `posewright select`
on the same blocks both log-determinants are compared.
"""
import json
import sys

import numpy as np


def log_det(blocks, chosen):
    r = np.linalg.qr(blocks[chosen].reshape(-1, blocks.shape[2]), mode="r")
    return 2 * np.log(np.abs(np.diag(r))).sum()


def optimal_weights(blocks, tolerance=1e-4, rounds=5000):
    n, _, m = blocks.shape
    w = np.full(n, 1.0 / n)
    for _ in range(rounds):
        information = np.einsum("i,irk,irl->kl", w, blocks, blocks, optimize=True)
        rotated = blocks @ np.linalg.inv(np.linalg.cholesky(information)).T
        d = np.einsum("irk,irk->i", rotated, rotated)
        if d.max() <= m * (1 + tolerance):
            break
        w *= d / m
    return w


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    blocks = np.load(sys.argv[1]).astype(float)
    n, m = int(sys.argv[2]), blocks.shape[2]
    weights = optimal_weights(blocks)
    largest = np.sort(np.argsort(-weights, kind="stable")[:n])
    value = log_det(blocks, largest)
    print(f"largest weights: log det {value:.6f}")
    if len(sys.argv) > 3:
        with open(sys.argv[3]) as file:
            ours = json.load(file)["criterion"]["log_det"]
        print(f"posewright:      log det {ours:.6f}; D-efficiency of the largest weights against it "
              f"{np.exp((value - ours) / m):.4f}")


main()
